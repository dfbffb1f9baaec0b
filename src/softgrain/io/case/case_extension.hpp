#pragma once
#include <string>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Why a run that was begun with one case cannot go on with another; "" if it can: only its end has moved
/// further away (loading.max_strain, max_packing_fraction, max_stress), or its output is another.
std::string why_no_extension(const Case& begun, const Case& wanted);

/// The first difference for which the state of a run cannot belong to the grains of another case, as
/// "mpm.cells was 4, not 5"; "" if there is none.
std::string why_other_grains(const Case& begun, const Case& wanted);

}  // namespace softgrain
