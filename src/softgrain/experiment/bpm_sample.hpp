#pragma once
#include <span>
#include <vector>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// The different aggregates of a packing, `bpm.library` of them. With bpm.equal = "count" all have
/// bpm.primaries; with "size" their numbers grow as the squares of radii spread evenly from the smallest
/// grain, which has bpm.primaries, to the largest, or of those of a list of diameters, so that primaries in
/// grains of any size are about equal.
std::vector<Aggregate> prepare_library(const Case& the_case);

/// A box of grains of bonded primaries.
struct BpmSample {
  RigidParticles<2> particles;        ///< grain after grain, at rest; walls as BoxWall
  std::vector<int> begin;             ///< (grains + 1) first primary of each grain
  std::vector<double> mean_distance;  ///< <a0> of each grain [m]
  double displaced = 0;               ///< furthest that a grain was moved from its place, over its radius
};

/// Puts a copy of an aggregate, scaled and turned, in the place of each grain; it weighs density pi R^2.
/// Where bumps of two grains overlap, both are moved apart as wholes by as little as that takes: the grains
/// keep the places of the sample to a small share of their radius. Raises UsageError where they cannot be.
BpmSample fill_box(const BoxSample& box, const std::vector<Aggregate>& library, const Case& the_case);

}  // namespace softgrain
