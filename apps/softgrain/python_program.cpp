#include "python_program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "softgrain/core/error.hpp"
#include "softgrain/core/version.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// From the system; where it does not tell, from SOFTGRAIN_PROGRAM, which the command of a wheel sets. Else
/// empty.
fs::path own_path() {
  std::error_code unknown;
  const fs::path told = fs::read_symlink("/proc/self/exe", unknown);
  const char* named = std::getenv("SOFTGRAIN_PROGRAM");
  return told.empty() && named != nullptr ? fs::path(named) : told;
}

/// The Python package: installed beside this program, or in the source tree that it was built from.
fs::path package() {
  const BuildInfo build = build_info();
  const fs::path installed = own_path().parent_path().parent_path() / build.python_installed / "softgrain";
  std::error_code unknown;
  return fs::exists(installed, unknown) ? installed : fs::path(build.python_source) / "softgrain";
}

}  // namespace

std::string python_interpreter() {
  const char* chosen = std::getenv("SOFTGRAIN_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

std::vector<fs::path> python_paths() {
  return {own_path().parent_path() / "python", package().parent_path()};
}

void become_python(std::vector<std::string> words) {
  const std::string verb = words.front();
  words.insert(words.begin(), {python_interpreter(), package().string()});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // a program that the caller named already stays
  if (const fs::path own = own_path(); !own.empty()) setenv("SOFTGRAIN_PROGRAM", own.c_str(), 0);
  std::fflush(nullptr);
  execvp(argv[0], argv.data());
  throw UsageError(
      fmt::format("cannot start {}: {}; `softgrain {}` needs Python: on Debian,\n"
                  "  apt install python3-matplotlib python3-h5py\n"
                  "SOFTGRAIN_PYTHON names another interpreter",
                  argv[0], std::strerror(errno), verb));
}

}  // namespace softgrain
