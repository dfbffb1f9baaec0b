#include "softgrain/experiment/adhesion_of_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"

namespace softgrain {
namespace {

constexpr double rigid = std::numeric_limits<double>::infinity();

/// Segments that the cohesive zone spans by default.
constexpr double default_zone = 3;

/// Range of rigid surfaces among themselves, in segments.
constexpr double rigid_range = 0.25;

/// What adhesion asks of a kind.
struct AdhesiveKind {
  double stiffness = rigid;  ///< E/(1 - nu^2) [Pa], plane strain
  double segment = 0;        ///< of the outline of its largest grain; bonded: a primary [m]
  double radius = 0;         ///< of its smallest grain [m]
};

AdhesiveKind adhesive_kind(const Case& c) {
  double least = c.grain.radius, largest = c.grain.radius;
  if (is_in_a_box(c) && c.sample.placed.empty()) {
    const DiameterLaw law = diameter_law(c.sample);
    least = law.least() / 2, largest = law.greatest() / 2;
  } else if (is_in_a_box(c)) {
    least = c.sample.smallest_diameter / 2, largest = c.sample.largest_diameter / 2;
  }
  if (is_bonded(c)) return {.segment = mean_touching_distance(c), .radius = least};
  AdhesiveKind kind{.segment = 2 * std::numbers::pi * largest / (4 * c.mpm.cells), .radius = least};
  const MaterialParameters& m = c.mpm.material;
  if (is_elastic(c)) kind.stiffness = m.young_modulus / (1 - m.poisson_ratio * m.poisson_ratio);
  return kind;
}

/// E* [Pa] of two surfaces: 1/E* = 1/E_1* + 1/E_2*.
double combined(double stiffness, double other) {
  return std::isinf(stiffness) ? other
         : std::isinf(other)   ? stiffness
                               : stiffness * other / (stiffness + other);
}

/// The pair (kind, other) that a table names, or null.
const Case::Pair* named(const Case& c, int kind, int other) {
  const auto found = std::find_if(c.pairs.begin(), c.pairs.end(), [&](const Case::Pair& pair) {
    return (pair.kind == kind && pair.other == other) || (pair.kind == other && pair.other == kind);
  });
  return found == c.pairs.end() ? nullptr : &*found;
}

/// visit(pair with its surface energy and range, E* [Pa], segment [m], least radius [m]) of all that adhere.
template <class Visit>
void for_each_adhesion(const Case& c, const Visit& visit) {
  std::vector<AdhesiveKind> kinds;
  for (int k = 0; k < kinds_of(c); ++k) kinds.push_back(adhesive_kind(case_of_kind(c, k)));
  const int count = static_cast<int>(kinds.size());
  for (int k = 0; k < count; ++k)
    for (int other = Case::Pair::wall; other <= k; ++other) {
      const bool at_wall = other == Case::Pair::wall;
      if (!at_wall && !is_in_a_box(c)) continue;  // one grain
      double w = at_wall ? c.contact.wall_surface_energy : c.contact.surface_energy;
      double range = c.contact.adhesion_range;
      if (const Case::Pair* pair = named(c, k, other)) {
        w = pair->surface_energy.value_or(w);
        range = pair->adhesion_range.value_or(range);
      }
      if (w == 0) continue;
      const AdhesiveKind &of_kind = kinds[k], of_other = at_wall ? AdhesiveKind{} : kinds[other];
      const double stiffness = combined(of_kind.stiffness, of_other.stiffness);
      const double segment = std::max(of_kind.segment, of_other.segment);
      if (range == 0)
        range = std::isinf(stiffness)
                    ? rigid_range * segment
                    : 4 * std::sqrt(default_zone * segment * w / (std::numbers::pi * stiffness));
      const double radius = at_wall ? of_kind.radius : std::min(of_kind.radius, of_other.radius);
      visit(PairAdhesion{k, at_wall ? PairAdhesion::wall : other, {w, range}}, stiffness, segment, radius);
    }
}

}  // namespace

std::vector<PairAdhesion> adhesion_of(const Case& c) {
  std::vector<PairAdhesion> pairs;
  for_each_adhesion(c, [&](const PairAdhesion& pair, double, double, double) { pairs.push_back(pair); });
  return pairs;
}

AdhesionAdvice advise_on_adhesion(const Case& c) {
  constexpr double none = std::numeric_limits<double>::infinity();
  AdhesionAdvice advice{.zone = none, .reach = none};
  for_each_adhesion(c, [&](const PairAdhesion& pair, double stiffness, double segment, double radius) {
    const double strength = pair.law.strength();
    const double zone = std::numbers::pi / 4 * stiffness * pair.law.surface_energy / (strength * strength);
    advice.zone = std::min(advice.zone, zone / segment);
    advice.reach = std::min(advice.reach, radius / pair.law.range);
  });
  return advice;
}

}  // namespace softgrain
