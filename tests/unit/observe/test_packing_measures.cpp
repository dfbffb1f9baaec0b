#include "softgrain/observe/packing_measures.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "softgrain/observe/columns.hpp"

using namespace softgrain;

TEST_CASE("a square packing of square grains shows what can be counted by hand") {
  // 3 x 3 squares of side 2 fill a box of side 6; neighbours push with 5 N/m along x and 10 N/m along y
  constexpr int n = 3;
  constexpr double f_x = 5, f_y = 10, side = 2 * n;
  std::vector<Vec<2>> centre, outline, velocity(n * n, Vec<2>{1, 0});
  std::vector<int> begin{0};
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      const Vec<2> x{2.0 * column + 1, 2.0 * row + 1};
      centre.push_back(x);
      for (const Vec<2>& corner : {Vec<2>{-1, -1}, Vec<2>{1, -1}, Vec<2>{1, 1}, Vec<2>{-1, 1}})
        outline.push_back(x + corner);
      begin.push_back(static_cast<int>(outline.size()));
    }
  std::vector<ContactPoint> contacts;
  const auto push = [&](int a, int b, const Vec<2>& normal, double force) {
    for (int point = 0; point < 2; ++point)  // at two points, half of the force and of the side each
      contacts.push_back({.a = a,
                          .b = b,
                          .force = (force / 2) * normal,
                          .normal = normal,
                          .position = centre[a] + normal,
                          .length = 1});
  };
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      const int along_x = n * k + i, along_y = n * i + k;
      push(along_x, i + 1 < n ? along_x + 1 : wall_index(3), {1, 0}, f_x);
      push(along_y, i + 1 < n ? along_y + n : wall_index(1), {0, 1}, f_y);
      if (i == 0) push(along_x, wall_index(2), {-1, 0}, f_x), push(along_y, wall_index(0), {0, -1}, f_y);
    }
  const std::vector<double> radius(n * n, 0.9), mass(n * n, 4);
  Observation observation;
  observation.wall_force = {6, 10, 3, 5};
  observation.width = 4;  // of the box, so that a mean of stresses is none of forces
  observation.height = 2;
  observation.packing = measure_packing({.width = side,
                                         .height = side,
                                         .radius = radius,
                                         .grain_area = 4.0 * n * n,
                                         .centre = centre,
                                         .outline = outline,
                                         .outline_begin = begin,
                                         .contacts = contacts,
                                         .mass = mass,
                                         .velocity = velocity,
                                         .density = 1000,
                                         .strain_rate = -2});
  std::map<std::string, double> row;
  for (const Quantity& quantity : row_of(observation)) row[quantity.name] = quantity.value;
  CHECK(row["phi"] == doctest::Approx(1));
  CHECK(row["phi_0"] == doctest::Approx(std::numbers::pi * 0.81 / 4));
  CHECK(row["area_ratio"] == doctest::Approx(4 / (std::numbers::pi * 0.81)));
  CHECK(row["z"] == doctest::Approx(2 * 12 / 9.0));
  CHECK(row["z_no_rattlers"] == doctest::Approx(2 * 12 / 9.0));
  CHECK(row["rattlers"] == 0);
  CHECK(row["z_with_walls"] == doctest::Approx(2 * 24 / 9.0));
  CHECK(row["z_backbone"] == doctest::Approx(2 * 12 / 9.0));
  CHECK(row["backbone"] == 1);
  CHECK(row["sides"] == 4);
  CHECK(row["stress_xx"] == doctest::Approx(n * f_x / side));
  CHECK(row["stress_yy"] == doctest::Approx(n * f_y / side));
  CHECK(row["stress_xy"] == doctest::Approx(0));
  CHECK(row["stress_kinetic"] == doctest::Approx(0));  // all grains move alike
  CHECK(row["inertial_number"] == doctest::Approx(2 * 1.8 * std::sqrt(1000 / 3.75)));
  CHECK(row["anisotropy"] == doctest::Approx(0));
  CHECK(row["force_mean"] == doctest::Approx(7.5));
  CHECK(row["circularity"] == doctest::Approx(std::numbers::pi / 4));
  CHECK(row["aspect_ratio"] == doctest::Approx(1));
  CHECK(row["transmission_ratio"] == doctest::Approx(0.6));
  CHECK(row["radial_ratio"] == doctest::Approx((4.0 / 2) / (8.0 / 4)));
  observation.wall_force = {0, 0, 3, 5};
  for (const Quantity& quantity : row_of(observation)) row[quantity.name] = quantity.value;
  CHECK(row["transmission_ratio"] == 0);
  CHECK(row["radial_ratio"] == 0);
}
