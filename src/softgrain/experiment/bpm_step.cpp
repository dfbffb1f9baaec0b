#include "softgrain/experiment/bpm_step.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/adhesion_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"

namespace softgrain {
namespace {

/// Share of a grain's outline that its primaries fill, and of its volume.
constexpr double filled = 0.8, filled_in_space = 0.65;

/// Of the step, for the paper's grain [s].
constexpr double paper_step = 0.25e-6;

/// A wall moves at most this share of the radius of the smallest primary in a step.
constexpr double wall_share = 0.01;

bool between_walls(const Case& c) { return c.experiment.loading == LoadingPath::diametral; }

/// Radius and mass of the smallest primary of the smallest grain.
struct SmallestPrimary {
  double radius, mass;  // [m], [kg/m], in space [kg]

  explicit SmallestPrimary(const Case& c) {
    const double R = between_walls(c) ? c.grain.radius : c.sample.smallest_diameter / 2;
    // diameters uniform from d to s d: <d^2>/d^2, <d^3>/d^3
    const double s = c.bpm.size_ratio, mean_square = (1 + s + s * s) / 3,
                 mean_cube = (1 + s) * (1 + s * s) / 4;
    if (is_in_space(c)) {
      const double share = 1 / (c.bpm.primaries * mean_cube);  // of all primaries' volume
      radius = R * std::cbrt(filled_in_space * share);
      mass = c.grain.density * 4 * std::numbers::pi / 3 * R * R * R * share;
    } else {
      const double share = 1 / (c.bpm.primaries * mean_square);  // of all primaries' area
      radius = R * std::sqrt(filled * share);
      mass = c.grain.density * std::numbers::pi * R * R * share;
    }
  }
};

/// F0 [N/m], in space [N], of grains whose primaries touch at <a0> [m] in the mean.
double attraction_of(const Case& c, double a0) {
  if (between_walls(c)) return is_in_space(c) ? c.bpm.force : c.bpm.attraction;
  return is_in_space(c) ? attraction_with<3>(c.bpm.cohesive_pressure, a0)
                        : attraction_with<2>(c.bpm.cohesive_pressure, a0);
}

/// Of surfaces that attract each other [s].
double period_of_adhesion(const Case& c, const SmallestPrimary& smallest) {
  const double l = 2 * smallest.radius, face = is_in_space(c) ? l * l : l;
  double period = std::numeric_limits<double>::infinity();
  for (const PairAdhesion& pair : adhesion_of(c)) {
    const double stiffness = face * pair.law.strength() / pair.law.range;
    const double mass = pair.other == PairAdhesion::wall ? smallest.mass : smallest.mass / 2;
    period = std::min(period, 2 * std::numbers::pi * std::sqrt(mass / stiffness));
  }
  return period;
}

}  // namespace

double mean_touching_distance(const Case& c) { return SmallestPrimary(c).radius * (1 + c.bpm.size_ratio); }

double bond_period(const Case& c) {
  return least_of_kinds(with_bonded_kinds(c), [&](const Case& kind) {
    const SmallestPrimary smallest(kind);
    const double F0 = attraction_of(kind, mean_touching_distance(kind));
    const double a0 = 2 * smallest.radius;
    const double period = 2 * std::numbers::pi * std::sqrt(smallest.mass * a0 / (2 * kind.bpm.exponent * F0));
    return std::min(period, period_of_adhesion(c, smallest));
  });
}

double critical_bond_step(const Case& c) { return bond_period(c) / std::numbers::pi; }

double stable_bond_step(const Case& c) {
  const double by_bonds = paper_step * (bond_period(c) / bond_period(Case{}));
  const double radius =
      least_of_kinds(with_bonded_kinds(c), [](const Case& kind) { return SmallestPrimary(kind).radius; });
  return std::min(by_bonds, wall_share * radius / c.loading.wall_velocity);
}

double bonded_time_step(const Case& c) {
  const double step = c.time.step > 0 ? c.time.step : stable_bond_step(c);
  require(std::isfinite(step) && step > 0,
          "no time step: bpm.{} {}, bpm.cohesive_pressure {} Pa, bpm.exponent {} and all lengths and "
          "densities must be > 0",
          is_in_space(c) ? "force" : "attraction",
          is_in_space(c) ? fmt::format("{} N", c.bpm.force) : fmt::format("{} N/m", c.bpm.attraction),
          c.bpm.cohesive_pressure, c.bpm.exponent);
  return step;
}

double checked_bonded_time_step(const Case& c) {
  const std::string too_long = bond_step_too_long(c);
  require(too_long.empty(), "{}", too_long);
  return bonded_time_step(c);
}

std::string bond_step_too_long(const Case& c) {
  const double critical = critical_bond_step(c);
  if (c.experiment.model != GrainModel::bpm || !(c.time.step > critical)) return "";
  return fmt::format(
      "time.step {:.3g} s is longer than the critical step of the bonds, {:.3g} s; use a smaller time.step, "
      "or \"auto\" for "
      "the stable one, {:.3g} s",
      c.time.step, critical, stable_bond_step(c));
}

}  // namespace softgrain
