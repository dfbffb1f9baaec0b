#include "softgrain/experiment/solid_case.hpp"

#include <algorithm>
#include <array>

#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

constexpr int most_cells = 24;

bool is_known_path(LoadingPath path) {
  constexpr std::array known{LoadingPath::diametral, LoadingPath::compaction, LoadingPath::isotropic,
                             LoadingPath::relaxation};
  return std::find(known.begin(), known.end(), path) != known.end();
}

}  // namespace

std::string not_yet_in_space(const Case& c) {
  if (!is_in_space(c)) return "";
  const auto not_yet = [](std::string_view what, std::string_view remedy) {
    return std::string("not yet with experiment.dimension = 3: ").append(what).append("; ").append(remedy);
  };
  if (c.experiment.model != GrainModel::mpm)
    return not_yet("bonded grains", "write experiment.model = \"mpm\"");
  if (c.mpm.formulation == Formulation::updated_lagrangian)
    return not_yet("mpm.formulation \"updated_lagrangian\"", "write \"total_lagrangian\"");
  if (c.mpm.integrator == Integrator::backward_euler)
    return not_yet(
        "mpm.integrator \"implicit\", which takes ten times the time of explicit steps for a compaction in "
        "space "
        "(docs/decisions/0050)",
        "write \"explicit\" or leave it out");
  if (!c.kinds.empty()) return not_yet("several [[kind]]", "give one kind");
  if (!c.stages.empty() || !is_known_path(c.experiment.loading))
    return not_yet(
        "this loading path",
        "experiment.loading takes \"diametral\", \"compaction\", \"isotropic\" and \"relaxation\"");
  if (!c.sample.placed.empty())
    return not_yet("placed grains (sample.file)", "leave it out: places are random");
  const auto repeats = repeats_of(c);
  if (repeats[0] || repeats[1])
    return not_yet("a periodic box", "write box.x = \"walls\" and box.y = \"walls\"");
  if (c.box.gravity_x != 0 || c.box.gravity_y != 0)
    return not_yet("gravity", "leave box.gravity_x and box.gravity_y out");
  if (c.contact.surface_energy > 0 || c.contact.wall_surface_energy > 0)
    return not_yet("adhesion", "leave contact.surface_energy and contact.wall_surface_energy out");
  if (c.output.report) return not_yet("the page of a run", "write output.report = false, or leave it out");
  if (law_choice(c.mpm.law).remembers())
    return not_yet("a law of the material that flows, creeps or relaxes", "write mpm.law = \"neo_hookean\"");
  if (c.mpm.cells > most_cells)
    return not_yet("more than 24 mpm.cells, 32 cells^3 points in a grain",
                   "6 are within 5 %, 8 within 1.5 %");
  return "";
}

}  // namespace softgrain
