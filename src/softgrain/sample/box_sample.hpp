#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "softgrain/geometry/box.hpp"
#include "softgrain/math/vec.hpp"
#include "softgrain/sample/diameters.hpp"
#include "softgrain/sample/placed_grain.hpp"

namespace softgrain {

/// A box with corner (0, 0).
template <int Dim>
struct BoxSampleOf {
  double width = 0, height = 0;     ///< [m]
  std::array<bool, Dim> repeats{};  ///< along x, y; else there are walls
  std::vector<PlacedGrainOf<Dim>> grains{};
  double depth = 0;  ///< in space along y [m]; 0: as the width

  Vec<Dim> size() const {
    if constexpr (Dim == 2)
      return {width, height};
    else
      return {width, depth > 0 ? depth : width, height};
  }
};
using BoxSample = BoxSampleOf<2>;

/// So many grains of a kind.
struct GrainsOfKind {
  int grains = 0;
  DiameterLaw sizes{};
};

struct BoxSampleOptions {
  int grains = 300;
  DiameterLaw sizes{};
  std::vector<GrainsOfKind> kinds{};  ///< instead of those two: one kind after the other, their places mixed
  double packing_fraction = 0.7;      ///< of the undeformed grains in the box
  double aspect = 1;                  ///< width over height of the box
  std::array<bool, 3> repeats{};      ///< along x, y, and z in space
  double clearance = 0.02;  ///< free distance round each grain, over its radius, where there is room for it
  std::uint64_t seed = 1;
};

/// Random places without overlap: uniform at first, then pairs that overlap are pushed apart until none does.
/// Where that finds no places in some thousand passes, overlaps are relaxed (`relax`) from other places, then
/// with a half and a quarter of the clearance, then with other diameters. The same seed gives the same bits.
/// Raises UsageError, with the largest fraction that is found, if none of them works: few grains do not fill
/// 0.7 of every box (two equal ones fill 0.54 of a square).
BoxSample sample_box(const BoxSampleOptions& given);
/// The same of spheres, turned at random.
BoxSampleOf<3> sample_solid_box(const BoxSampleOptions& given);
/// How the i-th sphere of a sample is turned.
Mat<3> turn_of_sphere(std::uint64_t seed, std::uint64_t i);

/// The largest packing fraction, in hundredths, at which sample_box is sure to find places for these grains,
/// up to that of the options. O(grains), and less than a second for 300.
double largest_packing_fraction(const BoxSampleOptions& given);

/// A box with its corner at (0, 0), with walls or a cell that repeats; walls below and above one grain [m].
/// Raises UsageError for a cell that a grain might meet twice, and for one that repeats along an axis, but
/// not along those before it.
template <int Dim>
Box<Dim> box_of(const BoxSampleOf<Dim>& sample);
Box<2> walls_at(double low, double high);
Box<3> solid_walls_at(double low, double high);

/// Placed grains may overlap by this share of the smaller radius, and reach that far beyond a wall.
inline constexpr double largest_placed_overlap = 0.01;

/// A placed grain that cannot be where it is.
struct Misplaced {
  int grain;
  int other;     ///< which it overlaps; -1: it is outside the box
  double depth;  ///< of the overlap, or how far it is outside [m]
};

/// All of them, by grain. O(n).
template <int Dim>
std::vector<Misplaced> misplaced_grains(const BoxSampleOf<Dim>& sample);

}  // namespace softgrain
