#include <doctest/doctest.h>

#include "softgrain/contact/delassus_system.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

TEST_CASE(
    "u = W p + q holds for entries in any order, in several pieces, with empty rows and without symmetry") {
  RandomNumbers random(1);
  const int contacts = 6, size = 3 * contacts;
  std::vector<MatrixEntry> entries;
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(size, size);
  for (int k = 0; k < 200; ++k) {
    const MatrixEntry entry{static_cast<int>(random.uniform(0, size)),
                            static_cast<int>(random.uniform(0, size)), random.uniform(-1, 1)};
    if (entry.row / 3 == 2 || entry.row / 3 == contacts - 1) continue;
    entries.push_back(entry);
    W(entry.row, entry.column) += entry.value;
  }
  std::vector<Vec<3>> q;
  for (int c = 0; c < contacts; ++c) q.push_back(random.vector<3>(1));
  DelassusSystem<3> system(entries, q);

  Eigen::VectorXd u(size), p = Eigen::VectorXd::Zero(size);
  for (int c = 0; c < contacts; ++c) {
    const Vec<3> dp = random.vector<3>(1);
    system.apply_impulse(c, dp);
    system.apply_impulse(c, dp);
    for (int k = 0; k < 3; ++k) {
      p[3 * c + k] = 2 * dp[k];
      u[3 * c + k] = q[c][k];
    }
  }
  u += W * p;
  CHECK(system.size() == contacts);
  for (int c = 0; c < contacts; ++c)
    for (int i = 0; i < 3; ++i) {
      CHECK(system.relative_velocity(c)[i] == doctest::Approx(u[3 * c + i]).epsilon(1e-13));
      for (int j = 0; j < 3; ++j)
        CHECK(system.delassus_block(c)(i, j) == doctest::Approx(W(3 * c + i, 3 * c + j)));
    }
}
