#pragma once
#include <cstdint>
#include <vector>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/rigid/particles.hpp"
#include "softgrain/sample/box_sample.hpp"

namespace softgrain {

/// The aggregates of which the grains of a packing are copies.
struct AggregateLibrary {
  int count = 6;         ///< different ones
  int primaries = 1750;  ///< of each, or of the smallest grain; 1: grains are rigid disks (spheres)
  double size_ratio = 1.625, gamma = 7;
  /// The numbers of primaries grow as the squares of the radii (cubes in space), spread evenly from the
  /// smallest to the largest or as the list says, so that primaries in grains of any size are about equal;
  /// else all have the same.
  bool equal_size = false;
  double smallest = 1.4e-3, largest = 2.4e-3;  ///< diameters of grains [m]
  std::vector<double> diameters{};             ///< of grains, if these are a list [m]
  double density = 990;                        ///< of grains [kg/m^3]
  std::uint64_t seed = 1;
};
template <int Dim = 2>
std::vector<AggregateOf<Dim>> prepare_library(const AggregateLibrary& options);

/// A box of grains of bonded primaries.
template <int Dim>
struct BpmSampleOf {
  RigidParticles<Dim> particles;      ///< grain after grain, at rest; walls as BoxWall
  std::vector<int> begin;             ///< (grains + 1) first primary of each grain
  std::vector<double> mean_distance;  ///< <a0> of each grain [m]; the diameter of a rigid one
  double displaced = 0;               ///< furthest that a grain was moved from its place, over its radius
};
using BpmSample = BpmSampleOf<2>;

/// Puts a copy of an aggregate, scaled and turned, in the place of each grain; it weighs density pi R^2, in
/// space density 4/3 pi R^3. Where bumps of two grains overlap, both are moved apart as wholes by as little
/// as that takes: the grains keep the places of the sample to a small share of their radius. Each kind of
/// grain has a library. Raises UsageError where they cannot be.
template <int Dim>
BpmSampleOf<Dim> fill_box(const BoxSampleOf<Dim>& box,
                          const std::vector<std::vector<AggregateOf<Dim>>>& library,
                          const std::vector<AggregateLibrary>& options);

}  // namespace softgrain
