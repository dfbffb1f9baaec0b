#include "softgrain/experiment/mixed_case.hpp"

#include <algorithm>

#include "softgrain/experiment/kinds.hpp"

namespace softgrain {
namespace {

bool adheres(const Case& c) {
  return c.contact.surface_energy > 0 || c.contact.wall_surface_energy > 0 ||
         std::any_of(c.pairs.begin(), c.pairs.end(),
                     [](const Case::Pair& pair) { return pair.surface_energy.value_or(0) > 0; });
}

/// What is missing, and what to write today.
std::string missing(const Case& c) {
  if (is_in_space(c)) return "in space; today experiment.dimension = 2";
  if (c.mpm.formulation != Formulation::total_lagrangian)
    return "on a lattice; today mpm.formulation \"total_lagrangian\"";
  if (c.mpm.integrator != Integrator::symplectic_euler)
    return "with implicit steps; today mpm.integrator = \"explicit\"";
  if (adheres(c)) return "that adhere; today all surface energies are 0";
  if (c.contact.restitution > 0 || c.contact.activation != Activation::anticipated)
    return "that rebound; today contact.restitution = 0 and contact.activation \"anticipated\"";
  return "";
}

}  // namespace

std::string mixed_cannot(const Case& c) {
  if (!is_mixed(c) || !is_in_a_box(c)) return "";
  const std::string text = missing(c);
  return text.empty() ? "" : "not yet: bonded grains among elastic ones " + text;
}

}  // namespace softgrain
