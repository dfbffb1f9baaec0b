#include <CLI/CLI.hpp>

#include "verbs.hpp"

namespace softgrain {
void add_doctor_verb(CLI::App&) {}
}  // namespace softgrain
