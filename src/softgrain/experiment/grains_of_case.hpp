#pragma once
#include <memory>
#include <vector>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/bpm/bonded_sample.hpp"
#include "softgrain/contact/pair_friction.hpp"
#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/soft/explicit_step.hpp"

namespace softgrain {

/// Grains of a case in their box, with the time step of the run.
template <int Dim>
struct PlacedModelOf {
  std::unique_ptr<ModelOf<Dim>> model;
  Box<Dim> box;
  double time_step = 0;  ///< [s]
};

using PlacedModel = PlacedModelOf<2>;

/// One grain between two walls, or the grains of a box. Raises UsageError.
template <int Dim>
PlacedModelOf<Dim> bonded_grains_of(const Case& the_case);
PlacedModel elastic_grains_of(const Case& the_case);
/// Bonded grains among elastic ones, in a box.
PlacedModel mixed_grains_of(const Case& the_case);
PlacedModelOf<3> solid_grains_of(const Case& the_case);

/// The grains of a box made of primaries, those that are not bonded of one each. Raises UsageError.
template <int Dim>
BpmSampleOf<Dim> filled_box(const Case& the_case, const BoxSampleOf<Dim>& box);
/// Of these grains, which have their primaries in the sample.
BondedGrainsSetup bonded_setup(const Case& the_case, BpmSample sample,
                               const std::vector<PlacedGrain>& grains);
/// Elastic grains in these places, explicit.
ExplicitDynamics explicit_dynamics_of(const Case& the_case, const std::vector<PlacedGrain>& grains,
                                      const Box<2>& box);

/// Friction of the pairs of kinds of a case.
std::vector<PairFriction> pair_friction_of(const Case& the_case);

/// The longest time step [s] with which an explicit run of the case is stable from its start on, with grains
/// of the smallest radius that it allows; infinite where the integrator or the model has no such limit. While
/// it runs, cells that become stiffer are followed by sub-steps.
double longest_time_step(const Case& the_case);

/// Raises UsageError if the case gives a longer one.
void check_time_step(const Case& the_case);

}  // namespace softgrain
