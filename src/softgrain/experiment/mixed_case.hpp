#pragma once
#include <string>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Why a case of bonded grains among elastic ones cannot be carried out yet, for the user; "" where it can,
/// and for other cases.
std::string mixed_cannot(const Case& the_case);

}  // namespace softgrain
