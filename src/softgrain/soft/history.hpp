#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/soft_grains.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// So many points of a batch as they were placed; nothing where the law has no history.
template <int Dim>
std::vector<Wide> undeformed_history(const AnyLaw& law, std::size_t points);

/// What a step did to the points of a grain.
struct FlowOfStep {
  Wide dissipated = 0.0;  ///< [J/m in the plane]
  Wide flowing = 0.0;     ///< area of the undeformed points that flowed [m^2], in space their volume [m^3]
};

/// The history of the eight grains after a step of dt [s] that ends at their positions, which must be
/// admissible. Nothing where the law has none.
FlowOfStep advance_history(const SoftGrains& grains, GrainBatch& batch, double dt);

/// The sum over all grains: dissipated [J/m in the plane], and the share of their area, or volume, that
/// flowed.
struct FlowOfGrains {
  double dissipated = 0, share = 0;
};
template <int Dim>
FlowOfGrains sum_of(const GrainsOf<Dim>& grains, std::span<const FlowOfStep> of_batches);

/// alpha of all points: its mean over the undeformed area or volume, and the largest.
struct PlasticStrain {
  double mean = 0, largest = 0;
};
template <int Dim>
PlasticStrain plastic_strain(const GrainsOf<Dim>& grains);

/// Declares the history of all points, eight grains to a row; nothing where the law has none.
template <int Dim>
void visit_history(GrainsOf<Dim>& grains, StateVisitor& visit);

}  // namespace softgrain
