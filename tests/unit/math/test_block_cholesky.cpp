#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <set>
#include <vector>

#include "softgrain/math/block_cholesky.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

using Edges = std::vector<std::array<int, 2>>;

/// A path, so that all is connected, and random chords.
Edges random_graph(int nodes, int chords, test::RandomNumbers& random) {
  std::set<std::array<int, 2>> edges;
  for (int i = 1; i < nodes; ++i) edges.insert({i - 1, i});
  while (chords-- > 0) {
    const int i = static_cast<int>(random.uniform(0, nodes)), j = static_cast<int>(random.uniform(0, nodes));
    if (i != j)
      edges.insert({std::max(i, j) - 1, std::max(i, j)}), edges.insert({std::min(i, j), std::max(i, j)});
  }
  return {edges.begin(), edges.end()};
}

/// Eight random symmetric matrices on a graph, positive definite by their diagonal: dense, and in the lanes.
struct EightMatrices {
  EightMatrices(const BlockPattern& pattern, const Edges& edges, test::RandomNumbers& random,
                Precision precision = Precision::full)
      : lanes(pattern) {
    const int n = pattern.nodes();
    for (auto& A : dense) A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    lanes.clear(precision);
    for (const auto& [i, j] : edges) add(random.uniform(0, 1) < 0.5 ? i : j, i, j, random);
    for (int i = 0; i < n; ++i) {
      std::array<Wide, 4> block;
      for (int lane = 0; lane < Wide::size; ++lane) {
        const double a = random.uniform(15, 25), b = random.uniform(15, 25), c = random.uniform(-1, 1);
        block[0].set(lane, a), block[3].set(lane, b), block[1].set(lane, c), block[2].set(lane, c);
        dense[lane].block<2, 2>(2 * i, 2 * i) << a, c, c, b;
      }
      lanes.add(i, i, block);
    }
  }

  BatchedCholesky lanes;
  std::array<Eigen::MatrixXd, Wide::size> dense;

 private:
  /// The entry (first, other end), so that both orientations come up.
  void add(int first, int i, int j, test::RandomNumbers& random) {
    const int row = first, column = first == i ? j : i;
    std::array<Wide, 4> block;
    for (int lane = 0; lane < Wide::size; ++lane)
      for (int k = 0; k < 4; ++k) {
        const double value = random.uniform(-1, 1);
        block[k].set(lane, value);
        dense[lane](2 * row + k / 2, 2 * column + k % 2) += value;
        dense[lane](2 * column + k % 2, 2 * row + k / 2) += value;
      }
    lanes.add(row, column, block);
  }
};

/// Largest |x - A^-1 b| of the lanes in `mask`, with A^-1 by Eigen.
double solution_error(EightMatrices& A, unsigned mask, test::RandomNumbers& random) {
  const int n = static_cast<int>(A.dense[0].rows());
  std::vector<Wide> x(n);
  Eigen::MatrixXd b(n, Wide::size);
  for (int i = 0; i < n; ++i)
    for (int lane = 0; lane < Wide::size; ++lane) x[i].set(lane, b(i, lane) = random.uniform(-1, 1));
  A.lanes.solve(x);
  double worst = 0;
  for (int lane = 0; lane < Wide::size; ++lane) {
    if ((mask >> lane & 1u) == 0) continue;
    const Eigen::VectorXd exact = A.dense[lane].llt().solve(b.col(lane));
    for (int i = 0; i < n; ++i) worst = std::max(worst, std::abs(x[i][lane] - exact[i]));
  }
  return worst;
}

}  // namespace

TEST_CASE("eight different matrices are factored and solved at once as Eigen does one by one") {
  test::RandomNumbers random(11);
  for (const int nodes : {1, 2, 9, 40}) {
    for (const int kept : {0, 1, nodes / 2, nodes}) {
      const Edges edges = random_graph(nodes, nodes > 2 ? nodes : 0, random);
      const BlockPattern pattern(nodes, edges, kept);
      EightMatrices A(pattern, edges, random);
      REQUIRE(A.lanes.factor() == 0);
      CHECK(solution_error(A, 0xff, random) < 1e-14);
    }
  }
}

TEST_CASE("in single precision the same matrices are solved to its round-off") {
  test::RandomNumbers random(11);
  const int nodes = 40, kept = 12;
  const Edges edges = random_graph(nodes, nodes, random);
  const BlockPattern pattern(nodes, edges, kept);
  EightMatrices A(pattern, edges, random, Precision::single);
  REQUIRE(A.lanes.factor() == 0);
  const double error = solution_error(A, 0xff, random);  // of solutions near 0.05
  CHECK(error < 5e-8);
  CHECK(error > 1e-10);
  std::vector<double> compliance(8 * 4 * kept * kept);
  A.lanes.kept_inverse(compliance);
  const Eigen::MatrixXd corner = A.dense[5].inverse().bottomRightCorner(2 * kept, 2 * kept);
  for (int i = 0; i < 4 * kept * kept; ++i)
    CHECK(std::abs(compliance[5 * 4 * kept * kept + i] - corner(i / (2 * kept), i % (2 * kept))) < 5e-8);
  A.lanes.clear();  // and back
  for (int i = 0; i < nodes; ++i) A.lanes.add(i, i, {2.0, 0.0, 0.0, 2.0});
  REQUIRE(A.lanes.factor() == 0);
  std::vector<Wide> x(2 * nodes, Wide(1.0));
  A.lanes.solve(x);
  CHECK(x[7][3] == doctest::Approx(0.5).epsilon(1e-15));
}

TEST_CASE("a solve in two halves takes more on the kept nodes in between") {
  test::RandomNumbers random(13);
  const int nodes = 30, kept = 7;
  const Edges edges = random_graph(nodes, nodes, random);
  const BlockPattern pattern(nodes, edges, kept);
  EightMatrices A(pattern, edges, random);
  REQUIRE(A.lanes.factor() == 0);
  std::vector<Wide> b(2 * nodes), y(2 * nodes), d(2 * kept), h(2 * kept), x(2 * nodes);
  for (auto* values : {&b, &h})
    for (Wide& value : *values)
      for (int lane = 0; lane < Wide::size; ++lane) value.set(lane, random.uniform(-1, 1));
  A.lanes.begin_solve(b, y, d);
  A.lanes.finish_solve(y, h, x);
  for (int lane = 0; lane < Wide::size; ++lane) {
    Eigen::VectorXd right(2 * nodes), more = Eigen::VectorXd::Zero(2 * nodes);
    for (int i = 0; i < 2 * nodes; ++i) right[i] = b[i][lane];
    for (int i = 0; i < 2 * kept; ++i) more[2 * (nodes - kept) + i] = h[i][lane];
    const auto inverse = A.dense[lane].llt();
    const Eigen::VectorXd first = inverse.solve(right), both = inverse.solve(right + more);
    for (int i = 0; i < 2 * kept; ++i)
      CHECK(d[i][lane] == doctest::Approx(first[2 * (nodes - kept) + i]).epsilon(1e-12));
    for (int i = 0; i < 2 * nodes; ++i) CHECK(x[i][lane] == doctest::Approx(both[i]).epsilon(1e-12));
  }
}

TEST_CASE("the compliance of the kept nodes is the corner of the inverse matrix") {
  test::RandomNumbers random(12);
  const int nodes = 30, kept = 12;
  const Edges edges = random_graph(nodes, 25, random);
  const BlockPattern pattern(nodes, edges, kept);
  EightMatrices A(pattern, edges, random);
  REQUIRE(A.lanes.factor() == 0);
  std::vector<double> compliance(8 * 4 * kept * kept);
  A.lanes.kept_inverse(compliance);
  double worst = 0;
  for (int lane = 0; lane < Wide::size; ++lane) {
    const Eigen::MatrixXd corner = A.dense[lane].inverse().bottomRightCorner(2 * kept, 2 * kept);
    for (int i = 0; i < 2 * kept; ++i)
      for (int j = 0; j < 2 * kept; ++j)
        worst = std::max(worst, std::abs(compliance[2 * kept * (2 * kept * lane + i) + j] - corner(i, j)));
  }
  CHECK(worst < 1e-15);
}

TEST_CASE("a lane whose matrix is not positive definite is named, and spoils no other") {
  test::RandomNumbers random(13);
  const Edges edges = random_graph(20, 15, random);
  const BlockPattern pattern(20, edges, 6);
  EightMatrices A(pattern, edges, random);
  std::array<Wide, 4> lowered{};
  lowered[0].set(2, -30);  // A_77 < 0 in lane 2, the second entry of the block in lane 5
  lowered[3].set(5, -30);
  A.lanes.add(7, 7, lowered);
  CHECK(A.lanes.factor() == ((1u << 2) | (1u << 5)));
  CHECK(solution_error(A, 0xffu & ~((1u << 2) | (1u << 5)), random) < 1e-14);
}

TEST_CASE("the kept nodes are eliminated last, in their own order, and every edge has its block") {
  test::RandomNumbers random(14);
  const int nodes = 25, kept = 7;
  const Edges edges = random_graph(nodes, 20, random);
  const BlockPattern pattern(nodes, edges, kept);
  std::set<int> places;
  for (int i = 0; i < nodes; ++i) places.insert(pattern.order(i));
  CHECK(places.size() == nodes);
  CHECK(*places.begin() == 0);
  CHECK(*places.rbegin() == nodes - 1);
  for (int i = nodes - kept; i < nodes; ++i) CHECK(pattern.order(i) == i);
  std::set<int> blocks;
  for (const auto& [i, j] : edges) {
    blocks.insert(pattern.block(i, j));
    CHECK(pattern.block(j, i) == pattern.block(i, j));
    CHECK(pattern.transposed(i, j) != pattern.transposed(j, i));
  }
  CHECK(blocks.size() == edges.size());
}

TEST_CASE("minimum degree eliminates a star from its leaves, without any fill") {
  Edges star;
  for (int leaf = 1; leaf < 12; ++leaf) star.push_back({0, leaf});
  CHECK(BlockPattern(12, star, 0).blocks() == 12 + 11);
}
