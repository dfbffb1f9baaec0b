#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/soft_grains.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// All points of a batch as they were placed; nothing where the law has no history.
std::vector<Wide> undeformed_history(const AnyLaw& law, const Topology& topology);

/// What a step did to the points of a grain.
struct FlowOfStep {
  Wide dissipated = 0.0;  ///< [J/m]
  Wide flowing = 0.0;     ///< area of the undeformed points that flowed [m^2]
};

/// The history of the eight grains after a step of dt [s] that ends at their positions, which must be
/// admissible. Nothing where the law has none.
FlowOfStep advance_history(const SoftGrains& grains, GrainBatch& batch, double dt);

/// The sum over all grains: dissipated [J/m], and the share of their area that flowed.
struct FlowOfGrains {
  double dissipated = 0, share = 0;
};
FlowOfGrains sum_of(const SoftGrains& grains, std::span<const FlowOfStep> of_batches);

/// alpha of all points: its mean over the undeformed area, and the largest.
struct PlasticStrain {
  double mean = 0, largest = 0;
};
PlasticStrain plastic_strain(const SoftGrains& grains);

/// Declares the history of all points, eight grains to a row; nothing where the law has none.
void visit_history(SoftGrains& grains, StateVisitor& visit);

}  // namespace softgrain
