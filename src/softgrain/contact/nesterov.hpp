#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/contact/signorini_coulomb.hpp"
#include "softgrain/contact/solver_options.hpp"

namespace softgrain {

/// Nesterov's accelerated projected gradient with gradient restart (theory (24)-(25); O'Donoghue & Candes
/// 2015), carried over to friction by De Saxce's shift s n of the velocity:
///   y = p_k + beta (p_k - p_k-1),  p_k+1 = P(y - (u(y) + s n) / (L w_c)),  s -> mu |u_t|,
/// P the projection on the Coulomb cone, w_c = trace(W_cc)/Dim the scale of a contact. L is the largest
/// curvature of W in that scale that a step has met. s is a fixed point, followed as the iteration goes, more
/// slowly whenever the violation stops falling. One product with W per iteration, since u(y) follows from
/// u(p_k) and u(p_k-1).
template <int Dim, ContactSystem<Dim> System>
class NesterovIteration {
 public:
  /// `impulse` [N s] is the start and holds the iterate ever after; the velocities of `system` must include
  /// it, always.
  NesterovIteration(System& system, std::span<Vec<Dim>> impulse, std::span<const double> friction)
      : system_(system),
        p_(impulse),
        friction_(friction),
        p_before_(impulse.size()),
        u_(impulse.size()),
        u_before_(impulse.size()),
        u_y_(impulse.size()),
        step_(impulse.size()),
        scale_(impulse.size()),
        shift_(impulse.size()) {
    for (int c = 0; c < system.size(); ++c) {
      const Mat<Dim> W = system.delassus_block(c);
      for (int k = 0; k < Dim; ++k) scale_[c] += W(k, k) / Dim;
      u_[c] = system.relative_velocity(c);
      shift_[c] = de_saxce_velocity(u_[c], friction[c])[0] - u_[c][0];
    }
    best_ = violation().sum_of_squares;
  }

  /// One iteration: moves `impulse` and the system.
  void advance() {
    const double next = (1 + std::sqrt(1 + 4 * momentum_ * momentum_)) / 2;
    const bool uphill = move_impulses((momentum_ - 1) / next) > 0;
    momentum_ = next;
    const double curvature = update_velocities();
    const bool too_long = curvature > curvature_;
    if (too_long) curvature_ = 1.05 * curvature;
    if (uphill || too_long) forget_momentum();
    if (++iterations_ % 100 == 0) adapt_shift_rate();
  }

  Violation violation() const {
    Violation violation;
    for (int c = 0; c < system_.size(); ++c) {
      const Mat<Dim> W = system_.delassus_block(c);
      const Vec<Dim> solved = solve_signorini_coulomb(W, u_[c] - W * p_[c], friction_[c]);
      violation.add(W * (solved - p_[c]), solved[0]);
    }
    return violation;
  }

 private:
  /// p <- P(y - (u(y) + s n) / (L w_c)); returns (y - p_new).D (p_new - p), D = diag(w_c): > 0 is uphill.
  double move_impulses(double beta) {
    double ascent = 0;
    for (int c = 0; c < system_.size(); ++c) {
      if (scale_[c] <= 0) continue;
      const Vec<Dim> y = p_[c] + beta * (p_[c] - p_before_[c]);
      u_y_[c] = u_[c] + beta * (u_[c] - u_before_[c]);
      const double slip = de_saxce_velocity(u_y_[c], friction_[c])[0] - u_y_[c][0];
      shift_[c] += shift_rate_ * (slip - shift_[c]);
      Vec<Dim> gradient = u_y_[c];
      gradient[0] += shift_[c];
      const Vec<Dim> next =
          project_on_coulomb_cone(y - (1 / (curvature_ * scale_[c])) * gradient, friction_[c]);
      step_[c] = next - y;
      const Vec<Dim> dp = next - p_[c];
      ascent -= scale_[c] * dot(step_[c], dp);
      system_.apply_impulse(c, dp);
      p_before_[c] = p_[c];
      p_[c] = next;
    }
    return ascent;
  }

  /// u <- u(p); returns the curvature of W along the step p - y, in the scale of D.
  double update_velocities() {
    double work = 0, length = 0;
    for (int c = 0; c < system_.size(); ++c) {
      u_before_[c] = u_[c];
      u_[c] = system_.relative_velocity(c);
      work += dot(step_[c], u_[c] - u_y_[c]);
      length += scale_[c] * dot(step_[c], step_[c]);
    }
    return length > 0 ? work / length : 0;
  }

  void forget_momentum() {
    momentum_ = 1;
    std::copy(p_.begin(), p_.end(), p_before_.begin());
    u_before_ = u_;
  }

  void adapt_shift_rate() {
    const double now = violation().sum_of_squares;
    shift_rate_ = now < best_ ? std::min(1.0, 1.1 * shift_rate_) : std::max(0.01, 0.7 * shift_rate_);
    best_ = std::min(best_, now);
  }

  System& system_;
  std::span<Vec<Dim>> p_;
  std::span<const double> friction_;
  std::vector<Vec<Dim>> p_before_, u_, u_before_;
  std::vector<Vec<Dim>> u_y_, step_;  // velocity at y, and p_k+1 - y
  std::vector<double> scale_, shift_;
  double curvature_ = 1;  // L
  double momentum_ = 1, shift_rate_ = 1, best_ = 0;
  int iterations_ = 0;
};

}  // namespace softgrain
