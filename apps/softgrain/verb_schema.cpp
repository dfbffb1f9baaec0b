#include <CLI/CLI.hpp>

#include "verbs.hpp"

namespace softgrain {
void add_schema_verb(CLI::App&) {}
}  // namespace softgrain
