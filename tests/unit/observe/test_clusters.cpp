#include <doctest/doctest.h>

#include <vector>

#include "softgrain/observe/clusters.hpp"

using namespace softgrain;

using Links = std::vector<std::pair<int, int>>;

TEST_CASE("particles without links are clusters of one") {
  CHECK(count_clusters(0, Links{}) == 0);
  CHECK(count_clusters(4, Links{}) == 4);
}

TEST_CASE("a chain and a ring are one cluster each") {
  CHECK(count_clusters(4, Links{{0, 1}, {2, 3}, {1, 2}}) == 1);
  CHECK(count_clusters(7, Links{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {5, 4}, {6, 5}, {3, 6}}) == 2);
}

TEST_CASE("links within a cluster and repeated links count once") {
  CHECK(count_clusters(5, Links{{0, 1}, {1, 0}, {0, 1}, {3, 3}}) == 4);
}

TEST_CASE("a cut through a long chain makes two clusters") {
  Links chain;
  for (int i = 999; i > 0; --i)
    if (i != 400) chain.emplace_back(i, i - 1);
  CHECK(count_clusters(1000, chain) == 2);
}
