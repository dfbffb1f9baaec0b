#include "softgrain/io/case/case_relations.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/lattice_case.hpp"
#include "softgrain/experiment/mixed_case.hpp"
#include "softgrain/experiment/solid_case.hpp"
#include "softgrain/io/case/scope.hpp"
#include "softgrain/io/case/shape_check.hpp"
#include "softgrain/io/case/words.hpp"
#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

std::string unloading_not_ascending(const Case& c) {
  const auto& strains = c.loading.unload_at;
  const auto turn = std::adjacent_find(strains.begin(), strains.end(), std::greater_equal<>{});
  if (turn == strains.end()) return "";
  return fmt::format("loading.unload_at must be ascending: {} stands before {}", *turn, *(turn + 1));
}

std::string unloading_after_the_end(const Case& c) {
  const auto& strains = c.loading.unload_at;
  const auto late =
      std::find_if(strains.begin(), strains.end(), [&](double eps) { return eps >= c.loading.max_strain; });
  if (late == strains.end()) return "";
  return fmt::format("loading.unload_at must be below loading.max_strain: {} is not below {}", *late,
                     c.loading.max_strain);
}

std::string unloading_below_zero(const Case& c) {
  const auto& strains = c.loading.unload_at;
  if (strains.empty() || c.loading.unload_by < strains.front()) return "";
  return fmt::format("loading.unload_by must be below the first of loading.unload_at: {} is not below {}",
                     c.loading.unload_by, strains.front());
}

std::string sweeps_reversed(const Case& c) {
  if (c.solver.min_sweeps <= c.solver.max_sweeps) return "";
  return fmt::format("solver.min_sweeps must not be above solver.max_sweeps: {} is above {}",
                     c.solver.min_sweeps, c.solver.max_sweeps);
}

std::string restitution_anticipated(const Case& c) {
  if (c.experiment.model != GrainModel::bpm || c.contact.restitution == 0 ||
      c.contact.activation != Activation::anticipated)
    return "";
  return fmt::format(
      "contact.restitution {} needs contact.activation \"closed_at_mid_step\" or \"closed_at_end_of_step\": "
      "anticipated contacts stop the particles before they touch",
      c.contact.restitution);
}

std::string diameters_reversed(const Case& c) {
  if (c.sample.smallest_diameter <= c.sample.largest_diameter || c.sample.sizes == SizeLaw::list) return "";
  return fmt::format("sample.smallest_diameter must not be above sample.largest_diameter: {} m is above {} m",
                     c.sample.smallest_diameter, c.sample.largest_diameter);
}

std::string median_cut_off(const Case& c) {
  const auto& [low, median, high] =
      std::tie(c.sample.smallest_diameter, c.sample.median_diameter, c.sample.largest_diameter);
  if (!scope::lognormal.covers(c) || (low <= median && median <= high)) return "";
  return fmt::format(
      "sample.smallest_diameter and sample.largest_diameter must enclose sample.median_diameter, whose law "
      "they cut off: {} m is not in [{} m, {} m]",
      median, low, high);
}

std::string list_incomplete(const Case& c) {
  const Case::Sample& s = c.sample;
  if (!scope::listed.covers(c)) return "";
  if (s.diameters.empty())
    return "sample.sizes \"list\" needs sample.diameters, as in [\"1 mm\", \"1.4 mm\"]";
  if (!s.shares.empty() && !s.numbers.empty())
    return "sample.shares and sample.numbers both say how many grains have each diameter: give one of them";
  for (const auto& [name, list] : {std::pair("shares", &s.shares), std::pair("numbers", &s.numbers)})
    if (!list->empty() && list->size() != s.diameters.size())
      return fmt::format("sample.{} must have a number for each of sample.diameters: {} for {}", name,
                         list->size(), s.diameters.size());
  return "";
}

std::string box_impossible(const Case& c) {
  constexpr double most_random = 0.8, longest = 1e4;
  if (scope::random.covers(c) && c.sample.places == Places::random &&
      c.sample.packing_fraction >= most_random)
    return fmt::format(
        "sample.packing_fraction = {} is out of range: for random grains it must be in (0, {})",
        c.sample.packing_fraction, most_random);
  if (!scope::placed.covers(c)) return "";
  if (c.sample.packing_fraction >= 1)
    return fmt::format(
        "the grains of the sample fill {:.3g} of their box: make box.width or box.height larger",
        c.sample.packing_fraction);
  if (std::max(c.sample.aspect, 1 / c.sample.aspect) > longest)
    return fmt::format("the box of the sample is {:.3g} times as wide as high: give box.width and box.height",
                       c.sample.aspect);
  return "";
}

/// Before, this key was the friction inside the grain.
std::string friction_inside_a_grain(const Case& c) {
  if (!scope::bpm_between_walls.covers(c) || c.contact.friction == 0) return "";
  return fmt::format(
      "contact.friction acts between grains, and here is one: for the friction between its primaries write "
      "bpm.inner_friction = {}",
      c.contact.friction);
}

std::string too_many_steps(const Case& c) {
  constexpr double most = 1e12;
  if (!median_cut_off(c).empty() || !list_incomplete(c).empty()) return "";  // no sizes, no steps
  const double steps = estimate(c).steps;
  if (steps <= most) return "";
  return fmt::format("about {:.1g} time steps are too many: raise the time step or loading.wall_velocity",
                     steps);
}

std::string too_dense_from_the_start(const Case& c) {
  const double last = c.loading.max_packing_fraction, first = first_packing_fraction(c);
  if (!scope::to_a_fraction.covers(c) || last == 0 || last > first) return "";
  return fmt::format("loading.max_packing_fraction must be above sample.packing_fraction: {} is not above {}",
                     last, first);
}

std::string cannot_hold_a_stress(const Case& c) {
  if (c.loading.hold_stress == 0 || !c.stages.empty()) return "";
  if (c.experiment.loading == LoadingPath::diametral)
    return "loading.hold_stress needs a box: experiment.loading \"compaction\" or \"isotropic\"";
  return c.loading.hold > 0 ? "" : "loading.hold_stress needs loading.hold > 0: for how long";
}

std::string stages_and_path_differ(const Case& c) {
  const LoadingPath path = c.experiment.loading;
  if (c.stages.empty())
    return path != LoadingPath::stages ? "" : "experiment.loading \"stages\" needs tables [[stage]]";
  if (path == LoadingPath::stages || path == LoadingPath::diametral) return "";
  return fmt::format(
      "experiment.loading \"{}\" and [[stage]] both say what the walls do: write \"stages\", or leave one of "
      "them "
      "out",
      word_of(path));
}

/// What a short form cannot do without.
std::string path_incomplete(const Case& c) {
  const auto needs = [&](const char* key, const char* what) {
    return fmt::format("experiment.loading \"{}\" needs loading.{} > 0: {}", word_of(c.experiment.loading),
                       key, what);
  };
  if (scope::confining.covers(c) && c.loading.confining_stress == 0)
    return needs("confining_stress", "the stress that is kept");
  if (scope::is_path(c, LoadingPath::die) && c.loading.max_stress == 0)
    return needs("max_stress", "the stress to which the top wall presses");
  if (scope::relaxing.covers(c) && c.loading.hold == 0) return needs("hold", "how long the walls rest");
  return "";
}

/// What a path asks of walls or of a cell that the box does not have.
std::string box_unfit(const Case& c) {
  const auto repeats = repeats_of(c);
  if (repeats[1] && !repeats[0])
    return "box.y \"periodic\" with walls in x: turn the box, so that box.x is \"periodic\"";
  if (repeats[2] && !repeats[1])
    return "box.z \"periodic\" with walls in y: turn the box, so that box.x and box.y are \"periodic\"";
  const bool weightless = is_in_space(c) ? gravity_of<3>(c) == Vec<3>{} : gravity_of(c) == Vec<2>{};
  if (repeats_in_height(c) && !weightless)
    return "gravity lets a cell that is periodic along all axes fall for ever: box.gravity_x and gravity_y "
           "need walls in y, in space in z";
  if (c.box.gravity_z != 0 && !is_in_space(c))
    return "box.gravity_z belongs to experiment.dimension = 3: in the plane box.gravity_y pulls down";
  if (scope::is_path(c, LoadingPath::triaxial) && !is_in_space(c))
    return "experiment.loading \"triaxial\" belongs to experiment.dimension = 3: in the plane it is "
           "\"biaxial\"";
  if (c.box.open_top && (repeats[1] || c.stages.empty()))
    return "box.open_top needs walls in y, and [[stage]] that say when the top wall comes: the short paths "
           "move "
           "it from the start";
  if (scope::shearing.covers(c) && !repeats[1])
    return "experiment.loading \"shear\" shears a cell: it needs box.x and box.y \"periodic\"";
  if (scope::is_path(c, LoadingPath::die) && repeats[0])
    return "experiment.loading \"die\" needs walls: leave out box.x and box.y \"periodic\"";
  return "";
}

/// What the law says of its parameters together.
std::string law_impossible(const Case& c) {
  if (c.experiment.model != GrainModel::mpm) return "";
  try {
    make_law(c.mpm.law, c.mpm.material);
    return "";
  } catch (const UsageError& error) {
    return fmt::format("mpm.law \"{}\": {}", word_of(c.mpm.law), error.what());
  }
}

std::string formulation_cannot(const Case& c) {
  const bool updated = c.mpm.formulation == Formulation::updated_lagrangian;
  if (!is_elastic(c)) return "";
  if (std::string cannot = lattice_cannot(c); !cannot.empty()) return cannot;
  if (updated && law_impossible(c).empty() && law_choice(c.mpm.law).remembers())
    return fmt::format("mpm.formulation \"updated_lagrangian\" takes elastic laws only, not mpm.law \"{}\"",
                       word_of(c.mpm.law));
  if (!updated && c.mpm.contact_on != ContactOn::outline)
    return fmt::format("mpm.contact_on \"{}\" needs mpm.formulation \"updated_lagrangian\"",
                       word_of(c.mpm.contact_on));
  return "";
}

/// One rigid grain between walls that come together.
std::string rigid_grain_alone(const Case& c) {
  if (!is_rigid(c) || is_in_a_box(c)) return "";
  return "a rigid grain between two walls does not give way: experiment.model \"rigid\" needs grains in a "
         "box, experiment.loading \"compaction\" or another but \"diametral\"";
}

std::string kinds_cannot(const Case& c) {
  if (c.kinds.empty()) return "";
  return is_in_a_box(c)
             ? ""
             : "several [[kind]] need a box: experiment.loading \"compaction\" or another but \"diametral\"";
}

std::vector<std::string> keys_of_laws() {
  std::vector<std::string> keys{"mpm.law"};
  for (const MaterialParameter& p : material_parameters) keys.push_back(fmt::format("mpm.{}", p.name));
  return keys;
}

}  // namespace

const std::vector<Relation>& case_relations() {
  static const std::vector<Relation> relations{
      {keys_of_laws(), law_impossible},
      {{"loading.unload_at"}, unloading_not_ascending},
      {{"loading.unload_at", "loading.max_strain"}, unloading_after_the_end},
      {{"loading.unload_by", "loading.unload_at"}, unloading_below_zero},
      {{"solver.min_sweeps", "solver.max_sweeps"}, sweeps_reversed},
      {{"sample.smallest_diameter", "sample.largest_diameter"}, diameters_reversed},
      {{"sample.smallest_diameter", "sample.median_diameter", "sample.largest_diameter", "sample.sizes"},
       median_cut_off},
      {{"sample.diameters", "sample.shares", "sample.numbers", "sample.sizes"}, list_incomplete},
      {{"sample.packing_fraction", "sample.placed", "box.width", "box.height"}, box_impossible},
      {{"contact.friction", "experiment.model", "experiment.loading"}, friction_inside_a_grain},
      {{"time.step"}, bond_step_too_long},
      {{"contact.restitution", "contact.activation"}, restitution_anticipated},
      {{"time.step", "loading.wall_velocity", "loading.max_strain", "grain.radius", "grain.density",
        "bpm.attraction", "bpm.force", "bpm.cohesive_pressure", "bpm.primaries", "bpm.size_ratio",
        "bpm.exponent", "sample.smallest_diameter"},
       too_many_steps},
      {{"mpm.formulation", "mpm.contact_on", "experiment.loading", "mpm.law"}, formulation_cannot},
      {{"loading.max_packing_fraction", "sample.packing_fraction"}, too_dense_from_the_start},
      {{"loading.hold_stress", "loading.hold", "experiment.loading"}, cannot_hold_a_stress},
      {{"experiment.loading"}, stages_and_path_differ},
      {{"experiment.model", "experiment.loading"}, kinds_cannot},
      {{"experiment.model", "experiment.loading"}, rigid_grain_alone},
      {{"experiment.model", "experiment.dimension", "experiment.loading", "mpm.integrator", "mpm.formulation",
        "contact.surface_energy", "contact.wall_surface_energy", "contact.restitution", "contact.activation"},
       mixed_cannot},
      {{"grain.shape", "grain.outline", "grain.surface", "grain.aspect", "grain.sides", "mpm.cells"},
       shape_cannot},
      {{"experiment.loading", "loading.confining_stress", "loading.max_stress", "loading.hold",
        "loading.shear_rate"},
       path_incomplete},
      {{"experiment.dimension", "experiment.model", "experiment.loading", "mpm.integrator", "mpm.formulation",
        "mpm.law", "mpm.cells", "box.open_top", "contact.surface_energy", "contact.wall_surface_energy"},
       not_yet_in_space},
      {{"experiment.loading", "box.x", "box.y", "box.z", "box.gravity_x", "box.gravity_y", "box.gravity_z",
        "box.open_top"},
       box_unfit},
  };
  return relations;
}

}  // namespace softgrain
