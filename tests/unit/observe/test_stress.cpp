#include <doctest/doctest.h>

#include <vector>

#include "softgrain/observe/stress.hpp"

using namespace softgrain;

TEST_CASE("two disks pressed together have the pressure f R / 2 A each") {
  // b to the right of a; a pushes b with 6 N/m along x
  const std::vector<BranchForce> forces{
      {.a = 0, .b = 1, .force = {6, 0}, .branch_a = {0.5, 0}, .branch_b = {-0.25, 0}}};
  const auto pressure = virial_pressure(forces, std::vector<double>{2, 3});
  CHECK(pressure[0] == 6 * 0.5 / (2 * 2));
  CHECK(pressure[1] == 6 * 0.25 / (2 * 3));
}

TEST_CASE("attraction makes the pressure negative and shear leaves it alone") {
  const std::vector<double> area{1, 1};
  const auto pulled = virial_pressure(
      std::vector<BranchForce>{
          {.a = 0, .b = 1, .force = {-6, 0}, .branch_a = {0.5, 0}, .branch_b = {-0.5, 0}}},
      area);
  CHECK(pulled[0] == -1.5);
  CHECK(pulled[1] == -1.5);
  const auto sheared = virial_pressure(
      std::vector<BranchForce>{
          {.a = 0, .b = 1, .force = {0, 6}, .branch_a = {0.5, 0}, .branch_b = {-0.5, 0}}},
      area);
  CHECK(sheared == std::vector<double>{0, 0});
}

TEST_CASE("a disk between four walls has the mean of the two stresses") {
  // stress f_x / L and f_y / L on a square of side L around the disk
  const double L = 2, f_x = 3, f_y = 5;
  std::vector<BranchForce> forces;
  for (const double side : {-1.0, 1.0}) {
    forces.push_back(
        {.a = 0, .b = -1, .force = {side * f_x, 0}, .branch_a = {side * L / 2, 0}, .branch_b = {}});
    forces.push_back(
        {.a = 0, .b = -1, .force = {0, side * f_y}, .branch_a = {0, side * L / 2}, .branch_b = {}});
  }
  CHECK(virial_pressure(forces, std::vector<double>{L * L})[0] == (f_x / L + f_y / L) / 2);
  // the same, with the disk as the second body
  for (BranchForce& f : forces)
    f = {.a = -1, .b = 0, .force = -f.force, .branch_a = {}, .branch_b = f.branch_a};
  CHECK(virial_pressure(forces, std::vector<double>{L * L})[0] == (f_x / L + f_y / L) / 2);
}

TEST_CASE("a box of disks in a square packing has the walls' stress") {
  // n x n disks of radius 1; each column carries f_y, each row f_x, from wall to wall
  constexpr int n = 5;
  constexpr double f_x = 3, f_y = 7, side = 2 * n;
  const auto grain = [](int column, int row) { return n * row + column; };
  std::vector<Vec<2>> centre(n * n);
  std::vector<ContactPoint> contacts;
  const auto add = [&](int a, int b, const Vec<2>& n_ab, double force) {
    contacts.push_back({.a = a, .b = b, .force = force * n_ab, .normal = n_ab, .position = centre[a] + n_ab});
  };
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) centre[grain(i, k)] = {2.0 * i + 1, 2.0 * k + 1};
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i + 1 < n; ++i) {
      add(grain(i + 1, k), grain(i, k), {-1, 0}, f_x);
      add(grain(k, i), grain(k, i + 1), {0, 1}, f_y);
    }
    add(grain(0, k), wall_index(0), {-1, 0}, f_x);
    add(grain(n - 1, k), wall_index(1), {1, 0}, f_x);
    add(grain(k, 0), wall_index(2), {0, -1}, f_y);
    add(grain(k, n - 1), wall_index(3), {0, 1}, f_y);
  }
  const Mat<2> sigma = contact_stress(contacts, centre, side * side);
  CHECK(sigma(0, 0) == doctest::Approx(n * f_x / side));  // force on a wall over its length
  CHECK(sigma(1, 1) == doctest::Approx(n * f_y / side));
  CHECK(sigma(0, 1) == 0);
  CHECK(sigma(1, 0) == 0);
}

TEST_CASE("a gas has the pressure of its motion, and a stream as a whole has none") {
  // p = N m <v_x^2>/V for velocities +-v about a stream
  const std::vector<double> mass{2, 2, 2, 2};
  const std::vector<Vec<2>> velocity{{10 + 3, 5}, {10 - 3, 5}, {10, 5 + 1}, {10, 5 - 1}};
  const Mat<2> sigma = kinetic_stress(mass, velocity, 4);
  CHECK(sigma(0, 0) == 2 * 2 * 9.0 / 4);
  CHECK(sigma(1, 1) == 2 * 2 * 1.0 / 4);
  CHECK(sigma(0, 1) == 0);
}

TEST_CASE("two spheres pressed together have the pressure f R / 3 V each") {
  constexpr double f = 6, R = 2, V = 5;
  const std::vector<BranchForceOf<3>> forces{
      {.a = 0, .b = 1, .force = {0, 0, f}, .branch_a = {0, 0, R}, .branch_b = {0, 0, -R}}};
  const auto pressure = virial_pressure(forces, std::vector<double>{V, 2 * V});
  CHECK(pressure[0] == f * R / (3 * V));
  CHECK(pressure[1] == f * R / (6 * V));
}
