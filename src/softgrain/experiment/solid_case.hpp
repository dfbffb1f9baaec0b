#pragma once
#include <functional>
#include <string>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// What a case in space asks for that is not there yet, for the user; "" if nothing, and in the plane.
std::string not_yet_in_space(const Case& the_case);

/// The longest time step [s] with which a run of a case in space is stable from its start on.
double longest_solid_step(const Case& the_case);

/// In space other defaults hold for what a case does not give: explicit steps, six cells, no page of the run.
void set_defaults_of_space(Case& the_case, const std::function<bool(const char* key)>& is_given);

}  // namespace softgrain
