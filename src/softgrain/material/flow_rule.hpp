#pragma once
#include <algorithm>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// How a metal flows (theory (44)): at von Mises' stress
///   Y(alpha) + viscosity dalpha/dt,  Y = yield_stress + hardening alpha + saturation (1 - exp(-rate alpha)),
/// alpha the equivalent plastic strain; perfect, linear and Voce's hardening, and Perzyna's viscosity. Or,
/// with a creep_rate, as Norton says (theory (46g)), without a yield stress: dalpha/dt = creep_rate (von
/// Mises' stress/creep_stress)^exponent.
struct FlowRule {
  double yield_stress = 0;  ///< Kirchhoff stress at first yield in uniaxial tension [Pa]
  double hardening = 0;     ///< H [Pa]
  double saturation = 0;    ///< Q [Pa]
  double rate = 0;          ///< b [-]
  double viscosity = 0;     ///< eta [Pa s]
  double creep_rate = 0;    ///< A [1/s]
  double creep_stress = 0;  ///< sigma_0 [Pa]
  double exponent = 1;      ///< n [-]

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
  /// Norton's D = creep_rate dt (q/creep_stress)^exponent, q = trial - 3 mu D.
  template <class T>
  Flow<T> flow(const T& trial, const T& alpha, double mu, double dt) const {
    if (creep_rate > 0) return creep(trial, mu, dt);
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

  /// What a point keeps of the bulk modulus, that grains which flow at such stresses do not lock, nor its J
  /// wander (docs/decisions/0038) [Pa].
  double local_bulk() const {
    constexpr double yields = 5;
    return yields * (creep_rate > 0 ? creep_stress : yield_stress);
  }

 private:
  /// With r = q/creep_stress: r + k r^n = trial/creep_stress, k = 3 mu creep_rate dt/creep_stress, by
  /// Newton's method from above, where it converges without fail: the left side is convex. A lane that has
  /// converged moves no more.
  template <class T>
  Flow<T> creep(const T& trial, double mu, double dt) const {
    constexpr int enough = 60;
    constexpr double converged = 1e-13, next_to_nothing = 1e-200;
    if (!(dt > 0)) return {};
    const T k(std::max(3.0 * mu * creep_rate * dt / creep_stress, next_to_nothing));
    const T whole = max(trial * (1.0 / creep_stress), T(1e-150));
    T r = min(whole, exp((1.0 / exponent) * log(whole / k)));  // each term alone is the whole at most
    T power = exp((exponent - 1.0) * log(r));                  // r^(n - 1)
    auto moves = r > T(0.0);
    for (int i = 0; i < enough && any(moves); ++i) {
      const T step = (r + k * r * power - whole) / (1.0 + exponent * k * power);
      r = select(moves, r - step, r);
      moves = moves & (step > converged * r);
      power = exp((exponent - 1.0) * log(r));
    }
    const T increment = creep_rate * dt * (r * power), stress = creep_stress * r;
    const T by_stress = (exponent * creep_rate * dt / creep_stress) * power;  // dD/dq
    return {.increment = increment,
            .slope = by_stress / (1.0 + 3.0 * mu * by_stress),
            .hardened = T(0.0),
            .dissipated = stress * increment,
            .potential = (exponent / (exponent + 1.0)) * stress * increment};
  }

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

/// Norton's rule; raises UsageError for numbers out of range.
inline FlowRule creep_rule(double rate, double stress, double exponent) {
  require(rate > 0 && stress > 0, "creep needs a creep_rate > 0 1/s and a creep_stress > 0 Pa, got {} and {}",
          rate, stress);
  require(exponent >= 1, "the exponent of creep must be >= 1, got {}", exponent);
  return {.creep_rate = rate, .creep_stress = stress, .exponent = exponent};
}

}  // namespace softgrain
