#include "softgrain/observe/contact_network.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "softgrain/math/random.hpp"

using namespace softgrain;

namespace {

/// Disks that touch or overlap push with 1 N/m; those beyond the box's sides push its walls.
std::vector<ContactPoint> touching(const std::vector<Vec<2>>& x, const std::vector<double>& R) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < static_cast<int>(x.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(x.size()); ++j) {
      const Vec<2> d = x[j] - x[i];
      const double r = norm(d);
      if (r > (R[i] + R[j]) * (1 + 1e-9)) continue;
      const Vec<2> n = (1 / r) * d;
      points.push_back({.a = i, .b = j, .force = n, .normal = n, .position = x[i] + R[i] * n, .length = 0.1});
    }
  return points;
}

ContactPoint push(int a, int b, double force, double length = 0) {
  return {.a = a, .b = b, .force = {force, 0}, .normal = {1, 0}, .position = {}, .length = length};
}

}  // namespace

TEST_CASE("inside a hexagonal packing every grain has six neighbours, inside a square one four") {
  for (const bool hexagonal : {true, false}) {
    constexpr int n = 12;
    std::vector<Vec<2>> x;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column)
        x.push_back(hexagonal ? Vec<2>{2.0 * column + (row % 2), row * std::sqrt(3.0)}
                              : Vec<2>{2.0 * column, 2.0 * row});
    const ContactNetwork network = contact_network(touching(x, std::vector<double>(n * n, 1)), n * n);
    std::vector<int> neighbours(n * n, 0);
    for (const GrainPair& pair : network.pairs) ++neighbours[pair.a], ++neighbours[pair.b];
    for (int row = 1; row < n - 1; ++row)
      for (int column = 1; column < n - 1; ++column)
        CHECK(neighbours[n * row + column] == (hexagonal ? 6 : 4));
    // pairs of a finite piece: rows, and rises between rows
    const int pairs = n * (n - 1) + (hexagonal ? (n - 1) * (2 * n - 1) : n * (n - 1));
    CHECK(coordination(network).z == doctest::Approx(2.0 * pairs / (n * n)));
    CHECK(coordination(network).rattlers == 0);
  }
}

TEST_CASE("two grains that touch in many points are one pair with the sum of the forces and lengths") {
  const std::vector<ContactPoint> points{
      {.a = 1, .b = 0, .force = {0, -3}, .normal = {0, -1}, .position = {1, 0}, .length = 2},
      {.a = 0, .b = 1, .force = {4, 0}, .normal = {1, 0}, .position = {8, 0}, .length = 5},
      push(0, wall_index(2), 7),
      push(0, wall_index(2), 1)};
  const ContactNetwork network = contact_network(points, 2);
  REQUIRE(network.pairs.size() == 1);
  const GrainPair& pair = network.pairs.front();
  CHECK(pair.a == 0);
  CHECK(pair.b == 1);
  CHECK(pair.points == 2);
  CHECK(pair.normal_force == 7);
  CHECK(pair.force == Vec<2>{4, 3});
  CHECK(pair.length == 7);
  CHECK(pair.position[0] == doctest::Approx((3 * 1 + 4 * 8) / 7.0));
  CHECK(pair.normal[0] == doctest::Approx(0.8));  // (4, 3)/5
  CHECK(pair.normal[1] == doctest::Approx(0.6));
  REQUIRE(network.walls.size() == 1);
  CHECK(network.walls.front().normal_force == 8);
  CHECK(coordination(network).z == 1);
}

TEST_CASE("points that carry no force and points within one grain are no contacts") {
  CHECK(contact_network(std::vector{push(0, 1, 0), push(1, 1, 5)}, 2).pairs.empty());
}

TEST_CASE("points that pull count in a pair: the force is what is left, the place their mean by size") {
  std::vector<ContactPoint> points{push(0, 1, 3), push(0, 1, -2)};
  points[0].position = {5, 0};
  points[1].position = {10, 0};
  const ContactNetwork network = contact_network(points, 2);
  REQUIRE(network.pairs.size() == 1);
  CHECK(network.pairs.front().normal_force == 1);
  CHECK(network.pairs.front().force == Vec<2>{1, 0});
  CHECK(network.pairs.front().position[0] == doctest::Approx(7));
  CHECK(network.pairs.front().normal == Vec<2>{1, 0});
}

TEST_CASE("Z of a random packing equals that counted pair by pair") {
  std::vector<Vec<2>> x;
  std::vector<double> R;
  for (int i = 0; i < 60; ++i) {
    x.push_back({10 * random_uniform(1, 0, 2 * i), 10 * random_uniform(1, 0, 2 * i + 1)});
    R.push_back(0.5 + 0.4 * random_uniform(1, 1, i));
  }
  int both_ways = 0;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      if (i != j && std::hypot(x[i][0] - x[j][0], x[i][1] - x[j][1]) <= R[i] + R[j]) ++both_ways;
  std::vector<ContactPoint> points = touching(x, R);
  const auto again = points;  // every contact found twice
  points.insert(points.end(), again.begin(), again.end());
  CHECK(coordination(contact_network(points, 60)).z == both_ways / 60.0);
}

TEST_CASE("rattlers are taken out until every grain left has two contacts, and walls hold but do not count") {
  // a triangle 0 1 2 with a tail 2-3-4 and a free grain 5; grain 6 between two walls
  const std::vector<ContactPoint> points{push(0, 1, 1),
                                         push(1, 2, 1),
                                         push(0, 2, 1),
                                         push(2, 3, 1),
                                         push(3, 4, 1),
                                         push(6, wall_index(0), 1),
                                         push(6, wall_index(1), 1)};
  const Coordination c = coordination(contact_network(points, 7));
  CHECK(c.z == 2 * 5 / 7.0);
  CHECK(c.rattlers == doctest::Approx(3 / 7.0));           // 4, then 3, and 5
  CHECK(c.z_no_rattlers == doctest::Approx(2 * 3 / 4.0));  // the triangle, and grain 6
}

TEST_CASE("the backbone loses grains with two contacts, and with them their neighbours") {
  // a tetrahedron-like core 0 1 2 3, each with three contacts; 4 hangs on two of them; 5 and 6 hold each
  // other and one wall each; 7 is free
  const std::vector<ContactPoint> points{push(0, 1, 1),
                                         push(0, 2, 1),
                                         push(0, 3, 1),
                                         push(1, 2, 1),
                                         push(1, 3, 1),
                                         push(2, 3, 1),
                                         push(3, 4, 1),
                                         push(2, 4, 1),
                                         push(5, wall_index(0), 1),
                                         push(6, wall_index(1), 1),
                                         push(5, 6, 1)};
  const Coordination c = coordination(contact_network(points, 8));
  CHECK(c.rattlers == 1 / 8.0);
  CHECK(c.z_no_rattlers == 2 * 9 / 7.0);
  CHECK(c.backbone == 4 / 8.0);
  CHECK(c.z_backbone == 2 * 6 / 4.0);
  CHECK(c.z == 2 * 9 / 8.0);
  CHECK(c.z_with_walls == 2 * 11 / 8.0);
  const Coordination ring =
      coordination(contact_network(std::vector{push(0, 1, 1), push(1, 2, 1), push(0, 2, 1)}, 3));
  CHECK(ring.rattlers == 0);
  CHECK(ring.backbone == 0);
  CHECK(ring.z_backbone == 0);
}

TEST_CASE("disks in columns between floor and top wall are isostatic only when the walls count") {
  // n columns of one disk each, held by four walls: N_gg = n - 1, N_gw = 2 n + 2, so 2 (3 n + 1)/n
  constexpr int n = 10;
  std::vector<ContactPoint> points;
  for (int i = 0; i < n; ++i) {
    points.push_back(push(i, wall_index(0), 1)), points.push_back(push(i, wall_index(1), 1));
    if (i + 1 < n) points.push_back(push(i, i + 1, 1));
  }
  points.push_back(push(0, wall_index(2), 1)), points.push_back(push(n - 1, wall_index(3), 1));
  const Coordination c = coordination(contact_network(points, n));
  CHECK(c.z == 2 * (n - 1) / 10.0);
  CHECK(c.z_with_walls == 2 * (3 * n + 1) / 10.0);
  CHECK(c.backbone == 1);
}

TEST_CASE("a chain of grains between two walls has no rattlers, a chain with a free end only rattlers") {
  const std::vector<ContactPoint> held{push(0, wall_index(0), 1), push(0, 1, 1), push(1, wall_index(1), 1)};
  CHECK(coordination(contact_network(held, 2)).rattlers == 0);
  const Coordination loose = coordination(contact_network(std::span(held).first(2), 2));
  CHECK(loose.rattlers == 1);
  CHECK(loose.z_no_rattlers == 0);
  CHECK(loose.z == 1);
}

TEST_CASE("a side is a neighbour or wall that touches along a share of the perimeter") {
  // perimeter 10 for grain 0, 40 for grain 1: their contact of 0.5 is a side of the small one only
  const std::vector<ContactPoint> points{push(0, 1, 1, 0.5), push(0, wall_index(0), 1, 0.3),
                                         push(0, wall_index(1), 1, 0.1)};
  CHECK(mean_sides(contact_network(points, 2), std::vector<double>{10, 40}) == 2 / 2.0);
}
