#include <algorithm>
#include <utility>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/mixed_case.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/mixed/mixed_grains.hpp"
#include "softgrain/soft/stable_step.hpp"

namespace softgrain {
namespace {

/// Of the grains of a sample those of one engine, with its numbers of kinds.
struct Selected {
  std::vector<PlacedGrain> grains;
  std::vector<int> number;  ///< in the sample
};
Selected select(const BoxSample& sample, const PartOfCase& part) {
  Selected selected;
  for (int g = 0; g < static_cast<int>(sample.grains.size()); ++g) {
    PlacedGrain grain = sample.grains[g];
    grain.kind = part.number[grain.kind];
    if (grain.kind < 0) continue;
    selected.grains.push_back(grain);
    selected.number.push_back(g);
  }
  return selected;
}

/// Some of the grains of a sample.
BpmSample grains_of_sample(const BpmSample& all, const std::vector<int>& number) {
  BpmSample some;
  std::vector<Vec<2>> position;
  std::vector<double> radius, mass;
  std::vector<int> grain_of;
  for (const int g : number) {
    some.begin.push_back(static_cast<int>(position.size()));
    some.mean_distance.push_back(all.mean_distance[g]);
    for (int i = all.begin[g]; i < all.begin[g + 1]; ++i) {
      position.push_back(all.particles.position[i]);
      radius.push_back(all.particles.radius[i]);
      mass.push_back(all.particles.mass[i]);
      grain_of.push_back(static_cast<int>(some.begin.size()) - 1);
    }
  }
  some.begin.push_back(static_cast<int>(position.size()));
  some.particles =
      rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), all.particles.walls);
  some.particles.cell = all.particles.cell;
  some.particles.grain = std::move(grain_of);
  return some;
}

}  // namespace

PlacedModel mixed_grains_of(const Case& c) {
  const std::string cannot = mixed_cannot(c);
  require(cannot.empty(), "{}", cannot);
  require(communicator().ranks() == 1,
          "not yet: ranks share no work of bonded grains among elastic ones: run softgrain alone");
  check_time_step(c);
  const PartOfCase elastic = part_of(c, GrainModel::mpm), bonded = part_of(c, GrainModel::bpm);
  const BoxSample sample = sample_box(c);
  const BpmSample filled = filled_box(c, sample);  // an elastic grain has one primary in its place
  Selected soft = select(sample, elastic), hard = select(sample, bonded);
  for (std::size_t k = 0; k < soft.grains.size(); ++k)
    soft.grains[k].centre = filled.particles.position[filled.begin[soft.number[k]]];
  const Box<2> box = box_of(sample);
  MixedGrainsSetup setup{
      .elastic = explicit_dynamics_of(elastic.the_case, soft.grains, box),
      .bonded = bonded_setup(bonded.the_case, grains_of_sample(filled, hard.number), hard.grains),
      .elastic_number = soft.number,
      .bonded_number = hard.number,
      .kind = {},
      .kinds = kinds_of(c),
      .pair_friction = pair_friction_of(c)};
  setup.bonded.options.precision = Precision::full;
  for (const PlacedGrain& grain : sample.grains) setup.kind.push_back(grain.kind);
  const double dt = c.time.step > 0 ? c.time.step
                                    : std::min(stable_time_step(setup.elastic.grains),
                                               checked_bonded_time_step(bonded.the_case));
  return {std::make_unique<MixedGrains>(std::move(setup)), box, dt};
}

}  // namespace softgrain
