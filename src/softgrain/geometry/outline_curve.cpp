#include "softgrain/geometry/outline_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"

namespace softgrain {
namespace {

double cross_z(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

std::vector<Vec<2>> places_of(std::span<const OutlinePoint> points) {
  std::vector<Vec<2>> places;
  for (const OutlinePoint& point : points) places.push_back(point.x);
  return places;
}

/// Gauss' places and weights in [0, 1], exact up to degree 11.
constexpr std::array<std::array<double, 2>, 6> gauss{{{0.03376524289842397, 0.08566224618958517},
                                                      {0.16939530676686776, 0.18038078652406930},
                                                      {0.38069040695840156, 0.23395696728634552},
                                                      {0.61930959304159849, 0.23395696728634552},
                                                      {0.83060469323313224, 0.18038078652406930},
                                                      {0.96623475710157603, 0.08566224618958517}}};

/// Pieces of a span along which its length is measured.
constexpr int pieces_of_span = 64;

}  // namespace

OutlineCurve::OutlineCurve(std::vector<OutlinePoint> points) : points_(std::move(points)) {
  require(points_.size() >= 3, "an outline needs at least 3 points, got {}", points_.size());
  const std::array<int, 2> crossing = crossing_edges(points_);
  require(crossing[0] < 0, "the outline crosses or touches itself: its edges from the points {} and {}",
          crossing[0] + 1, crossing[1] + 1);
  if (polygon_area(places_of(points_)) < 0) std::reverse(points_.begin(), points_.end());
  const std::size_t n = points_.size();
  const auto at = [&](std::size_t k) -> const OutlinePoint& { return points_[k % n]; };
  // the slope at a smooth point, by the length of the chord: of the parabola through it and its neighbours
  const auto slope_at = [&](std::size_t k) {
    const Vec<2> before = at(k).x - at(k + n - 1).x, after = at(k + 1).x - at(k).x;
    const double h = norm(before), l = norm(after);
    return (1 / (h + l)) * ((l / h) * before + (h / l) * after);
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Vec<2> chord = at(k + 1).x - at(k).x;
    const double l = norm(chord);
    Vec<2> begin = chord, end = chord;  // dc/dxi
    if (!at(k).corner) begin = l * slope_at(k);
    if (!at(k + 1).corner) end = l * slope_at(k + 1);
    if (at(k).corner && !at(k + 1).corner) begin = 2.0 * chord - end;
    if (at(k + 1).corner && !at(k).corner) end = 2.0 * chord - begin;
    spans_.push_back({at(k).x, begin, 3.0 * chord - 2.0 * begin - end, -2.0 * chord + begin + end});
  }
  // of f homogeneous of degree k: integral f dA = 1/(k + 2) closed integral f x x dx
  Vec<2> first;
  double second = 0;
  const Vec<2> origin = points_.front().x;
  for (const Span& span : spans_)
    for (const auto& [xi, weight] : gauss) {
      const Vec<2> x = span.place(xi) - origin;
      const double turn = weight * cross_z(x, span.slope(xi));
      area_ += turn / 2;
      first += (turn / 3) * x;
      second += turn / 4 * dot(x, x);
    }
  centroid_ = (1 / area_) * first;
  moment_ = second - area_ * dot(centroid_, centroid_);
  centroid_ += origin;
  for (const Span& span : spans_)
    for (int piece = 0; piece < pieces_of_span; ++piece)
      reach_ = std::max(reach_, norm(span.place(static_cast<double>(piece) / pieces_of_span) - centroid_));
}

int OutlineCurve::corners() const {
  return static_cast<int>(
      std::count_if(points_.begin(), points_.end(), [](const OutlinePoint& p) { return p.corner; }));
}

std::vector<OutlinePoint> OutlineCurve::sample(int count) const {
  const int n = static_cast<int>(points_.size());
  require(count >= std::max(8, corners()), "an outline of {} corners needs at least {} vertices, got {}",
          corners(), std::max(8, corners()), count);
  // the curve from corner to corner, or once round: its pieces, and the way along it to the end of each
  struct Side {
    int first = 0;
    std::vector<double> way{0};
    int parts = 1;
    double length() const { return way.back(); }
  };
  const int begin = static_cast<int>(
      std::find_if(points_.begin(), points_.end(), [](const OutlinePoint& p) { return p.corner; }) -
      points_.begin());
  std::vector<Side> sides;
  for (int k = 0; k < n; ++k) {
    const int at = (begin + k) % n;
    if (k == 0 || points_[at].corner) sides.push_back({.first = at});
    Side& side = sides.back();
    for (int piece = 0; piece < pieces_of_span; ++piece)
      side.way.push_back(side.way.back() +
                         norm(spans_[at].place(static_cast<double>(piece + 1) / pieces_of_span) -
                              spans_[at].place(static_cast<double>(piece) / pieces_of_span)));
  }
  for (int extra = static_cast<int>(sides.size()); extra < count; ++extra)
    ++std::max_element(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.length() / a.parts < b.length() / b.parts;
      })->parts;
  std::vector<OutlinePoint> sampled;
  for (const Side& side : sides) {
    sampled.push_back(points_[side.first]);
    for (int part = 1; part < side.parts; ++part) {
      const double way = side.length() * part / side.parts;
      const auto above = std::upper_bound(side.way.begin(), side.way.end(), way);
      const int piece = static_cast<int>(above - side.way.begin()) - 1;
      const double share = (way - side.way[piece]) / (side.way[piece + 1] - side.way[piece]);
      const Span& span = spans_[(side.first + piece / pieces_of_span) % n];
      sampled.push_back({span.place((piece % pieces_of_span + share) / pieces_of_span), false});
    }
  }
  return sampled;
}

std::array<int, 2> crossing_edges(std::span<const OutlinePoint> points) {
  const std::vector<Vec<2>> places = places_of(points);
  const int n = static_cast<int>(places.size());
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      if (edges_meet(places, i, j)) return {i, j};
  return {-1, -1};
}

void find_corners(std::vector<OutlinePoint>& points) {
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec<2> before = points[k].x - points[(k + n - 1) % n].x,
                 after = points[(k + 1) % n].x - points[k].x;
    points[k].corner = std::abs(std::atan2(cross_z(before, after), dot(before, after))) > least_corner;
  }
}

std::vector<OutlinePoint> regular_polygon(int sides) {
  require(sides >= 3, "a polygon needs at least 3 sides, got {}", sides);
  std::vector<OutlinePoint> points;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    points.push_back({{std::cos(angle), std::sin(angle)}, true});
  }
  return points;
}

}  // namespace softgrain
