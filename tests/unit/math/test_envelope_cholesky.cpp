#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "softgrain/math/envelope_cholesky.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

/// A random symmetric matrix, positive definite by its diagonal, in rows of many lengths: dense, and by rows.
struct BothMatrices {
  BothMatrices(int nodes, test::RandomNumbers& random) : dense(Eigen::MatrixXd::Zero(2 * nodes, 2 * nodes)) {
    std::vector<int> first;
    for (int i = 0; i < nodes; ++i) first.push_back(std::max(0, i - static_cast<int>(random.uniform(0, 12))));
    rows.reset(first);
    for (int i = 0; i < nodes; ++i)
      for (int j = first[i]; j <= i; ++j) {
        Mat<2> block;
        for (double& entry : block.c) entry = random.uniform(-1, 1);
        if (i == j) block = {{random.uniform(20, 30), block(0, 1), block(0, 1), random.uniform(20, 30)}};
        rows.add(i, j, block);
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b) dense(2 * i + a, 2 * j + b) = dense(2 * j + b, 2 * i + a) = block(a, b);
      }
  }
  EnvelopeCholesky rows;
  Eigen::MatrixXd dense;
};

}  // namespace

TEST_CASE("a matrix kept by rows solves and inverts as a dense one does") {
  test::RandomNumbers random(7);
  for (const int nodes : {1, 2, 9, 40}) {
    CAPTURE(nodes);
    BothMatrices A(nodes, random);
    REQUIRE(A.rows.factor());
    std::vector<Vec<2>> x(nodes);
    Eigen::VectorXd b(2 * nodes);
    for (int k = 0; k < 2 * nodes; ++k) b(k) = x[k / 2][k % 2] = random.uniform(-1, 1);
    A.rows.solve(x);
    const Eigen::VectorXd solved = A.dense.ldlt().solve(b);
    for (int k = 0; k < 2 * nodes; ++k) CHECK(std::abs(x[k / 2][k % 2] - solved(k)) < 1e-14);

    std::vector<int> some;
    for (int i = 0; i < nodes; ++i)
      if (random.uniform(0, 1) < 0.4 || i + 1 == nodes) some.push_back(i);
    const std::vector<double> inverse = A.rows.inverse_on(some);
    const Eigen::MatrixXd whole = A.dense.inverse();
    const std::size_t width = 2 * some.size();
    REQUIRE(inverse.size() == width * width);
    for (std::size_t r = 0; r < width; ++r)
      for (std::size_t c = 0; c < width; ++c)
        CHECK(std::abs(inverse[r * width + c] - whole(2 * some[r / 2] + r % 2, 2 * some[c / 2] + c % 2)) <
              1e-15);
  }
}

TEST_CASE("a matrix kept by rows that is not positive definite has no factor") {
  EnvelopeCholesky A;
  A.reset({0, 0});
  A.add(0, 0, Mat<2>::diagonal({2, 2}));
  A.add(1, 1, Mat<2>::diagonal({2, 2}));
  A.add(1, 0, Mat<2>::diagonal({3, 0}));
  CHECK_FALSE(A.factor());
}
