#include <CLI/CLI.hpp>

#include "verbs.hpp"

namespace softgrain {
void add_check_verb(CLI::App&) {}
}  // namespace softgrain
