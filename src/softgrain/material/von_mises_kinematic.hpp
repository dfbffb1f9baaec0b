#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/flow_rule.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_log_strain.hpp"
#include "softgrain/material/volumetric.hpp"

namespace softgrain {

/// VonMises with a back stress (theory (46e)-(46f)), linear kinematic hardening: what has flowed pulls back
/// as a spring of the energy H_k/3 |e_p|^2, e_p = ln sqrt(C_p), and the rule limits von Mises' stress of the
/// difference tau' - 2/3 H_k e_p. The back stress needs no memory of its own and cannot oscillate in shear,
/// since it follows from C_p. In plane strain.
struct VonMisesKinematic {
  static constexpr bool objective = true;
  double bulk = 0;       ///< K = lambda + 2/3 mu [Pa]
  double mu = 0;         ///< shear modulus [Pa]
  double kinematic = 0;  ///< H_k [Pa]
  FlowRule rule;

  /// What a point remembers: C_p^-1 in the plane (11, 22, 12) and the equivalent plastic strain alpha.
  template <int Dim, class T>
  using State = std::array<T, 4>;
  template <int Dim, class T>
  static State<Dim, T> undeformed() {
    return {T(1.0), T(1.0), T(0.0), T(0.0)};
  }
  template <class State>
  static const auto& plastic_strain(const State& state) {
    return state.back();
  }

  /// Incremental potential [J/m^3 of the undeformed material] of a step of dt [s].
  template <class T>
  T energy(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const Step<T> step = flow(F, state, dt);
    const PlaneDeviator<T> after = step.elastic(), back = step.back + step.gamma * step.normal;
    return energy_of(step.trial, after, back) + step.flow.potential;
  }
  /// First Piola-Kirchhoff stress P [Pa], the derivative of the incremental potential.
  template <class T>
  Mat<2, T> stress(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const Step<T> step = flow(F, state, dt);
    return stress_of(step.trial, respond(step.trial, bulk, derivatives(step)));
  }
  /// Algorithmic tangent dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L); symmetric.
  template <class T>
  Mat<4, T> tangent(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const Step<T> step = flow(F, state, dt);
    return tangent_of(step.trial, respond(step.trial, bulk, derivatives(step)));
  }
  /// The state after a step that ends at F, and what the step dissipated.
  template <class T>
  struct Advanced {
    State<2, T> state;
    T dissipated;  ///< [J/m^3]
  };
  template <class T>
  Advanced<T> advance(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    return advanced(flow(F, state, dt), state);
  }
  /// stress and advance at once: both begin with the same trial.
  template <class T>
  std::pair<Mat<2, T>, Advanced<T>> stress_and_advance(const Mat<2, T>& F, const State<2, T>& state,
                                                       double dt) const {
    const Step<T> step = flow(F, state, dt);
    return {stress_of(step.trial, respond(step.trial, bulk, derivatives(step))), advanced(step, state)};
  }
  /// Elastic energy [J/m^3] of a point at F with this state, that of the back stress included.
  template <class T>
  T stored(const Mat<2, T>& F, const State<2, T>& state) const {
    const PlaneLogStrain<T> trial = plane_log_strain(F, state[0], state[1], state[2]);
    return energy_of(trial, trial.e, plastic(state));
  }
  /// Kirchhoff's stress across the plane [Pa].
  template <class T>
  T stress_across(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const Step<T> step = flow(F, state, dt);
    return bulk * step.trial.log_J - 4.0 * mu * step.elastic().d;
  }

  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{bulk - 2.0 / 3.0 * mu, mu}.wave_speed(density); }

  /// For mean dilatation, as VonMises.
  VonMisesKinematic deviatoric() const { return {local_bulk(), mu, kinematic, rule}; }
  LogVolume volume() const { return {bulk - local_bulk()}; }
  Determinant dilatation() const { return {}; }

 private:
  static constexpr double root_two_thirds = 0.81649658092772603, root_three_halves = 1.22474487139158905;

  double local_bulk() const { return std::min(bulk, std::min(rule.local_bulk(), 2.0 / 3.0 * mu)); }

  template <class T>
  struct Step {
    PlaneLogStrain<T> trial;
    PlaneDeviator<T> back;    ///< e_p at the start
    PlaneDeviator<T> normal;  ///< of the flow, of length one
    T size;                   ///< |2 mu e' - 2/3 H_k e_p| of the trial [Pa]
    FlowRule::Flow<T> flow;
    T gamma;  ///< the flow of the step is gamma normal
    PlaneDeviator<T> elastic() const { return trial.e + (-1.0 * gamma) * normal; }
  };

  template <class T>
  static Advanced<T> advanced(const Step<T>& step, const State<2, T>& state) {
    const Vec<3, T> G = flowed(step.trial, step.elastic());
    const auto flows = step.flow.increment > T(0.0);
    return {{select(flows, G[0], state[0]), select(flows, G[1], state[1]), select(flows, G[2], state[2]),
             state[3] + step.flow.increment},
            step.flow.dissipated};
  }
  /// e_p = ln sqrt(C_p) = -ln sqrt(C_p^-1).
  template <class T>
  static PlaneDeviator<T> plastic(const State<2, T>& state) {
    return T(-1.0) * log_of_root(state[0], state[1], state[2]);
  }
  template <class T>
  T energy_of(const PlaneLogStrain<T>& trial, const PlaneDeviator<T>& elastic,
              const PlaneDeviator<T>& back) const {
    return 0.5 * bulk * trial.log_J * trial.log_J + mu * contract(elastic, elastic) +
           (kinematic / 3.0) * contract(back, back);
  }
  template <class T>
  Step<T> flow(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    Step<T> step{};
    step.trial = plane_log_strain(F, state[0], state[1], state[2]);
    step.back = plastic(state);
    const PlaneDeviator<T> xi = T(2.0 * mu) * step.trial.e + T(-2.0 / 3.0 * kinematic) * step.back;
    step.size = max(sqrt(contract(xi, xi)), T(1e-150));  // not zero: it divides
    step.normal = (1.0 / step.size) * xi;
    // the back stress grows by 2/3 H_k gamma: it resists the flow as 3 mu does
    step.flow = rule.flow(root_three_halves * step.size, state[3], mu + kinematic / 3.0, dt);
    step.gamma = root_three_halves * step.flow.increment;
    return step;
  }
  /// w' = 2 mu (e' - gamma n) and w'' = 2 mu (1 - beta + (beta - omega) n (x) n) without the volume,
  /// beta = 2 mu gamma/|xi|, omega = 2 mu dgamma/d|xi|... written out for d and p
  template <class T>
  PlaneLogEnergy<T> derivatives(const Step<T>& step) const {
    const PlaneDeviator<T> s = T(2.0 * mu) * step.elastic();
    const T beta = 2.0 * mu * step.gamma / step.size, turn = beta - 3.0 * mu * step.flow.slope;
    const T& n_d = step.normal.d;
    const Vec<2, T>& n = step.normal.p;
    PlaneLogEnergy<T> w;
    w.by_d = 6.0 * s.d;
    w.by_p = T(2.0) * s.p;
    w.by_dd = 12.0 * mu * (1.0 - beta + 6.0 * turn * n_d * n_d);
    for (int a = 0; a < 2; ++a) {
      w.by_dp[a] = 24.0 * mu * turn * n_d * n[a];
      for (int b = 0; b < 2; ++b)
        w.by_pp(a, b) = 4.0 * mu * (2.0 * turn * n[a] * n[b] + (a == b ? 1.0 - beta : T(0.0)));
    }
    return w;
  }
};

/// As von_mises, with H_k [Pa].
inline VonMisesKinematic von_mises_kinematic(double E, double nu, double kinematic, const FlowRule& rule) {
  const Lame elastic = lame(E, nu);
  require(kinematic >= 0, "the kinematic modulus must be >= 0 Pa, got {}", kinematic);
  return {elastic.lambda + 2.0 / 3.0 * elastic.mu, elastic.mu, kinematic, flow_rule(rule)};
}

}  // namespace softgrain
