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
