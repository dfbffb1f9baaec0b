#include "softgrain/experiment/solid_case.hpp"

#include "softgrain/experiment/kinds.hpp"
#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

constexpr int most_cells = 24;

std::string not_yet(std::string_view what, std::string_view remedy) {
  return std::string("not yet with experiment.dimension = 3: ").append(what).append("; ").append(remedy);
}

/// Of grains that are not bonded.
std::string not_yet_solid(const Case& c) {
  if (c.contact.surface_energy > 0 || c.contact.wall_surface_energy > 0)
    return not_yet("adhesion of elastic and rigid grains",
                   "leave contact.surface_energy and contact.wall_surface_energy out");
  if (c.mpm.formulation == Formulation::updated_lagrangian)
    return not_yet("mpm.formulation \"updated_lagrangian\"", "write \"total_lagrangian\"");
  if (c.mpm.integrator == Integrator::backward_euler)
    return not_yet(
        "mpm.integrator \"implicit\", which takes ten times the time of explicit steps for a compaction in "
        "space "
        "(docs/decisions/0050)",
        "write \"explicit\" or leave it out");
  for (int k = 0; k < kinds_of(c); ++k) {
    const Case kind = case_of_kind(c, k);
    if (kind.grain.shape == ShapeOfGrain::surface && !is_rigid(kind))
      return not_yet("elastic grains other than spheres",
                     "write model = \"rigid\" for the grains of grain.surface, or leave that out");
    if (kind.grain.shape != ShapeOfGrain::disk && kind.grain.shape != ShapeOfGrain::surface)
      return not_yet("grains other than spheres (ellipses, polygons and outlines)",
                     "give rigid grains a grain.surface from an STL or PLY file, or leave the shape out");
    if (!is_rigid(kind) && law_choice(kind.mpm.law).flows() && kind.mpm.material.kinematic_modulus > 0)
      return not_yet("mpm.kinematic_modulus", "leave it out, and let mpm.hardening_modulus harden alone");
  }
  if (c.mpm.cells > most_cells)
    return not_yet("more than 24 mpm.cells, 32 cells^3 points in a grain",
                   "6 are within 5 %, 8 within 1.5 %");
  return "";
}

}  // namespace

std::string not_yet_in_space(const Case& c) {
  if (!is_in_space(c)) return "";
  if (c.experiment.loading == LoadingPath::shear)
    return not_yet("shear of a cell", "experiment.loading takes \"triaxial\", or tables [[stage]]");
  if (c.experiment.loading == LoadingPath::biaxial)
    return not_yet("the path \"biaxial\", between two walls that rest",
                   "write \"triaxial\", where four side walls keep the stress, or tables [[stage]]");
  if (c.sample.places == Places::pour)
    return not_yet("sample.places \"pour\"", "leave it out: places are random");
  if (c.box.open_top) return not_yet("box.open_top", "leave it out: six walls hold the spheres");
  return is_bonded(c) ? "" : not_yet_solid(c);
}

void set_defaults_of_space(Case& c, const std::function<bool(const char* key)>& is_given) {
  if (!is_in_space(c)) return;
  if (!is_given("mpm.integrator")) c.mpm.integrator = Integrator::symplectic_euler;
  if (!is_given("mpm.cells")) c.mpm.cells = 6;
}

}  // namespace softgrain
