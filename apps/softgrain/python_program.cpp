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

namespace {

std::string python() {
  const char* chosen = std::getenv("SOFTGRAIN_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

/// Names this program to the script. A program that the caller named already stays.
void export_own_path() {
  std::error_code unknown;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (!unknown) setenv("SOFTGRAIN_PROGRAM", path.c_str(), 0);
}

}  // namespace

void become_python(const std::string& script, std::vector<std::string> words) {
  words.insert(words.begin(), {python(), std::string(build_info().share_directory) + "/python/" + script});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  export_own_path();
  std::fflush(nullptr);
  execvp(argv[0], argv.data());
  throw UsageError(
      fmt::format("cannot start {}: {}; `softgrain {}` needs Python: on Debian,\n"
                  "  apt install python3-matplotlib python3-h5py\n"
                  "SOFTGRAIN_PYTHON names another interpreter",
                  argv[0], std::strerror(errno), std::filesystem::path(script).stem().string()));
}

}  // namespace softgrain
