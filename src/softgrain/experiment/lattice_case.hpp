#pragma once
#include <string>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Grains of points that move through a lattice.
inline bool is_lattice(const Case& c) {
  return is_elastic(c) && c.mpm.formulation == Formulation::updated_lagrangian;
}

/// What the case asks of a lattice that it does not have, with a remedy, or "".
std::string lattice_cannot(const Case& c);

}  // namespace softgrain
