#pragma once
#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Raises what `create_simulation` would raise for this case, in a fraction of a second: it creates the
/// simulation itself where that is cheap, and otherwise a small twin, with the same laws, path and options,
/// and the places of the grains. What only a large sample meets is left to the run.
void check_case(const Case& the_case);

}  // namespace softgrain
