#include <doctest/doctest.h>

#include <array>

#include "softgrain/math/lanes.hpp"

using namespace softgrain;

namespace {

/// Row k is (k, 10 + k).
std::array<Vec<2>, 8> numbered_rows() {
  std::array<Vec<2>, 8> rows;
  for (int k = 0; k < 8; ++k) rows[k] = {1.0 * k, 10.0 + k};
  return rows;
}

void check_columns(const LaneColumns& columns, std::array<int, 4> expected_row) {
  for (int lane = 0; lane < lane_count; ++lane) {
    CHECK(columns.x[lane] == expected_row[lane]);
    CHECK(columns.y[lane] == 10 + expected_row[lane]);
  }
}

}  // namespace

TEST_CASE("gathered columns hold the rows asked for, in their order") {
  const auto rows = numbered_rows();
  const std::array<int, 4> index{6, 1, 7, 2};
  check_columns(gather_columns(rows.data(), index.data()), index);
}

TEST_CASE("consecutive rows load as columns without alignment") {
  const auto rows = numbered_rows();
  check_columns(load_columns(&rows[3]), {3, 4, 5, 6});
}

TEST_CASE("scattered columns write their rows and leave the others alone") {
  const auto before = numbered_rows();
  auto rows = before;
  const std::array<int, 4> index{6, 1, 7, 2};
  scatter_columns({Lanes{-1, -2, -3, -4}, Lanes{-5, -6, -7, -8}}, rows.data(), index.data());
  CHECK(rows[6] == Vec<2>{-1, -5});
  CHECK(rows[1] == Vec<2>{-2, -6});
  CHECK(rows[7] == Vec<2>{-3, -7});
  CHECK(rows[2] == Vec<2>{-4, -8});
  for (const int k : {0, 3, 4, 5}) CHECK(rows[k] == before[k]);
}

TEST_CASE("scatter undoes gather and store undoes load") {
  const auto before = numbered_rows();
  auto rows = before;
  const std::array<int, 4> index{5, 0, 4, 3};
  scatter_columns(gather_columns(rows.data(), index.data()), rows.data(), index.data());
  CHECK(rows == before);
  store_columns(load_columns(&rows[2]), &rows[2]);
  CHECK(rows == before);
}

TEST_CASE("stored columns become consecutive rows") {
  auto rows = numbered_rows();
  store_columns({Lanes{-1, -2, -3, -4}, Lanes{-5, -6, -7, -8}}, &rows[1]);
  for (int lane = 0; lane < lane_count; ++lane) CHECK(rows[1 + lane] == Vec<2>{-1.0 - lane, -5.0 - lane});
  CHECK(rows[0] == Vec<2>{0, 10});
  CHECK(rows[5] == Vec<2>{5, 15});
}

TEST_CASE("lanes load and splat without alignment, and reduce") {
  const std::array<double, 6> values{9, 1, -4, 2, 8, 9};
  const Lanes lanes = load_lanes(&values[1]);
  CHECK(horizontal_sum(lanes) == 7);
  CHECK(horizontal_max(lanes) == 8);
  const Lanes low = min(lanes, splat(1.5)), high = max(lanes, splat(1.5));
  CHECK(horizontal_sum(low) == 1 - 4 + 1.5 + 1.5);
  CHECK(horizontal_sum(high) == 1.5 + 1.5 + 2 + 8);
  for (int lane = 0; lane < lane_count; ++lane) {
    Lanes one_large = splat(-1);
    one_large[lane] = 5;
    CHECK(horizontal_max(one_large) == 5);
  }
}
