#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/rigid_motion.hpp"
#include "softgrain/soft/rigid_outline.hpp"
#include "softgrain/soft/soft_outline.hpp"
#include "softgrain/soft/span_curve.hpp"
#include "softgrain/soft/stable_step.hpp"
#include "support/outlines.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, rho = 1000, E = 1e7, pi = std::numbers::pi;

std::shared_ptr<const Topology> shape_of(Topology shape) {
  return std::make_shared<const Topology>(std::move(shape));
}

SoftGrains made_of(std::vector<GrainPlacement> placed, MaterialLaw law = MaterialLaw::neo_hookean,
                   double nu = 0.3) {
  return {std::move(placed), make_law(law, E, nu), rho};
}

/// Mass, and sum m X_i X_j of the nodes, over rho.
struct Whole {
  double area = 0;
  Mat<2> moment;
};
Whole whole(const Topology& shape) {
  Whole all;
  for (int i = 0; i < shape.grid.nodes(); ++i) {
    all.area += shape.node_volume[i];
    const Vec<2>& X = shape.grid.node[i];
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l) all.moment(k, l) += shape.node_volume[i] * X[k] * X[l];
  }
  return all;
}

/// A square with sides along the axes, of a circle of radius R about it.
constexpr double half_side = R / std::numbers::sqrt2;
GrainPlacement square_at(const std::shared_ptr<const Topology>& shape, const Vec<2>& centre) {
  return test::placed(shape, R, centre, {}, pi / 4);
}

double least_gap(const SoftGrains& grains) {
  double least = 1;
  for (const OutlineContact& contact : OutlineNeighbours().detect(grains, test::state_of(grains)))
    least = std::min(least, contact.gap);
  return least;
}

double angular_momentum(const SoftGrains& grains) {
  double sum = 0;
  for (const GrainBatch& batch : grains.batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
        const Vec<2> x = test::lane_of(batch.position[i], lane), v = test::lane_of(batch.velocity[i], lane);
        sum += grains.node_mass(batch, i)[lane] * (x[0] * v[1] - x[1] * v[0]);
      }
  return sum;
}

}  // namespace

TEST_CASE(
    "soft ellipses and polygons weigh what their bodies do; their lumped moments near those of the body") {
  for (const double aspect : {1.5, 3.0, 6.0}) {
    double before = 0;
    for (const int cells : {8, 16}) {
      const Whole ellipse = whole(soft_ellipse(aspect, cells));
      const double b = 1 / aspect, area = pi * b;
      CHECK(std::abs(ellipse.area / area - 1) < 1e-12);
      const double xx = ellipse.moment(0, 0) / (area / 4) - 1,
                   yy = ellipse.moment(1, 1) / (area * b * b / 4) - 1;
      CHECK(std::abs(xx - yy) < 1e-12);  // the disk's, made narrow
      CHECK(std::abs(xx) < 0.5 / (cells * cells));
      if (before > 0) CHECK(before / xx > 3.5);  // second order in the width of cells
      before = xx;
    }
  }
  for (const int sides : {3, 4, 5, 7})
    for (const int cells : {8, 16}) {
      CAPTURE(sides);
      const Whole polygon = whole(soft_polygon(sides, cells));
      const double area = sides / 2.0 * std::sin(2 * pi / sides), sine = std::sin(pi / sides);
      CHECK(std::abs(polygon.area / area - 1) < 1e-12);
      const double inertia = trace(polygon.moment) / (area / 2 * (1 - sine * sine * 2 / 3));
      MESSAGE("polygon ", sides, " cells ", cells, ": I/I_exact - 1 = ", inertia - 1);
      CHECK(std::abs(inertia - 1) < 2.0 / (cells * cells));
    }
}

TEST_CASE(
    "corners of soft grains are sharp and their sides straight; a curve round a corner bulges .074 cell") {
  const auto shape = shape_of(soft_polygon(4, 8));
  for (const double beside : {0.0, 0.3, 0.8}) {  // side faces side, also shifted
    const SoftGrains pair =
        made_of({square_at(shape, {0, 0}), square_at(shape, {2 * half_side + 0.02 * R, beside * half_side})});
    CHECK(std::abs(least_gap(pair) / (0.02 * R) - 1) < 1e-9);
  }
  // corner faces corner; a corner over the middle of a side
  CHECK(
      std::abs(least_gap(made_of({square_at(shape, {0, 0}),
                                  square_at(shape, {2 * half_side + 0.03 * R, 2 * half_side + 0.01 * R})})) /
                   (std::hypot(0.03, 0.01) * R) -
               1) < 1e-9);
  CHECK(std::abs(least_gap(made_of(
                     {square_at(shape, {0, 0}), test::placed(shape, R, {0.1 * R, half_side + 1.01 * R})})) /
                     (0.01 * R) -
                 1) < 1e-9);
  // the furthest that the curve of each lies outside its square
  const auto bulge = [&](const Topology& topology) {
    double most = 0;
    const std::span<const Vec<2>> X = topology.grid.outline();
    const int n = static_cast<int>(X.size());
    const std::vector<char>& corner = topology.corner;
    for (int v = 0; v < n; ++v) {
      const int next = (v + 1) % n;
      const bool sharp = !corner.empty();
      const SpanCurve curve(X, {sharp && corner[v] != 0 ? v : (v + n - 1) % n, v, next,
                                sharp && corner[next] != 0 ? next : (v + 2) % n});
      for (int k = 0; k <= 32; ++k) {
        const Vec<2> x = curve.place(k / 32.0);
        for (int side = 0; side < 4; ++side) {
          const double angle = (side + 0.5) * pi / 2;
          most = std::max(most, dot(x, Vec<2>{std::cos(angle), std::sin(angle)}) - 1 / std::numbers::sqrt2);
        }
      }
    }
    return most / (std::numbers::sqrt2 / 8);  // in segments
  };
  CHECK(bulge(*shape) < 1e-14);
  CHECK(std::abs(bulge(Topology(shape->grid)) - 2.0 / 27) < 1e-3);
}

TEST_CASE("a soft ellipse is as far from walls as its support function says, however it lies") {
  for (const double aspect : {2.0, 5.0})
    for (const int cells : {8, 16}) {
      const Topology shape = soft_ellipse(aspect, cells);
      double worst = 0;
      for (int k = 0; k < 40; ++k) {
        const double angle = 2 * pi * k / 40 + 0.01;
        const double exact = std::hypot(std::cos(angle), std::sin(angle) / aspect);
        worst = std::max(worst, std::abs(reach_of(shape, {std::cos(angle), std::sin(angle)}) - exact));
      }
      MESSAGE("support of an ellipse: aspect ", aspect, " cells ", cells, " error/R ", worst);
      CHECK(worst < 0.045 * aspect * aspect / (cells * cells * cells));
    }
}

TEST_CASE_TEMPLATE("an elastic square between walls without friction is a block: sigma = E/(1 - nu^2) eps",
                   Dynamics, ImplicitDynamics, ExplicitDynamics) {
  constexpr bool implicit = std::is_same_v<Dynamics, ImplicitDynamics>;
  constexpr double nu = 0.3, strain = 1e-3;
  // wall speeds so small that inertia is nothing
  const double speed = 2e-3;
  std::conditional_t<implicit, ImplicitOptions, ExplicitOptions> options;
  if constexpr (implicit)
    options.tolerance = 1e-8;
  else
    options.damping = 5e4;
  Dynamics dynamics(
      made_of({square_at(shape_of(soft_polygon(4, 6)), {0, 0})}, MaterialLaw::small_strain_hooke, nu),
      std::vector<Wall<2>>{test::floor_at(-half_side),
                           {.point = {0, half_side}, .normal = {0, -1}, .velocity = {0, -speed}}},
      options);
  const double way = strain * 2 * half_side;
  const double step = implicit ? way / speed / 14 : stable_time_step(dynamics.grains);
  const int steps = static_cast<int>(std::lround(way / speed / step));
  double force = 0;
  int rows = 0;
  for (int k = 0; k < steps; ++k) {
    dynamics.step(step);
    if (k < steps - steps / 10 - 1) continue;
    const double now = (k + 1) * step * speed / (2 * half_side);
    force += (dynamics.wall_impulse(1)[1] - dynamics.wall_impulse(0)[1]) / 2 / step / now * strain;
    ++rows;
  }
  const double exact = E / (1 - nu * nu) * strain * 2 * half_side;
  MESSAGE("square between walls: F/F_exact - 1 = ", force / rows / exact - 1);
  CHECK(std::abs(force / rows / exact - 1) < (implicit ? 1e-5 : 2e-3));
}

TEST_CASE_TEMPLATE("a soft ellipse that spins freely keeps its angular momentum", Dynamics, ImplicitDynamics,
                   ExplicitDynamics) {
  constexpr bool implicit = std::is_same_v<Dynamics, ImplicitDynamics>;
  std::conditional_t<implicit, ImplicitOptions, ExplicitOptions> options;
  if constexpr (implicit) options.tolerance = 1e-9;
  Dynamics dynamics(made_of({test::placed(shape_of(soft_ellipse(2, 6)), R, {0, 0})}), std::vector<Wall<2>>{},
                    options);
  constexpr double spin = 1000;  // 1/s
  for (Vec<2, Wide>& x : dynamics.grains.batches[0].position) {
    const auto i = &x - dynamics.grains.batches[0].position.data();
    dynamics.grains.batches[0].velocity[i] = {-spin * x[1], spin * x[0]};
  }
  const double start = angular_momentum(dynamics.grains);
  const double dt = implicit ? 2e-5 : stable_time_step(dynamics.grains);
  const int steps = static_cast<int>(2 * pi / spin / dt);
  for (int k = 0; k < steps; ++k) dynamics.step(dt);
  MESSAGE("spinning ellipse: L/L_0 - 1 = ", angular_momentum(dynamics.grains) / start - 1);
  CHECK(std::abs(angular_momentum(dynamics.grains) / start - 1) < (implicit ? 1e-2 : 1e-9));
  CHECK(norm(dynamics.grains.momentum()) < 1e-9 * start / R);
}

TEST_CASE("an ellipse pressed by walls has Hertz' contact with its radius of curvature there") {
  constexpr double nu = 0.3, speed = 0.05;
  for (const double aspect : {1.0, 2.0}) {
    const auto shape = shape_of(soft_ellipse(aspect, 32));
    const double reach = R / aspect;
    ImplicitDynamics dynamics(
        made_of({test::placed(shape, R, {0, 0})}, MaterialLaw::small_strain_hooke, nu),
        std::vector<Wall<2>>{test::floor_at(-reach),
                             {.point = {0, reach}, .normal = {0, -1}, .velocity = {0, -speed}}},
        {});
    const double dt = 2e-3 * R / speed, curvature = R * aspect;  // a^2/b
    for (int k = 0; k < 8; ++k) dynamics.step(dt);
    double force = 0, second = 0;
    std::vector<Vec<2>> x;
    dynamics.grains.gather_outline(x);
    for (std::size_t c = 0; c < dynamics.contacts.size(); ++c) {
      const OutlineContact& contact = dynamics.contacts[c];
      if (contact.wall != 0) continue;
      const double f = dynamics.impulse[c][0] / dt;
      double place = 0;
      contact.for_each_vertex([&](int vertex, double weight) { place += weight * x[vertex][0]; });
      force += f, second += f * place * place;
    }
    const double width = 2 * std::sqrt(second / force);  // of an ellipse of pressure: <x^2> = a^2/4
    const double hertz = std::sqrt(4 * force * curvature * (1 - nu * nu) / (pi * E));
    MESSAGE("ellipse between walls: aspect ", aspect, " a/R = ", width / R, " over Hertz ", width / hertz);
    CHECK(std::abs(width / hertz - 1) < 0.05);
  }
}

TEST_CASE("rigid outlines weigh and turn as their bodies do, and a square made of points is the polygon") {
  const Topology drawn = rigid_outline(OutlineCurve(regular_polygon(4)), 32), regular = rigid_polygon(4, 32);
  CHECK(std::abs(drawn.area / regular.area - 1) < 1e-12);
  CHECK(drawn.corner == regular.corner);
  double inertia = 0, expected = 0;
  for (int i = 0; i < drawn.grid.nodes(); ++i) {
    inertia += drawn.node_volume[i] * dot(drawn.grid.node[i], drawn.grid.node[i]);
    expected += regular.node_volume[i] * dot(regular.grid.node[i], regular.grid.node[i]);
  }
  CHECK(std::abs(inertia / expected - 1) < 1e-12);
  CHECK(std::abs(inertia / (regular.area / 3) - 1) < 1e-12);  // side^4/6, side^2 = 2
}

TEST_CASE(
    "the nodes of a rigid outline have the mass, the centre and the moment of the body, however uneven it "
    "is") {
  std::vector<OutlinePoint> drop{{{std::numbers::sqrt2, 0}, true}};
  for (int k = 0; k <= 24; ++k) {
    const double angle = pi / 4 + 1.5 * pi * k / 24;
    drop.push_back({{std::cos(angle), std::sin(angle)}, false});
  }
  const OutlineCurve curve(drop);
  const Topology shape = rigid_outline(curve, 20);
  const double unit = 1 / curve.reach();
  Vec<2> first;
  double area = 0, moment = 0;
  for (int i = 0; i < shape.grid.nodes(); ++i) {
    CHECK(shape.node_volume[i] > 0);
    area += shape.node_volume[i];
    first += shape.node_volume[i] * shape.grid.node[i];
    moment += shape.node_volume[i] * dot(shape.grid.node[i], shape.grid.node[i]);
  }
  CHECK(std::abs(area / (curve.area() * unit * unit) - 1) < 1e-12);
  CHECK(norm(first) < 1e-14);
  CHECK(std::abs(moment / (curve.moment() * std::pow(unit, 4)) - 1) < 1e-12);
  CHECK(std::abs(curve.area() / (0.75 * pi + 1) - 1) <
        0.01);  // the drop's, of a straight side and three points
}

TEST_CASE("outlines that no grid fits are refused at the place where cells fold") {
  const double w = 0.05;  // a thin L
  std::vector<OutlinePoint> thin;
  for (const Vec<2>& x : std::initializer_list<Vec<2>>{{0, 0}, {1, 0}, {1, w}, {w, w}, {w, 1}, {0, 1}})
    thin.push_back({x, true});
  try {
    soft_outline(OutlineCurve(thin), 8);
    FAIL("a thin L was taken");
  } catch (const OutlineFolds& fold) {
    CHECK(norm(fold.place - Vec<2>{w, w}) < 0.4);
  }
  CHECK_NOTHROW(rigid_outline(OutlineCurve(thin), 32));
}
