#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <numeric>
#include <span>
#include <vector>

#include "softgrain/contact/extrapolate.hpp"
#include "softgrain/contact/law.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/contact/solver_options.hpp"

namespace softgrain {

/// Contacts in blocks that share no body, as those inside grains do, and the contacts between them.
///   sweep_blocks(open, found, b, measured): the impulses of these blocks go ahead by b (Extrapolation) and
///   the velocities that they give with them; then a sweep. found[block] is its violation, counted only if
///   `measured`. On all threads.
///   go_ahead_between(b), sweep_between(measured): the same of the contacts between blocks.
///   moved(k): how much u of a contact of block k may have changed [m/s] since the end of the sweep (of all
///   that was swept then) in which the block had its last turn.
template <class S>
concept BlockSystem = requires(S& s, int block, std::span<const int> open, std::span<Violation> found,
                               double b, bool measured) {
  { s.blocks() } -> std::convertible_to<int>;
  {s.sweep_blocks(open, found, b, measured)};
  {s.go_ahead_between(b)};
  { s.sweep_between(measured) } -> std::same_as<Violation>;
  { s.moved(block) } -> std::convertible_to<double>;
};

/// Nonlinear Gauss-Seidel over blocks, where only those are swept that still need it. All blocks are open
/// until the mean criterion holds; then those where a contact is worse, or may be by now, than the
/// worst-contact criterion allows:
///   max(v_c) of its last turn + moved > worst_factor tolerance.
/// The end is that of repeat_sweeps, with each block as it showed itself in its last turn.
class BlockSweeps {
 public:
  template <BlockSystem System>
  SolverReport solve(System& system, double velocity_scale, const SolverOptions& options) {
    const int first_look = std::min(options.min_sweeps, options.max_sweeps);
    last_.assign(system.blocks(), {});
    open_all();
    Momentum momentum;
    SolverReport report;
    for (int k = 1; k <= options.max_sweeps; ++k) {
      const bool measured = k >= first_look;
      Violation violation = sweep(system, options.extrapolated ? momentum.next() : 0, measured);
      if (!measured) continue;
      momentum.see(violation.sum_of_squares);
      report = report_of(violation, k, velocity_scale, options);
      if (report.converged || !std::isfinite(report.residual_mean)) break;
      open_all();
      if (report.residual_mean <= options.tolerance)
        close(system, options.worst_factor * options.tolerance * velocity_scale);
    }
    return report;
  }

 private:
  void open_all() {
    open_.resize(last_.size());
    std::iota(open_.begin(), open_.end(), 0);
  }
  template <BlockSystem System>
  double worst(System& system, int block) const {
    return std::sqrt(last_[block].max_square) + system.moved(block);
  }
  /// Those within the limit [m/s].
  template <BlockSystem System>
  void close(System& system, double limit) {
    std::erase_if(open_, [&](int block) { return worst(system, block) <= limit; });
  }
  template <BlockSystem System>
  Violation sweep(System& system, double b, bool measured) {
    system.go_ahead_between(b);
    system.sweep_blocks(open_, last_, b, measured);
    Violation violation = system.sweep_between(measured);
    if (!measured) return violation;
    for (int block = 0; block < static_cast<int>(last_.size()); ++block) {
      violation += last_[block];
      const double v = worst(system, block);
      violation.max_square = std::max(violation.max_square, v * v);
    }
    return violation;
  }

  std::vector<Violation> last_;  // of each block, in its last turn
  std::vector<int> open_;
};

}  // namespace softgrain
