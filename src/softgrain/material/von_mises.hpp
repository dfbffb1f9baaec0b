#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/flow_rule.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_flow.hpp"
#include "softgrain/material/space_flow.hpp"
#include "softgrain/material/volumetric.hpp"

namespace softgrain {

/// Hencky's law with von Mises' plasticity (theory (44)-(46)): F = F_e F_p, the elastic part answers as
/// Hencky, and flows at constant volume where von Mises' stress of Kirchhoff's tau would exceed what the rule
/// allows. The logarithmic strain makes the return to the yield surface that of small strain.
struct VonMises {
  static constexpr bool objective = true;
  double bulk = 0;  ///< K = lambda + 2/3 mu [Pa]
  double mu = 0;    ///< shear modulus [Pa]
  FlowRule rule;

  /// What a point remembers of its flow: C_p^-1 in the plane (11, 22, 12), or F_p^-1 in space row by row, and
  /// last the equivalent plastic strain alpha.
  template <int Dim, class T>
  using State = std::array<T, Dim == 2 ? 4 : 10>;
  template <int Dim, class T>
  static State<Dim, T> undeformed() {
    if constexpr (Dim == 2)
      return {1.0, 1.0, 0.0, 0.0};
    else
      return {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  }
  template <class State>
  static const auto& plastic_strain(const State& state) {
    return state.back();
  }

  /// Incremental potential [J/m^3 of the undeformed material] of a step of dt [s]: elastic energy at its end
  /// plus the plastic work of the step.
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F, const State<Dim, T>& state, double dt) const {
    const auto step = flow(F, state, dt);
    return step.stored + step.flow.potential;
  }
  /// First Piola-Kirchhoff stress P [Pa], the derivative of the incremental potential.
  template <class T>
  [[gnu::always_inline]] Mat<2, T> stress(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const PlaneStep<T> step = flow(F, state, dt);
    return stress_of(step.trial, respond(step.trial, bulk, step.dW, step.ddW));
  }
  /// Algorithmic tangent dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L); symmetric.
  template <class T>
  [[gnu::always_inline]] Mat<4, T> tangent(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const PlaneStep<T> step = flow(F, state, dt);
    return tangent_of(step.trial, respond(step.trial, bulk, step.dW, step.ddW));
  }
  /// The state after a step that ends at F, and what the step dissipated.
  template <int Dim, class T>
  struct Advanced {
    State<Dim, T> state;
    T dissipated;  ///< [J/m^3]
  };
  template <class T>
  Advanced<2, T> advance(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    return advanced(flow(F, state, dt), state);
  }
  /// stress and advance at once, for the cost of one: both begin with the same trial.
  template <class T>
  std::pair<Mat<2, T>, Advanced<2, T>> stress_and_advance(const Mat<2, T>& F, const State<2, T>& state,
                                                          double dt) const {
    const PlaneStep<T> step = flow(F, state, dt);
    return {stress_of(step.trial, respond(step.trial, bulk, step.dW, step.ddW)), advanced(step, state)};
  }
  /// Elastic energy [J/m^3] of a point at F with this state, as it is.
  template <int Dim, class T>
  T stored(const Mat<Dim, T>& F, const State<Dim, T>& state) const {
    const auto step = trial(F, state);
    return 0.5 * bulk * step.log_J * step.log_J + mu * step.square();
  }
  /// Kirchhoff's stress across the plane [Pa].
  template <class T>
  T stress_across(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const PlaneStep<T> step = flow(F, state, dt);
    return bulk * step.trial.log_J - 4.0 * step.dW * step.trial.d;
  }

  /// In space: by the principal stretches of F_e.
  template <class T>
  [[gnu::always_inline]] Mat<3, T> stress(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    const SpaceStep<T> step = flow(F, state, dt);
    return stress_of(step.trial, bulk, mu * step.share);
  }
  template <class T>
  Mat<9, T> tangent(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    const SpaceStep<T> step = flow(F, state, dt);
    const T turn = 1.0 - step.share - 3.0 * mu * step.flow.slope;
    return tangent_of(step.trial, bulk, mu * step.share, mu * turn);
  }
  template <class T>
  Advanced<3, T> advance(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    return advanced(flow(F, state, dt), state);
  }
  template <class T>
  std::pair<Mat<3, T>, Advanced<3, T>> stress_and_advance(const Mat<3, T>& F, const State<3, T>& state,
                                                          double dt) const {
    const SpaceStep<T> step = flow(F, state, dt);
    return {stress_of(step.trial, bulk, mu * step.share), advanced(step, state)};
  }

  /// As it answers before anything flows.
  VonMises without_flow() const {
    constexpr double never = 1e200;
    return {bulk, mu, {.yield_stress = never}};
  }

  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{bulk - 2.0 / 3.0 * mu, mu}.wave_speed(density); }

  /// For mean dilatation: a cell that flows would lock if its points kept more of the bulk modulus than some
  /// yield stresses, and with less than that they would wander (docs/decisions/0038). Never more than what
  /// Hencky's law keeps.
  VonMises deviatoric() const { return {local_bulk(), mu, rule}; }
  LogVolume volume() const { return {bulk - local_bulk()}; }
  Determinant dilatation() const { return {}; }

 private:
  static constexpr double root_two_thirds = 0.81649658092772603, root_six = 2.44948974278317810;

  double local_bulk() const { return std::min(bulk, std::min(rule.local_bulk(), 2.0 / 3.0 * mu)); }

  template <class T>
  struct PlaneStep {
    PlaneTrial<T> trial;
    FlowRule::Flow<T> flow;
    T share;    ///< e' = share e'_trial
    T dW, ddW;  ///< of the potential, by u = |e'_trial|^2 [Pa]
    T stored;
  };
  template <class T>
  [[gnu::always_inline]] static Advanced<2, T> advanced(const PlaneStep<T>& step, const State<2, T>& state) {
    const Vec<3, T> G = flowed(step.trial, step.share);
    const auto flows = step.flow.increment > T(0.0);
    return {{select(flows, G[0], state[0]), select(flows, G[1], state[1]), select(flows, G[2], state[2]),
             state[3] + step.flow.increment},
            step.flow.dissipated};
  }
  template <class T>
  struct SpaceStep {
    SpaceTrial<T> trial;
    FlowRule::Flow<T> flow;
    T share;
    T stored;
  };
  template <class T>
  static Advanced<3, T> advanced(const SpaceStep<T>& step, const State<3, T>& state) {
    const auto flows = step.flow.increment > T(0.0);
    Advanced<3, T> after{state, step.flow.dissipated};
    if (!any(flows)) return after;
    const Mat<3, T> G = flowed(step.trial, step.share);
    for (std::size_t k = 0; k < 9; ++k) after.state[k] = select(flows, G.c[k], state[k]);
    after.state.back() = state.back() + step.flow.increment;
    return after;
  }

  template <class T>
  [[gnu::always_inline]] static PlaneTrial<T> trial(const Mat<2, T>& F, const State<2, T>& state) {
    return plane_trial(F, Vec<3, T>{{state[0], state[1], state[2]}});
  }
  template <class T>
  static SpaceTrial<T> trial(const Mat<3, T>& F, const State<3, T>& state) {
    Mat<3, T> G;
    std::copy(state.begin(), state.begin() + 9, G.c.begin());
    return space_trial(F, G);
  }

  /// share, flow and energy of a trial, in the plane or in space.
  template <class Step, class T>
  [[gnu::always_inline]] void flow_back(Step& step, const T& alpha, double dt) const {
    const T u = step.trial.square(), size = max(sqrt(u), T(1e-150));  // not zero: it divides
    step.flow = rule.flow(root_six * mu * size, alpha, mu, dt);
    step.share = 1.0 - step.flow.increment / (root_two_thirds * size);
    step.stored = 0.5 * bulk * step.trial.log_J * step.trial.log_J + mu * step.share * step.share * u;
  }
  template <class T>
  [[gnu::always_inline]] PlaneStep<T> flow(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    PlaneStep<T> step{.trial = trial(F, state), .flow = {}, .share = {}, .dW = {}, .ddW = {}, .stored = {}};
    flow_back(step, state[3], dt);
    // W' = mu share; W'' = mu dshare/du. It stands before differences of derivatives of u that are of the
    // size of u but known to 1e-16: with less than this floor what creeps hardly strained has an indefinite
    // tangent
    constexpr double least_square = 1e-12;
    const T u = max(step.trial.square(), T(least_square));
    step.dW = mu * step.share;
    step.ddW = (0.5 * mu) * (1.0 - step.share - 3.0 * mu * step.flow.slope) / u;
    return step;
  }
  template <class T>
  [[gnu::always_inline]] SpaceStep<T> flow(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    SpaceStep<T> step{.trial = trial(F, state), .flow = {}, .share = {}, .stored = {}};
    flow_back(step, state[9], dt);
    return step;
  }
};

/// From Young's modulus E [Pa], Poisson's ratio nu and the rule; UsageError as lame(E, nu) and flow_rule.
inline VonMises von_mises(double E, double nu, const FlowRule& rule) {
  const Lame elastic = lame(E, nu);
  return {elastic.lambda + 2.0 / 3.0 * elastic.mu, elastic.mu, flow_rule(rule)};
}

}  // namespace softgrain
