#pragma once
#include "softgrain/bpm/bonded_sample.hpp"
#include "softgrain/experiment/case.hpp"
#include "softgrain/sample/box_sample.hpp"

namespace softgrain {

/// The sample of a case, the same for every model: its placed grains, or random ones.
BoxSample sample_box(const Case& the_case);
BoxSampleOf<3> sample_solid_box(const Case& the_case);

/// Are its grains still to be poured into the box?
bool is_to_pour(const Case& the_case);
/// The case with its grains in the places where they lie once poured, and the box round them, complete.
/// Raises UsageError as `pour` does, and in space.
Case with_poured_grains(Case the_case);

/// The law of the diameters of a case; shares of area, in space of volume, become numbers.
DiameterLaw diameter_law(const Case::Sizes& sizes, int dimension = 2);

/// What a case says of its sample in more than one place, made one: the smallest and largest diameters follow
/// a list, or with the number of grains all kinds; for placed grains also their number, the box (where the
/// case leaves it open, their bounding box, whose corner comes to (0, 0)), packing fraction and aspect.
Case complete_sample(Case the_case);

/// The aggregates of a packing of bonded grains.
AggregateLibrary library_of(const Case& the_case);

}  // namespace softgrain
