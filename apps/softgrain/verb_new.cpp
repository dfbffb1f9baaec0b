#include <CLI/CLI.hpp>

#include "verbs.hpp"

namespace softgrain {
void add_new_verb(CLI::App&) {}
}  // namespace softgrain
