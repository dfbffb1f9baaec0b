#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace softgrain {

/// Becomes `python3 <the package softgrain> <words>`, the first of them a verb, with /usr/bin/python3 or what
/// SOFTGRAIN_PYTHON names, so that Python's exit code and its signals are ours. SOFTGRAIN_PROGRAM tells the
/// package which program to call for the runs it needs. Raises UsageError if there is no such interpreter.
[[noreturn]] void become_python(std::vector<std::string> words);

/// /usr/bin/python3, or what SOFTGRAIN_PYTHON names.
std::string python_interpreter();

/// Where `import softgrain` may find the package with its compiled module: in the build that this program
/// lies in, or where both were installed.
std::vector<std::filesystem::path> python_paths();

}  // namespace softgrain
