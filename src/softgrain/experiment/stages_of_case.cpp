#include "softgrain/experiment/stages_of_case.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/shape_of_case.hpp"

namespace softgrain {
namespace {

constexpr std::size_t yy = number_of(Part::yy), top = number_of(Part::top);

Drive at_velocity(Part part, double velocity) {
  return {.part = part, .control = Control::velocity, .value = velocity};
}
Drive keeps(Part part, double stress) { return {.part = part, .control = Control::stress, .value = stress}; }

Stage rest(double time) { return {.name = "rest", .until = {.time = time}}; }

/// What presses along y: the top wall, or the cell.
Part pressing(const Case& c) { return repeats_in_height(c) ? Part::yy : Part::top; }

/// The pairs of side walls; in space those along y and along x.
std::vector<Part> sides(const Case& c) {
  return is_in_space(c) ? std::vector{Part::xx, Part::xy} : std::vector{Part::xx};
}
std::vector<Drive> all_keep(const Case& c, double stress) {
  std::vector<Drive> drives{keeps(Part::yy, stress)};
  for (const Part side : sides(c)) drives.push_back(keeps(side, stress));
  return drives;
}

/// Strain by which the sides of a die open at most.
constexpr double most_opened = 0.1;

/// What a short form leaves its path for.
std::vector<Exit> exits_of(const Case& c) {
  std::vector<Exit> exits;
  if (!is_in_a_box(c)) return exits;
  if (c.loading.max_stress > 0)
    exits.push_back({.stress = c.loading.max_stress, .key = "loading.max_stress"});
  if (c.loading.max_overlap > 0)
    exits.push_back({.overlap = c.loading.max_overlap, .key = "loading.max_overlap"});
  if (c.loading.hold_stress > 0)
    exits.push_back({.stress = c.loading.hold_stress, .key = "loading.hold_stress", .to_last = true});
  return exits;
}

/// Diametral, compaction and isotropic.
std::vector<Stage> turning(const Case& c) {
  const Case::Loading& loading = c.loading;
  const Part part = is_isotropic(c) ? Part::all : pressing(c);
  std::vector<Stage> stages;
  const auto go_to = [&](double strain) {
    Stage stage{.name = "move", .drives = {at_velocity(part, loading.wall_velocity)}, .towards = true};
    stage.until.strain[0] = strain;
    stages.push_back(stage);
    if (loading.hold > 0) stages.push_back(rest(loading.hold));
  };
  const double last = last_strain(c);
  for (const double turn : loading.unload_at) {
    if (turn >= last) break;
    go_to(turn);
    go_to(turn - loading.unload_by);
  }
  go_to(last);
  for (Stage& stage : stages) stage.exits = exits_of(c);
  if (!is_in_a_box(c) || loading.hold_stress == 0) return stages;
  Stage hold{.name = "hold",
             .drives = {keeps(pressing(c), loading.hold_stress)},
             .until = {.time = loading.hold},
             .only_by_exit = true,
             .key = "loading.hold_stress"};
  if (is_isotropic(c)) hold.drives = all_keep(c, loading.hold_stress);
  stages.push_back(hold);
  return stages;
}

/// Isotropic to the confining stress, which is then kept for a while.
std::vector<Stage> confined(const Case& c) {
  const double v = c.loading.wall_velocity, confining = c.loading.confining_stress;
  Stage confine{.name = "confine",
                .drives = {at_velocity(Part::all, v)},
                .key = "loading.confining_stress",
                .limit = c.loading.max_strain};
  confine.until.stress[yy] = confining;
  const Stage keep{.name = "keep",
                   .drives = all_keep(c, confining),
                   .until = {.time = c.loading.hold},
                   .key = "loading.confining_stress"};
  if (c.loading.hold == 0) return {confine};
  return {confine, keep};
}

/// In space triaxial.
std::vector<Stage> biaxial(const Case& c) {
  const double v = c.loading.wall_velocity, confining = c.loading.confining_stress;
  Stage compress{.name = "compress", .drives = all_keep(c, confining), .key = "loading.confining_stress"};
  compress.drives.front() = at_velocity(Part::yy, v);
  compress.until.strain[0] = c.loading.max_strain;
  if (c.loading.max_stress > 0)
    compress.exits = {{.stress = c.loading.max_stress, .key = "loading.max_stress"}};
  std::vector<Stage> stages = confined(c);
  stages.push_back(compress);
  return stages;
}

/// Simple shear of a periodic cell while it keeps the vertical stress.
std::vector<Stage> shear(const Case& c) {
  Stage shear{.name = "shear",
              .drives = {{.part = Part::xy, .control = Control::rate, .value = c.loading.shear_rate},
                         keeps(Part::yy, c.loading.confining_stress)},
              .key = "loading.confining_stress"};
  shear.until.strain[2] = c.loading.max_shear;
  std::vector<Stage> stages = confined(c);
  stages.push_back(shear);
  return stages;
}

std::vector<Stage> die(const Case& c) {
  const double v = c.loading.wall_velocity, stress = c.loading.max_stress;
  constexpr std::string_view key = "loading.max_stress";
  Stage press{
      .name = "press", .drives = {at_velocity(Part::top, v)}, .key = key, .limit = c.loading.max_strain};
  press.until.stress[top] = stress;
  const Stage hold{
      .name = "hold", .drives = {keeps(Part::top, stress)}, .until = {.time = c.loading.hold}, .key = key};
  Stage unload{.name = "unload", .drives = {at_velocity(Part::top, -v)}};
  unload.until.stress[top] = 0;
  std::vector<Stage> stages{press, hold, unload};
  if (c.loading.eject) {
    Stage eject{.name = "eject"}, lift = unload;
    for (const Part side : sides(c)) eject.drives.push_back(at_velocity(side, -v));
    eject.limit = -most_opened;
    lift.name = "lift";
    lift.limit = -most_opened / 2;
    for (const Part side : sides(c)) {  // all of them until one bears nothing, and until the others do not
      eject.until.stress = {};
      eject.until.stress[number_of(side)] = 0;
      stages.push_back(eject);
    }
    stages.insert(stages.end(), {lift, rest(c.loading.hold)});
  }
  if (c.loading.hold == 0) std::erase_if(stages, [](const Stage& stage) { return stage.until.time == 0; });
  return stages;
}

std::vector<Stage> relaxation(const Case& c) {
  Stage press{
      .name = "press", .drives = {at_velocity(pressing(c), c.loading.wall_velocity)}, .towards = true};
  press.until.strain[0] = last_strain(c);
  press.exits = exits_of(c);
  Stage relax = rest(c.loading.hold);
  if (c.loading.rest > 0) relax.until.rest = c.loading.rest;
  return {press, relax};
}

void check_turns(const Case::Loading& loading) {
  double strain = 0;
  for (const double turn : loading.unload_at) {
    require(turn > strain && turn < loading.max_strain && loading.unload_by > 0 && loading.unload_by < turn,
            "loading.unload_at must rise and stay below loading.max_strain {}, with 0 < loading.unload_by {} "
            "< each; got {}",
            loading.max_strain, loading.unload_by, turn);
    strain = turn - loading.unload_by;
  }
}

/// Of one grain between two walls [m].
double height_of_grain(const Case& c) {
  if (c.grain.shape == ShapeOfGrain::disk) return 2 * c.grain.radius;
  const auto [low, high] = between_walls(c);
  return high - low;
}

}  // namespace

LoadingFrame frame_of(const Case& c) {
  LoadingFrame frame{
      .measure = {},
      .wall_velocity = c.loading.wall_velocity,
      .aspect = c.sample.aspect,
      .aspect_y = is_in_space(c) && !c.sample.placed.empty() ? c.box.depth / c.box.height : c.sample.aspect,
      .packing_fraction = first_packing_fraction(c),
      .dimension = c.experiment.dimension};
  if (!is_in_a_box(c)) frame.measure = {StrainMeasure::Kind::of_grain, height_of_grain(c)};
  return frame;
}

double last_strain(const Case& c) {
  if (!c.stages.empty()) {
    double last = 0;
    for (const Stage& stage : c.stages) last = std::max(last, stage.until.strain[0].value_or(0));
    return last;
  }
  if (c.loading.max_packing_fraction == 0 || !is_in_a_box(c)) return c.loading.max_strain;
  const double filled = std::log(c.loading.max_packing_fraction / first_packing_fraction(c));
  return std::min(c.loading.max_strain, filled / (is_isotropic(c) ? c.experiment.dimension : 1));
}

void check_loading(const Case& c) {
  const Case::Loading& loading = c.loading;
  require(loading.wall_velocity > 0, "loading.wall_velocity must be > 0, got {} m/s", loading.wall_velocity);
  if (!c.stages.empty()) return check_stages(c.stages, c.experiment.dimension);
  require(loading.max_strain > 0, "loading.max_strain must be > 0, got {}", loading.max_strain);
  require(loading.hold >= 0, "loading.hold must be >= 0, got {} s", loading.hold);
  require(loading.hold_stress == 0 || loading.hold > 0,
          "loading.hold_stress {} Pa needs loading.hold > 0: for how long", loading.hold_stress);
  const LoadingPath path = c.experiment.loading;
  if (path == LoadingPath::diametral || path == LoadingPath::compaction || path == LoadingPath::isotropic)
    check_turns(loading);
}

std::vector<Stage> stages_of(const Case& c) {
  if (!c.stages.empty()) return c.stages;
  switch (c.experiment.loading) {
    case LoadingPath::biaxial:
    case LoadingPath::triaxial:
      return biaxial(c);
    case LoadingPath::shear:
      return shear(c);
    case LoadingPath::die:
      return die(c);
    case LoadingPath::relaxation:
      return relaxation(c);
    default:
      return turning(c);
  }
}

double least_kept_stress(const Case& c) {
  double least = 0;
  for (const Stage& stage : stages_of(c))
    for (const Drive& drive : stage.drives)
      if (drive.control == Control::stress) least = least == 0 ? drive.value : std::min(least, drive.value);
  return least;
}

double stress_beside_motion(const Case& c) {
  double largest = 0;
  for (const Stage& stage : stages_of(c)) {
    const auto is_given = [](const Drive& drive) { return drive.is_given() && drive.value != 0; };
    if (std::none_of(stage.drives.begin(), stage.drives.end(), is_given)) continue;
    for (const Drive& drive : stage.drives)
      if (drive.control == Control::stress) largest = std::max(largest, drive.value);
  }
  return largest;
}

double largest_named_stress(const Case& c) {
  double largest = 0;
  for (const Stage& stage : stages_of(c)) {
    for (const Drive& drive : stage.drives)
      if (drive.control == Control::stress) largest = std::max(largest, drive.value);
    for (const auto& stress : stage.until.stress) largest = std::max(largest, stress.value_or(0));
    for (const Exit& exit : stage.exits) largest = std::max(largest, exit.stress);
  }
  return largest;
}

}  // namespace softgrain
