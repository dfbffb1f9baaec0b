#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "softgrain/experiment/sample.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double speed = 5;

/// The curve through the vertices of a grain's outline as a polygon of eight edges a span: between the middle
/// two of x_0 x_1 x_2 x_3, weights by Catmull and Rom, ((-xi + 2 xi^2 - xi^3)/2, ...).
std::vector<Vec<2>> curve_of(const SoftGrains& grains, std::span<const Vec<2>> x, int grain) {
  constexpr int edges = 8;
  const int begin = grains.outline_begin(grain), n = grains.outline_end(grain) - begin;
  std::vector<Vec<2>> curve;
  for (int v = 0; v < n; ++v)
    for (int k = 0; k < edges; ++k) {
      const double s = static_cast<double>(k) / edges, r = 1 - s;
      const auto vertex = [&](int of) { return x[begin + (v + of + n) % n]; };
      curve.push_back(0.5 * (-s * r * r * vertex(-1) + (2 - 5 * s * s + 3 * s * s * s) * vertex(0) +
                             (2 - 5 * r * r + 3 * r * r * r) * vertex(1) - r * s * s * vertex(2)));
    }
  return curve;
}

/// Depth of the deepest vertex of any outline in another one [m], by looking at all edges.
double deepest_vertex(const SoftGrains& grains, std::span<const Vec<2>> x) {
  double deepest = 0;
  for (int g = 0; g < grains.size(); ++g) {
    const std::vector<Vec<2>> curve = curve_of(grains, x, g);
    for (int v = 0; v < grains.outline_size(); ++v) {
      if (grains.grain_of_vertex(v) == g) continue;
      bool inside = false;  // by the edges that a ray to the right crosses
      double closest = std::numeric_limits<double>::infinity();
      for (std::size_t w = 0; w < curve.size(); ++w) {
        const Vec<2>&a = curve[w], &b = curve[(w + 1) % curve.size()];
        if ((a[1] > x[v][1]) != (b[1] > x[v][1]) &&
            x[v][0] < a[0] + (x[v][1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
          inside = !inside;
        const double share = std::clamp(dot(x[v] - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
        closest = std::min(closest, norm(x[v] - (a + share * (b - a))));
      }
      if (inside) deepest = std::max(deepest, closest);
    }
  }
  return deepest;
}

struct Compaction {
  double phi = 0, penetration = 0;             // at the end; the largest of the run, over the mean radius
  double phi_of_mark = 0, stress_of_mark = 0;  // at the strain of `mark`, stress over E averaged around it
  int rejected = 0;
  bool simple = true;
};

/// Twenty grains of the sample, the top wall at 5 m/s until the strain `last`.
template <class Dynamics, class Options>
Compaction compact(const Options& options, double dt, double last, double mark) {
  const BoxSample sample = sample_box({.grains = 20});
  const auto shape = test::disk(8);
  std::vector<GrainPlacement> placed;
  double area = 0, mean_radius = 0;
  for (const PlacedGrain& grain : sample.grains) {
    placed.push_back(test::placed(shape, grain.radius, grain.centre, {}, grain.angle));
    area += 3.141592653589793 * grain.radius * grain.radius;
    mean_radius += grain.radius / 20;
  }
  SoftGrains grains(std::move(placed), make_law(MaterialLaw::neo_hookean, 1e7, 0.45), 990);
  Dynamics dynamics(std::move(grains), test::box_walls(sample.width, speed), options);
  Compaction result;
  std::vector<Vec<2>> x;
  double impulse = 0, duration = 0;
  const auto phi = [&] {
    dynamics.grains.gather_outline(x);
    double now = 0;
    for (int g = 0; g < dynamics.grains.size(); ++g)
      now +=
          polygon_area(std::span(x).subspan(dynamics.grains.outline_begin(g), shape->grid.outline_nodes()));
    return now / (sample.width * dynamics.box.walls[1].point[1]);
  };
  const int steps = static_cast<int>(sample.width * (1 - std::exp(-last)) / (speed * dt));
  for (int k = 1; k <= steps; ++k) {
    const SoftStepReport report = dynamics.step(dt);
    result.rejected += report.rejected;
    const double strain = std::log(sample.width / dynamics.box.walls[1].point[1]);
    if (std::abs(strain - mark) < 0.02) {
      impulse += dynamics.wall_impulse(1)[1] - dynamics.wall_impulse(0)[1];
      duration += dt;
      if (strain < mark) result.phi_of_mark = phi();
    }
    if (k % std::max(1, steps / 25) == 0 || k == steps) {
      dynamics.grains.gather_outline(x);
      result.penetration = std::max(result.penetration, deepest_vertex(dynamics.grains, x) / mean_radius);
    }
  }
  result.phi = phi();
  result.stress_of_mark = impulse / 2 / duration / sample.width / 1e7;
  for (int g = 0; g < dynamics.grains.size(); ++g)
    result.simple = result.simple && is_simple_polygon(std::span(x).subspan(dynamics.grains.outline_begin(g),
                                                                            shape->grid.outline_nodes()));
  return result;
}

void check_outlines(const Compaction& c) {
  CHECK(c.phi > 0.97);
  CHECK(c.penetration < 1e-3);
  CHECK(c.simple);
}

}  // namespace

TEST_CASE("twenty soft grains are compacted to 98 % without crossing, alike by both integrators") {
  constexpr double last = 0.422, mark = 0.362;  // phi = 0.98 and 0.95
  const Compaction implicit = compact<ImplicitDynamics>(ImplicitOptions{}, 5e-6, last, mark);
  check_outlines(implicit);
  CHECK(implicit.rejected <= 3);
  const Compaction explicit_ =
      compact<ExplicitDynamics>(ExplicitOptions{.damping_share = 0.5}, 1.2e-7, last, mark);
  check_outlines(explicit_);
  CHECK(std::abs(implicit.phi_of_mark - explicit_.phi_of_mark) < 0.005);
  CHECK(implicit.stress_of_mark == doctest::Approx(explicit_.stress_of_mark).epsilon(0.1));
}

TEST_CASE("a box of grains is compacted at 1 mm/s with every step converged, at forces that balance") {
  const BoxSample sample = sample_box({.grains = 20});
  std::vector<GrainPlacement> placed;
  for (const PlacedGrain& grain : sample.grains)
    placed.push_back(test::placed(test::disk(4), grain.radius, grain.centre, {}, grain.angle));
  SoftGrains grains(std::move(placed), make_law(MaterialLaw::neo_hookean, 1e7, 0.45), 990);
  ImplicitDynamics dynamics(std::move(grains), test::box_walls(sample.width, 1e-3), {});
  const double dt = 0.01 * 0.7e-3 / 1e-3;
  int steps = 0;
  double largest = 0;
  for (; std::log(sample.width / dynamics.box.walls[1].point[1]) < 0.15; ++steps) {
    const SoftStepReport report = dynamics.step(dt);
    REQUIRE(report.converged);
    REQUIRE(report.residual < 1e-4);
    REQUIRE(report.overlap_max < 1.5e-3);
    const double top = dynamics.wall_impulse(1)[1] / dt, bottom = -dynamics.wall_impulse(0)[1] / dt;
    REQUIRE(std::abs(top - bottom) < 0.01 * top + 1e-5 * 1e7 * sample.width);
    largest = std::max(largest, top);
  }
  CHECK(largest > 5e-3 * 1e7 * sample.width);  // grains are pressed
  const WorkBudget& work = dynamics.work;      // kinetic energy is nothing
  CHECK(work.walls == doctest::Approx(work.internal + work.contacts + work.inertia).epsilon(0.02));
}
