#include "softgrain/lattice/point_grain.hpp"

#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/lattice/shape_functions.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {
namespace {

/// Share of a square that lies in a circle about the origin, and the centre of that part.
struct PartOfCell {
  double share = 0;
  Vec<2> centre;
};

PartOfCell part_in_circle(const Vec<2>& corner, double side, double radius) {
  constexpr int samples = 32;  // in each direction
  PartOfCell part;
  for (int i = 0; i < samples; ++i)
    for (int j = 0; j < samples; ++j) {
      const Vec<2> x = corner + side / samples * Vec<2>{i + 0.5, j + 0.5};
      if (dot(x, x) > radius * radius) continue;
      part.share += 1;
      part.centre += x;
    }
  if (part.share > 0) part.centre *= 1 / part.share;
  part.share /= samples * samples;
  return part;
}

}  // namespace

double PointGrain::area() const {
  double sum = 0;
  for (const double V : volume) sum += V;
  return sum;
}

Vec<2> PointGrain::momentum(double density) const {
  Vec<2> sum;
  for (int p = 0; p < points(); ++p) sum += density * volume[p] * velocity[p];
  return sum;
}

double PointGrain::kinetic_energy(double density) const {
  double sum = 0;
  for (int p = 0; p < points(); ++p) sum += 0.5 * density * volume[p] * dot(velocity[p], velocity[p]);
  return sum;
}

PointGrain disk_of_points(double radius, const Vec<2>& centre, double cell, int vertices) {
  require(radius >= 2 * cell, "a grain of radius {} m is too small for cells of {} m", radius, cell);
  constexpr double least_share = 0.05;
  PointGrain grain;
  grain.radius = radius;
  const double side = point_side * cell;
  const auto first = [&](int d) { return static_cast<int>(std::floor((centre[d] - radius) / side)); };
  const auto last = [&](int d) { return static_cast<int>(std::ceil((centre[d] + radius) / side)); };
  for (int j = first(1); j < last(1); ++j)
    for (int i = first(0); i < last(0); ++i) {
      const PartOfCell part = part_in_circle(Vec<2>{i * side, j * side} - centre, side, radius);
      if (part.share < least_share) continue;
      grain.position.push_back(centre + part.centre);
      grain.volume.push_back(part.share * side * side);
    }
  const double scale = std::numbers::pi * radius * radius / grain.area();
  for (double& V : grain.volume) V *= scale;
  grain.velocity.resize(grain.position.size());
  grain.F.assign(grain.position.size(), identity<2>());

  const double sector = 2 * std::numbers::pi / vertices;
  const double reach = radius * std::sqrt(sector / std::sin(sector));
  for (int v = 0; v < vertices; ++v)
    grain.outline.push_back(centre + reach * Vec<2>{std::cos(v * sector), std::sin(v * sector)});
  return grain;
}

}  // namespace softgrain
