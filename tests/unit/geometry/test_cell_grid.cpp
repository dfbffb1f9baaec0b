#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "softgrain/geometry/cell_grid.hpp"
#include "support/dimensions.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

template <int Dim>
bool closer(const std::vector<Vec<Dim>>& x, int i, int j, double reach) {
  return norm(x[j] - x[i]) < reach;
}

template <int Dim>
Pairs brute_force_pairs(const std::vector<Vec<Dim>>& x, double reach) {
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(x.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(x.size()); ++j)
      if (closer(x, i, j, reach)) pairs.emplace_back(i, j);
  return pairs;
}

/// The pairs visited, of those the ones closer than the reach; every pair must come once, ordered.
template <int Dim>
void check_pairs(const std::vector<Vec<Dim>>& x, double reach) {
  const CellGrid<Dim> grid(x, reach);
  Pairs visited, close;
  grid.for_each_close_pair([&](int i, int j) {
    visited.emplace_back(i, j);
    if (closer(x, i, j, reach)) close.emplace_back(i, j);
  });
  std::sort(visited.begin(), visited.end());
  CHECK(std::adjacent_find(visited.begin(), visited.end()) == visited.end());
  CHECK(std::all_of(visited.begin(), visited.end(), [](auto pair) { return pair.first < pair.second; }));
  std::sort(close.begin(), close.end());
  CHECK(close == brute_force_pairs(x, reach));

  Pairs by_rows;
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    grid.for_each_neighbour(i, [&](int j) {
      REQUIRE(i != j);
      if (i < j && closer(x, i, j, reach)) by_rows.emplace_back(i, j);
    });
  }
  std::sort(by_rows.begin(), by_rows.end());
  CHECK(by_rows == close);
}

template <int Dim>
std::vector<Vec<Dim>> random_points(int count, double size) {
  test::RandomNumbers random(count);
  std::vector<Vec<Dim>> x(count);
  for (Vec<Dim>& point : x) point = random.vector<Dim>(size);
  return x;
}

}  // namespace

TEST_CASE_TEMPLATE("the grid finds the close pairs that brute force finds", Dimension, test::Plane,
                   test::Space) {
  constexpr int Dim = Dimension::value;
  for (const double reach : {0.05, 0.2, 0.7, 5.0}) {
    CAPTURE(reach);
    check_pairs(random_points<Dim>(300, 1), reach);
  }
}

TEST_CASE_TEMPLATE("far outliers neither cost memory nor hide a pair", Dimension, test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  auto x = random_points<Dim>(200, 1);
  for (const double far : {1e3, -1e9, 1e15}) x.push_back(far * x[0]);
  check_pairs(x, 0.1);
}

TEST_CASE_TEMPLATE("coincident points are pairs like all others", Dimension, test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  check_pairs(std::vector<Vec<Dim>>(20), 0.1);
  auto x = random_points<Dim>(50, 1);
  x.insert(x.end(), x.begin(), x.begin() + 25);
  check_pairs(x, 0.3);
}

TEST_CASE("points in a row fill cells along one axis only") {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec<3>> x(40);
    for (int i = 0; i < 40; ++i) x[i][axis] = 0.3 * i;
    check_pairs(x, 0.65);
  }
}

TEST_CASE("no point and a single point have no pairs") {
  check_pairs(std::vector<Vec<2>>{}, 1);
  check_pairs(std::vector<Vec<2>>{{3, 4}}, 1);
}

TEST_CASE("a position that is not finite has no cell") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (std::size_t place : {0u, 1u}) {
      std::vector<Vec<2>> x{{0, 0}, {1, 1}};
      x[place][1] = bad;
      CHECK_THROWS_AS(CellGrid<2>(x, 1), NumericalError);
    }
}
