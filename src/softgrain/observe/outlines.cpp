#include "softgrain/observe/outlines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/geometry/polygon.hpp"

namespace softgrain {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// The angle's place in [0, 2 pi).
double wrapped(double angle) { return angle - two_pi * std::floor(angle / two_pi); }

/// A probe that touches disk `disk` in the direction `angle` from its centre.
struct Touch {
  int disk = 0;
  double angle = 0;
};

/// A regular polygon of the area of a disk.
std::vector<Vec<2>> circle_of_equal_area(const Vec<2>& centre, double radius) {
  constexpr int corners = 64;
  const double reach = radius * std::sqrt(two_pi / (corners * std::sin(two_pi / corners)));
  std::vector<Vec<2>> polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = two_pi * k / corners;
    polygon.push_back(centre + reach * Vec<2>{std::cos(angle), std::sin(angle)});
  }
  return polygon;
}

/// Disks that a probe rolls round.
class RollingProbe {
 public:
  RollingProbe(std::span<const Vec<2>> position, std::span<const double> radius, double probe)
      : x_(position),
        radius_(radius),
        probe_(probe),
        grid_(position, 2 * (*std::max_element(radius.begin(), radius.end()) + probe)) {}

  /// Below the disk that reaches lowest.
  Touch start() const {
    int lowest = 0;
    for (int i = 1; i < static_cast<int>(x_.size()); ++i)
      if (x_[i][1] - radius_[i] < x_[lowest][1] - radius_[lowest]) lowest = i;
    return {lowest, -std::numbers::pi / 2};
  }

  struct Stop {
    double turned = two_pi;  ///< how far the probe rolls on the disk until it meets the next [rad]
    Touch next;
  };

  /// From `at` counter-clockwise round its disk to the first other disk.
  Stop roll(const Touch& at) const {
    Stop first{two_pi, at};
    const double reach_i = radius_[at.disk] + probe_;
    grid_.for_each_neighbour(at.disk, [&](int j) {
      const Vec<2> d = x_[j] - x_[at.disk];
      const double r = norm(d), reach_j = radius_[j] + probe_;
      if (r >= reach_i + reach_j || r <= std::abs(reach_i - reach_j)) return;
      // the probe's centre where it touches both: the law of cosines at i, and at j
      const double towards = std::atan2(d[1], d[0]);
      const double at_i = std::acos((r * r + reach_i * reach_i - reach_j * reach_j) / (2 * r * reach_i));
      const double at_j = std::acos((r * r + reach_j * reach_j - reach_i * reach_i) / (2 * r * reach_j));
      const double turned = wrapped(towards - at_i - at.angle);
      if (turned < first.turned) first = {turned, {j, wrapped(towards + std::numbers::pi + at_j)}};
    });
    return first;
  }

  /// The arc of the disk that the probe touches while it turns, as points at most 22.5 degrees apart, both
  /// ends among them.
  void add_arc(const Touch& from, double turned, std::vector<Vec<2>>& outline) const {
    constexpr double longest = std::numbers::pi / 8;
    const int pieces = std::max(1, static_cast<int>(std::ceil(turned / longest)));
    const int points = turned < two_pi ? pieces + 1 : pieces;  // a whole circle ends where it begins
    for (int k = 0; k < points; ++k) {
      const double angle = from.angle + turned * k / pieces;
      outline.push_back(x_[from.disk] + radius_[from.disk] * Vec<2>{std::cos(angle), std::sin(angle)});
    }
  }

 private:
  std::span<const Vec<2>> x_;
  std::span<const double> radius_;
  double probe_;
  CellGrid<2> grid_;
};

}  // namespace

double total_area(std::span<const Vec<2>> outline, std::span<const int> begin) {
  double area = 0;
  for (std::size_t g = 0; g + 1 < begin.size(); ++g)
    area += polygon_area(outline.subspan(begin[g], begin[g + 1] - begin[g]));
  return area;
}

std::vector<Vec<2>> disk_outline(std::span<const Vec<2>> position, std::span<const double> radius,
                                 double probe) {
  std::vector<Vec<2>> outline;
  if (position.empty()) return outline;
  if (position.size() == 1) return circle_of_equal_area(position[0], radius[0]);
  const RollingProbe rolling(position, radius, probe);
  // the first whole arc begins where the probe first meets another disk
  const Touch start = rolling.roll(rolling.start()).next;
  Touch at = start;
  for (std::size_t arc = 0; arc < 4 * position.size(); ++arc) {
    const RollingProbe::Stop stop = rolling.roll(at);
    rolling.add_arc(at, stop.turned, outline);
    at = stop.next;
    if (at.disk == start.disk && std::abs(std::remainder(at.angle - start.angle, two_pi)) < 1e-9) break;
  }
  return outline;
}

}  // namespace softgrain
