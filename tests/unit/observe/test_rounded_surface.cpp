#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/observe/rounded_surface.hpp"

using namespace softgrain;

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE("directions cover the sphere once, and their quads look outwards") {
  const DirectionGrid grid(6);
  CHECK(grid.direction.size() == 218);
  CHECK(grid.quad.size() == 216);
  double all = 0;
  Vec<3> sum;
  for (std::size_t k = 0; k < grid.direction.size(); ++k) {
    CHECK(std::abs(norm(grid.direction[k]) - 1) < 1e-15);
    all += grid.solid_angle[k];
    sum += grid.solid_angle[k] * grid.direction[k];
  }
  CHECK(std::abs(all / (4 * pi) - 1) < 1e-12);
  CHECK(norm(sum) < 1e-12);
  for (const auto& [a, b, c, d] : grid.quad) {
    const auto& e = grid.direction;
    CHECK(dot(e[a], cross(e[c] - e[a], e[d] - e[b])) > 0);
  }
}

TEST_CASE("a sphere has its own volume and area, whatever the probe and its place") {
  for (const double probe : {0.1, 3.0}) {
    const std::vector<Vec<3>> x{{1, -2, 0.5}};
    const std::vector<double> radius{0.7};
    const RoundedSurface surface = rounded_surface(x, radius, probe, DirectionGrid(5));
    CHECK(std::abs(surface.measure.volume / (4 * pi / 3 * 0.343) - 1) < 1e-12);
    CHECK(std::abs(surface.measure.area / (4 * pi * 0.49) - 1) < 1e-12);
    for (const int met : surface.sphere) CHECK(met == 0);
  }
}

TEST_CASE("two spheres that touch have the volume under a probe that comes down on them") {
  constexpr double R = 1, a = 1, probe = 0.6, c = R + probe;  // centres at -a and a
  const std::vector<Vec<3>> x{{-a, 0, 0}, {a, 0, 0}};
  const RoundedSurface surface = rounded_surface(x, std::vector<double>{R, R}, probe, DirectionGrid(40));
  double volume = 0;  // 2 pi/3 of the integral of r^3 over the cosine to the axis
  constexpr int n = 20000;
  for (int k = 0; k < n; ++k) {
    const double u = (k + 0.5) / n, r = a * u + std::sqrt(c * c - a * a * (1 - u * u)) - probe;
    volume += 2 * (2 * pi / 3) * r * r * r / n;
  }
  CHECK(std::abs(surface.measure.volume / volume - 1) < 1e-3);
  for (std::size_t k = 0; k < surface.vertex.size(); ++k)
    if (surface.vertex[k][0] > 1e-9) CHECK(surface.sphere[k] == 1);
}
