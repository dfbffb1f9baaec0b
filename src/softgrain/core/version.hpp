#pragma once

namespace softgrain {

/// What this program was built from: release number, git commit, compiler and flags.
struct BuildInfo {
  const char* version;
  const char* commit;
  const char* compiler;
  const char* flags;
  const char* share_directory;  ///< where plot scripts and templates lie
};

BuildInfo build_info();

}  // namespace softgrain
