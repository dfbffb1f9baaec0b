#pragma once
#include "softgrain/geometry/periodic_cell.hpp"
#include "softgrain/sample/box_sample.hpp"

namespace softgrain {

/// The cell of a sample that repeats.
template <int Dim>
PeriodicCell<Dim> cell_of(const BoxSampleOf<Dim>& sample);

/// Pushes grains, each grown by a clearance over its radius, out of the walls and out of each other once;
/// returns the largest overlap met [m]. widest: the largest radius [m].
template <int Dim>
double push_apart(BoxSampleOf<Dim>& sample, double clearance, double widest);

/// Moves them to where no overlap of the grown grains is above `tolerance` [m], from where they are, along
/// the way down of
///   E = 1/2 sum over pairs and walls of overlap^2,
/// as bodies of equal mass that lose their speed where it leads uphill (FIRE: Bitzek et al., Phys. Rev. Lett.
/// 97, 170201, 2006). False if they are jammed first.
template <int Dim>
bool relax(BoxSampleOf<Dim>& sample, double clearance, double tolerance);

}  // namespace softgrain
