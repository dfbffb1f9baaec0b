#pragma once
#include <string>
#include <vector>

namespace softgrain {

/// Becomes `python3 <the package softgrain> <verb> <words>`, with /usr/bin/python3 or what SOFTGRAIN_PYTHON
/// names, so that Python's exit code and its signals are ours. SOFTGRAIN_PROGRAM tells the package which
/// program to call for the runs it needs. Raises UsageError if there is no such interpreter.
[[noreturn]] void become_python(const std::string& verb, std::vector<std::string> words);

}  // namespace softgrain
