#pragma once

namespace softgrain {

/// What this program was built from: release number, git commit, compiler and flags.
struct BuildInfo {
  const char* version;
  const char* commit;
  const char* compiler;
  const char* flags;
  const char* python_source;     ///< folder of the Python package in the source tree
  const char* python_installed;  ///< the same where the program is installed, below its prefix
};

BuildInfo build_info();

}  // namespace softgrain
