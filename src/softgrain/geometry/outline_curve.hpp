#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A point of a closed outline. At a corner the smooth curve ends on both sides.
struct OutlinePoint {
  Vec<2> x;
  bool corner = false;

  friend bool operator==(const OutlinePoint& a, const OutlinePoint& b) {
    return a.x.c == b.x.c && a.corner == b.corner;
  }
};

/// The closed outline through points, counter-clockwise, in their unit of length: cubic between two of them,
///   c(xi) = x_0 + xi (a + xi (b + xi d)),  xi in [0, 1],
/// with the slope of the parabola through three points at each of them (Catmull-Rom by chord length). Beside
/// a corner the curve is a parabola, between two corners straight: neither bulges round the corner.
class OutlineCurve {
 public:
  /// Points in either sense. Raises UsageError for fewer than three, for two neighbours in one place, and if
  /// the polygon of the points crosses or touches itself.
  explicit OutlineCurve(std::vector<OutlinePoint> points);

  double area() const { return area_; }
  const Vec<2>& centroid() const { return centroid_; }
  double moment() const { return moment_; }  ///< integral of |x - centroid|^2 over the body
  double reach() const { return reach_; }    ///< largest distance from the centroid
  int corners() const;

  /// `count` points on it, all corners among them; of equal distance along the curve between two corners.
  /// Raises UsageError for fewer than its corners, or than 8.
  std::vector<OutlinePoint> sample(int count) const;

 private:
  struct Span {
    Vec<2> start, a, b, d;
    Vec<2> place(double xi) const { return start + xi * (a + xi * (b + xi * d)); }
    Vec<2> slope(double xi) const { return a + xi * (2.0 * b + 3 * xi * d); }
  };
  std::vector<OutlinePoint> points_;
  std::vector<Span> spans_;  // from each point to the next
  double area_ = 0, moment_ = 0, reach_ = 0;
  Vec<2> centroid_;
};

/// The two edges of a polygon that meet first, by the numbers of the points where they start; {-1, -1}: none.
/// Neighbours do so where they run back on each other.
std::array<int, 2> crossing_edges(std::span<const OutlinePoint> points);

/// Corners are where the polygon of the points turns by more than this [rad], unless said otherwise: 30 deg.
inline constexpr double least_corner = 0.5235987755982988;
void find_corners(std::vector<OutlinePoint>& points);

/// A corner on the x axis, all at distance 1 from the origin.
std::vector<OutlinePoint> regular_polygon(int sides);

}  // namespace softgrain
