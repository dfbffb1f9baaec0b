#pragma once
#include <cstdint>
#include <vector>

namespace softgrain {

/// How the diameters of grains are distributed, by number.
enum class SizeLaw {
  uniform,    ///< between the smallest and the largest
  lognormal,  ///< ln d is normal; cut off below the smallest and above the largest
  list,       ///< given diameters, in given proportions
};

/// A law of diameters and its parameters; those of the other laws are not read.
struct DiameterLaw {
  SizeLaw law = SizeLaw::uniform;
  double smallest = 1.4e-3, largest = 2.4e-3;  ///< [m] of uniform; cut-offs of lognormal
  double median = 1.8e-3;                      ///< [m] of lognormal before it is cut off
  double deviation = 0.15;                     ///< of ln d, lognormal before it is cut off
  std::vector<double> diameters{};             ///< [m] of list
  std::vector<double> numbers{};               ///< how many of each diameter of list, in proportion

  /// The smallest diameter that it gives [m]; of a list without any, which `check` refuses, `smallest`.
  double least() const;
  double greatest() const;  ///< the largest [m], likewise
};

/// Raises UsageError for parameters that are no law: sizes that are not positive or out of order, cut-offs
/// that do not enclose the median, a list and proportions of different lengths.
void check(const DiameterLaw& law);

/// Diameters [m] of so many grains, from the numbers of `stream` under `seed`. Uniform and lognormal: one
/// random number for each grain, from number `first` on, through the inverse of the cumulative distribution.
/// List: as many of each diameter as the proportions say, rounded by largest remainders, in the order of the
/// list, whatever the random numbers.
std::vector<double> draw_diameters(const DiameterLaw& law, int grains, std::uint64_t seed,
                                   std::uint32_t stream, std::uint64_t first);

/// How many of `all` things each sort gets, in these proportions: the whole parts first, what is left by
/// largest remainders.
std::vector<int> counts_in_proportion(const std::vector<double>& proportions, int all);

/// Mean of d [m] and of d^2 [m^2].
double mean_diameter(const DiameterLaw& law);
double mean_square_diameter(const DiameterLaw& law);
/// Of d^3 [m^3].
double mean_cube_diameter(const DiameterLaw& law);

}  // namespace softgrain
