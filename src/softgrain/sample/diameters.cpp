#include "softgrain/sample/diameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "softgrain/core/error.hpp"
#include "softgrain/math/random.hpp"

namespace softgrain {
namespace {

/// Phi(z) of the standard normal distribution.
double normal_cdf(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// A normal variable z = (ln d - ln median)/sigma between two cut-offs that enclose 0.
struct CutNormal {
  double low, high;

  explicit CutNormal(const DiameterLaw& law)
      : low(std::log(law.smallest / law.median) / law.deviation),
        high(std::log(law.largest / law.median) / law.deviation) {}

  /// Of z below both cut-offs and of z in between, where all z are shifted down by s.
  double between(double s = 0) const { return normal_cdf(high - s) - normal_cdf(low - s); }

  /// z with the share u of the distribution below it, by bisection down to neighbouring numbers.
  double quantile(double u) const {
    const double below = normal_cdf(low), target = below + u * between();
    double a = low, b = high;
    for (double z = (a + b) / 2; a < z && z < b; z = (a + b) / 2) (normal_cdf(z) < target ? a : b) = z;
    return b;
  }
};

/// Mean of d^power, power 1, 2 or 3.
double moment(const DiameterLaw& law, int power) {
  const double a = law.smallest, b = law.largest;
  if (law.law == SizeLaw::uniform)
    return power == 1   ? (a + b) / 2
           : power == 2 ? (a * a + a * b + b * b) / 3
                        : (a + b) * (a * a + b * b) / 4;
  if (law.law == SizeLaw::lognormal) {
    if (a == b) return std::pow(a, power);
    // E d^k = median^k e^(k^2 sigma^2/2) [Phi(high - k sigma) - Phi(low - k sigma)] / [Phi(high) - Phi(low)]
    const CutNormal z(law);
    const double shift = power * law.deviation;
    return std::pow(law.median, power) * std::exp(shift * shift / 2) * z.between(shift) / z.between();
  }
  double sum = 0, numbers = 0;
  for (std::size_t k = 0; k < law.diameters.size(); ++k) {
    sum += law.numbers[k] * std::pow(law.diameters[k], power);
    numbers += law.numbers[k];
  }
  return sum / numbers;
}

}  // namespace

std::vector<int> counts_in_proportion(const std::vector<double>& proportions, int all) {
  const double sum = std::accumulate(proportions.begin(), proportions.end(), 0.0);
  std::vector<int> counts, order;
  std::vector<double> remainder;
  int left = all;
  for (const double proportion : proportions) {
    const double exact = all * (proportion / sum);
    counts.push_back(static_cast<int>(exact));
    remainder.push_back(exact - counts.back());
    left -= counts.back();
    order.push_back(static_cast<int>(order.size()));
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return remainder[a] > remainder[b]; });
  for (int k = 0; k < left; ++k) ++counts[order[k % order.size()]];
  return counts;
}

double DiameterLaw::least() const {
  return law == SizeLaw::list && !diameters.empty() ? *std::min_element(diameters.begin(), diameters.end())
                                                    : smallest;
}
double DiameterLaw::greatest() const {
  return law == SizeLaw::list && !diameters.empty() ? *std::max_element(diameters.begin(), diameters.end())
                                                    : largest;
}

void check(const DiameterLaw& law) {
  if (law.law == SizeLaw::list) {
    require(!law.diameters.empty() && law.diameters.size() == law.numbers.size(),
            "a list of diameters needs one proportion for each: {} diameters, {} proportions",
            law.diameters.size(), law.numbers.size());
    const auto positive = [](const std::vector<double>& numbers) {
      return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number > 0; });
    };
    require(positive(law.diameters) && positive(law.numbers), "diameters and their proportions must be > 0");
    return;
  }
  require(law.smallest > 0 && law.largest >= law.smallest,
          "diameters must be positive and in order, got {} m and {} m", law.smallest, law.largest);
  if (law.law == SizeLaw::uniform) return;
  require(law.deviation > 0, "the deviation of ln d must be > 0, got {}", law.deviation);
  require(law.smallest <= law.median && law.median <= law.largest,
          "the cut-offs of a lognormal law must enclose its median: {} m, {} m, {} m", law.smallest,
          law.median, law.largest);
}

std::vector<double> draw_diameters(const DiameterLaw& law, int grains, std::uint64_t seed,
                                   std::uint32_t stream, std::uint64_t first) {
  std::vector<double> diameters;
  if (law.law == SizeLaw::list) {
    const std::vector<int> counts = counts_in_proportion(law.numbers, grains);
    for (std::size_t k = 0; k < counts.size(); ++k)
      diameters.insert(diameters.end(), counts[k], law.diameters[k]);
    return diameters;
  }
  const CutNormal z(law);
  for (int i = 0; i < grains; ++i) {
    const double u = random_uniform(seed, stream, first + i);
    const double d = law.law == SizeLaw::uniform ? law.smallest + (law.largest - law.smallest) * u
                                                 : law.median * std::exp(law.deviation * z.quantile(u));
    diameters.push_back(std::clamp(d, law.smallest, law.largest));
  }
  return diameters;
}

double mean_diameter(const DiameterLaw& law) { return moment(law, 1); }
double mean_square_diameter(const DiameterLaw& law) { return moment(law, 2); }
double mean_cube_diameter(const DiameterLaw& law) { return moment(law, 3); }

}  // namespace softgrain
