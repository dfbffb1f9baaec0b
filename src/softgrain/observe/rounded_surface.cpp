#include "softgrain/observe/rounded_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace softgrain {
namespace {

/// Of the triangle of three unit vectors (van Oosterom and Strackee 1983).
double solid_angle_of(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  return 2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

double area_of(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) { return norm(cross(b - a, c - a)) / 2; }

/// Of the quads as two triangles each.
double area_of(const std::vector<std::array<int, 4>>& quads, const std::vector<Vec<3>>& x) {
  double area = 0;
  for (const auto& [a, b, c, d] : quads) area += area_of(x[a], x[b], x[c]) + area_of(x[a], x[c], x[d]);
  return area;
}

}  // namespace

/// Lines of the cube at equal angles: cells of nearly equal size.
DirectionGrid::DirectionGrid(int cells) {
  std::map<std::array<int, 3>, int> known;  // places on the cube, 0 .. cells
  const auto number_of = [&](const std::array<int, 3>& place) {
    const auto [found, is_new] = known.try_emplace(place, static_cast<int>(direction.size()));
    if (is_new) {
      Vec<3> x;
      for (int k = 0; k < 3; ++k)
        x[k] = std::tan(std::numbers::pi / 4 * (2.0 * place[static_cast<std::size_t>(k)] / cells - 1));
      direction.push_back((1 / norm(x)) * x);
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, cells})
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> place{};
            place[axis] = side;
            place[(axis + 1) % 3] = i + (side == 0 ? v : u);
            place[(axis + 2) % 3] = j + (side == 0 ? u : v);
            return number_of(place);
          };
          quad.push_back({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
        }
  solid_angle.assign(direction.size(), 0);
  for (const auto& [a, b, c, d] : quad) {
    const auto& e = direction;
    const double all = solid_angle_of(e[a], e[b], e[c]) + solid_angle_of(e[a], e[c], e[d]);
    for (const int corner : {a, b, c, d}) solid_angle[corner] += all / 4;
  }
  flat_area = area_of(quad, direction);
}

RoundedSurface rounded_surface(std::span<const Vec<3>> position, std::span<const double> radius, double probe,
                               const DirectionGrid& grid) {
  Vec<3> middle;
  double total = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double size = radius[i] * radius[i] * radius[i];
    middle += size * position[i];
    total += size;
  }
  middle *= 1 / total;
  const auto reach = [&](int i) { return norm(position[i] - middle) + radius[i] + probe; };
  std::vector<int> order(position.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> far(position.size());
  for (std::size_t i = 0; i < far.size(); ++i) far[i] = reach(static_cast<int>(i));
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return far[i] > far[j] || (far[i] == far[j] && i < j); });

  RoundedSurface surface;
  for (std::size_t k = 0; k < grid.direction.size(); ++k) {
    const Vec<3>& e = grid.direction[k];
    double highest = 0;  // of the centre of the probe
    int met = -1;
    for (const int i : order) {
      if (far[i] <= highest) break;  // nor do those that reach less far
      const Vec<3> x = position[i] - middle;
      const double along = dot(x, e), touch = radius[i] + probe;
      const double square = touch * touch - dot(x, x) + along * along;
      if (square < 0) continue;
      if (const double high = along + std::sqrt(square); high > highest) highest = high, met = i;
    }
    const double r = std::max(0.0, highest - probe);
    surface.vertex.push_back(middle + r * e);
    surface.sphere.push_back(met);
    surface.measure.volume += grid.solid_angle[k] * r * r * r / 3;
  }
  surface.measure.area = area_of(grid.quad, surface.vertex) * (4 * std::numbers::pi / grid.flat_area);
  return surface;
}

}  // namespace softgrain
