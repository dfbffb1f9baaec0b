#pragma once
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// How a metal flows (theory (44)): at von Mises' stress
///   Y(alpha) + viscosity dalpha/dt,  Y = yield_stress + hardening alpha + saturation (1 - exp(-rate alpha)),
/// alpha the equivalent plastic strain; perfect, linear and Voce's hardening, and Perzyna's viscosity.
struct FlowRule {
  double yield_stress = 0;  ///< Kirchhoff stress at first yield in uniaxial tension [Pa]
  double hardening = 0;     ///< H [Pa]
  double saturation = 0;    ///< Q [Pa]
  double rate = 0;          ///< b [-]
  double viscosity = 0;     ///< eta [Pa s]

  template <class T>
  struct Flow {
    T increment{};   ///< of alpha in the step
    T slope{};       ///< its derivative by the trial stress [1/Pa]
    T hardened{};    ///< integral of Y over the increment [J/m^3]
    T dissipated{};  ///< the same with viscosity [J/m^3]
    T potential{};   ///< of which the stress beyond yield is the derivative [J/m^3]
  };

  /// Of a step of dt [s] that ends with von Mises' stress `trial` [Pa] if nothing flows: the increment D >= 0
  ///   trial - 3 mu D = Y(alpha + D) + viscosity D/dt
  /// where trial > Y(alpha), else 0. Without viscosity dt is nothing; with it dt = 0 leaves no time to flow.
  template <class T>
  Flow<T> flow(const T& trial, const T& alpha, double mu, double dt) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const double drag = viscosity > 0 ? (dt > 0 ? viscosity / dt : infinite) : 0.0;
    const double stiffness = 3.0 * mu + hardening + drag;
    const T to_come = saturation > 0 ? saturation * exp(-rate * alpha) : T(0.0);  // of the saturation
    const T over = max(trial - yield_stress - hardening * alpha - saturation + to_come, T(0.0));
    Flow<T> flow;
    T left = to_come;
    if (saturation > 0) {
      flow.increment = saturating(over, to_come, stiffness);
      left = to_come * exp(-rate * flow.increment);
    } else {
      flow.increment = over * (1.0 / stiffness);
    }
    const T& D = flow.increment;
    flow.slope = select(over > T(0.0), 1.0 / (stiffness + rate * left), T(0.0));
    flow.hardened = D * (yield_stress + saturation + hardening * (alpha + 0.5 * D));
    if (saturation > 0) flow.hardened -= (to_come - left) * (1.0 / rate);
    // of what is over, 3 mu D goes back, (hardening + ...) D hardens, the rest is drag
    const T drag_work =
        viscosity > 0 ? D * max(over - (3.0 * mu + hardening) * D + left - to_come, T(0.0)) : T(0.0);
    flow.dissipated = flow.hardened + drag_work;
    flow.potential = flow.hardened + 0.5 * drag_work;
    return flow;
  }

 private:
  /// D of stiffness D + to_come (1 - exp(-rate D)) = over, by Newton's method from below, where it converges
  /// without fail. A lane that has converged moves no more: lanes do not see one another.
  template <class T>
  T saturating(const T& over, const T& to_come, double stiffness) const {
    constexpr int enough = 60;
    constexpr double converged = 1e-13;  // then the next step would be at round-off
    T D = max(over / (stiffness + rate * to_come), (over - to_come) * (1.0 / stiffness));
    auto moves = D > T(0.0);
    for (int k = 0; k < enough && any(moves); ++k) {
      const T left = to_come * exp(-rate * D);
      const T step = (over - to_come + left - stiffness * D) / (stiffness + rate * left);
      D = select(moves, D + step, D);
      moves = moves & (step > converged * D);
    }
    return D;
  }
};

/// Raises UsageError for numbers that no metal has.
inline FlowRule flow_rule(const FlowRule& rule) {
  require(rule.yield_stress > 0, "a law that flows needs a yield_stress > 0 Pa, got {}", rule.yield_stress);
  require(rule.hardening >= 0, "the hardening modulus must be >= 0 Pa, got {}", rule.hardening);
  require(rule.saturation >= 0 && rule.rate >= 0 && (rule.saturation > 0) == (rule.rate > 0),
          "saturation_stress and saturation_rate belong together: both > 0, or both 0; got {} Pa and {}",
          rule.saturation, rule.rate);
  require(rule.viscosity >= 0, "the viscosity must be >= 0 Pa s, got {}", rule.viscosity);
  return rule;
}

}  // namespace softgrain
