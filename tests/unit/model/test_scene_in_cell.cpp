#include "softgrain/model/scene_in_cell.hpp"

#include <doctest/doctest.h>

using namespace softgrain;

TEST_CASE(
    "a scene shows each grain in the cell, with its points, outline and contacts, and knows the lattice") {
  PeriodicCell<2> cell{.repeats = {true, true}};
  cell.edges = {{2.0, 0.5, 0.0, 1.0}};
  // two grains: one in the cell, one two cells to the right and one below
  const std::vector<Vec<2>> centres{{1, 0.5}, Vec<2>{1, 0.5} + cell.shift({2, -1})};
  Scene scene;
  scene.particles["position"] = to_array(std::vector<Vec<2>>{centres[0], centres[1] + Vec<2>{0.1, 0}});
  scene.particles["grain"] = {1, std::vector<std::int64_t>{0, 1}};
  scene.outlines["position"] = to_array(std::vector<Vec<2>>{centres[1] + Vec<2>{0, 0.2}});
  scene.outlines["grain"] = {1, std::vector<std::int64_t>{1}};
  scene.contacts["pair"] = {2, std::vector<std::int64_t>{1, 0}};
  scene.contacts["position"] = to_array(std::vector<Vec<2>>{centres[1] + Vec<2>{-0.3, 0}});
  move_into_cell<2>(cell, centres, scene);

  const auto rows = [](const Array& array) { return std::get<std::vector<double>>(array.values); };
  const auto close = [](const std::vector<double>& a, const std::vector<double>& b) {
    double most = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      most = std::max(most, std::abs(a[i] - b[i]));
    return most < 1e-12;
  };
  CHECK(close(rows(scene.particles["position"]), {1, 0.5, 1.1, 0.5}));
  CHECK(close(rows(scene.outlines["position"]), {1, 0.7}));
  CHECK(close(rows(scene.contacts["position"]), {0.7, 0.5}));
  CHECK(cell_of<2>(scene).edges == cell.edges);
  CHECK(cell_of<2>(scene).repeats == cell.repeats);
  CHECK_FALSE(cell_of<2>(Scene{}).any());

  cell = {.repeats = {true, false}};
  cell.edges(0, 0) = 2;
  move_into_cell<2>(cell, centres, scene);
  CHECK(scene.cell == std::vector<double>{2, 0, 0, 0});
  CHECK(cell_of<2>(scene).repeats == cell.repeats);
}

TEST_CASE("a scene in space shows a sphere in the cell through which it left") {
  PeriodicCell<3> cell{.repeats = {true, false, true}};
  cell.edges = {{2, 0, 0, 0, 1, 0, 0, 0, 3}};
  const std::vector<Vec<3>> centres{{2.5, 1.5, -0.5}};
  Scene scene;
  scene.particles["position"] = to_array(centres);
  scene.particles["grain"] = {1, std::vector<std::int64_t>{0}};
  move_into_cell<3>(cell, centres, scene);
  CHECK(std::get<std::vector<double>>(scene.particles["position"].values) ==
        std::vector<double>{0.5, 1.5, 2.5});
  CHECK(scene.cell == std::vector<double>{2, 0, 0, 0, 0, 0, 0, 0, 3});
  CHECK(cell_of<3>(scene).repeats == cell.repeats);
}
