#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/contact/block_sweeps.hpp"

using namespace softgrain;

namespace {

/// A row of equal masses [1 kg] in touch, in blocks of a few, without friction and restitution: contact c
/// between masses c and c + 1, u_c = v_c+1 - v_c, W_cc = 2/kg.
class RowOfMasses {
 public:
  RowOfMasses(int blocks, int per_block)
      : velocity(blocks * per_block, 0),
        turns(blocks, 0),
        per_block_(per_block),
        p_(velocity.size() - 1, 0),
        before_(p_.size(), 0),
        ends_(velocity.size(), 0),
        turn_(blocks, 0) {}

  int blocks() const { return static_cast<int>(turn_.size()); }
  void sweep_blocks(std::span<const int> open, std::span<Violation> found, double b, bool measured) {
    for (const int k : open) found[k] = sweep_block(k, b, measured);
  }
  Violation sweep_block(int k, double b, bool measured) {
    ++turns[k];
    turn_[k] = sweep_;
    const int first = k * per_block_;
    for (int c = first; c < first + per_block_ - 1; ++c) go_ahead(c, b);
    Violation violation;
    for (int c = first; c < first + per_block_ - 1; ++c) relax(c, violation);
    return measured ? violation : Violation{};
  }
  void go_ahead_between(double b) {
    for (int k = 1; k < blocks(); ++k) go_ahead(k * per_block_ - 1, b);
  }
  Violation sweep_between(bool measured) {
    Violation violation;
    for (int k = 1; k < blocks(); ++k) relax(k * per_block_ - 1, violation);
    for (int i = 0; i < static_cast<int>(ends_.size()); ++i)
      if (turn_[i / per_block_] == sweep_) ends_[i] = velocity[i];
    ++sweep_;
    return measured ? violation : Violation{};
  }
  double moved(int block) const {
    double most = 0;
    for (int i = block * per_block_; i < (block + 1) * per_block_; ++i)
      most = std::max(most, std::abs(velocity[i] - ends_[i]));
    return 2 * most;
  }

  std::vector<double> velocity;  ///< [m/s]
  std::vector<int> turns;        ///< of each block

  /// Worst violation |min(W p, u)| of the state as it is [m/s].
  double worst() const {
    double worst = 0;
    for (int c = 0; c < static_cast<int>(p_.size()); ++c)
      worst = std::max(worst, std::abs(std::min(2 * p_[c], velocity[c + 1] - velocity[c])));
    return worst;
  }

 private:
  void push(int c, double dp) {
    p_[c] += dp;
    velocity[c] -= dp;
    velocity[c + 1] += dp;
  }
  void go_ahead(int c, double b) {
    const double last = p_[c];
    push(c, b * (last - before_[c]));
    before_[c] = last;
  }
  void relax(int c, Violation& violation) {
    const double u = velocity[c + 1] - velocity[c], dp = std::max(0.0, p_[c] - u / 2) - p_[c];
    push(c, dp);
    violation.add(Vec<1>{2 * dp}, p_[c]);
  }

  int per_block_, sweep_ = 0;
  std::vector<double> p_, before_, ends_;
  std::vector<int> turn_;
};

/// The first mass of a row of 100 in 20 blocks flies at its neighbour at 1 m/s.
RowOfMasses struck_row() {
  RowOfMasses row(20, 5);
  row.velocity[0] = 1;
  return row;
}

}  // namespace

TEST_CASE("a row of masses that is struck at its end goes on as one, momentum over mass") {
  for (const bool extrapolated : {false, true}) {
    RowOfMasses row = struck_row();
    const SolverReport report =
        BlockSweeps().solve(row, 1, {.max_sweeps = 100000, .tolerance = 1e-9, .extrapolated = extrapolated});
    REQUIRE(report.converged);
    for (const double v : row.velocity) CHECK(v == doctest::Approx(0.01).epsilon(1e-4));
  }
}

TEST_CASE("blocks that have converged are left out, and come back when others have moved them") {
  // the mean criterion holds long before the worst-contact criterion does where the blow came from
  for (const bool extrapolated : {false, true}) {
    const SolverOptions options{
        .max_sweeps = 100000, .tolerance = 3e-3, .worst_factor = 1, .extrapolated = extrapolated};
    RowOfMasses row = struck_row();
    const SolverReport report = BlockSweeps().solve(row, 1, options);
    REQUIRE(report.converged);
    const auto [fewest, most] = std::minmax_element(row.turns.begin(), row.turns.end());
    CHECK(*fewest < report.sweeps / 2);
    CHECK(*most > *fewest + 10);
    CHECK(row.worst() <= options.tolerance);  // of the state, by its own law, not as the sweeps saw it
  }
}

TEST_CASE("sweeps that do not converge say so") {
  RowOfMasses row = struck_row();
  const SolverReport report = BlockSweeps().solve(row, 1, {.max_sweeps = 5, .tolerance = 1e-9});
  CHECK_FALSE(report.converged);
  CHECK(report.sweeps == 5);
  CHECK(report.residual_max > 1e-9);
}
