#pragma once
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming)
class App;
}

namespace softgrain {

/// Adds a verb that Python carries out, with the options of python/softgrain/options.json, from which
/// Python's own parser is made as well. Its callback is carry_out_in_python.
CLI::App* add_python_verb(CLI::App& app, const std::string& name);

/// Becomes Python with the words that were given to the verb.
[[noreturn]] void carry_out_in_python(const CLI::App& verb);

}  // namespace softgrain
