#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/flow_rule.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_flow.hpp"
#include "softgrain/material/principal_stretches.hpp"
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
  Mat<3, T> stress(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    return stress_of(flow(F, state, dt).response) * transpose(inverse_plastic(state));  // dpsi/dF_e F_p^-T
  }
  template <class T>
  Mat<9, T> tangent(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    const Mat<3, T> G = inverse_plastic(state);
    const Mat<9, T> A_e = tangent_of(flow(F, state, dt).response);
    // A_iJkL = (A_e)_iMkN G_JM G_LN, one index after the other.
    Mat<9, T> half, A;
    for (int row = 0; row < 9; ++row)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          for (int n = 0; n < 3; ++n) half(row, 3 * k + l) += A_e(row, 3 * k + n) * G(l, n);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int column = 0; column < 9; ++column)
          for (int m = 0; m < 3; ++m) A(3 * i + j, column) += half(3 * i + m, column) * G(j, m);
    return A;
  }
  template <class T>
  Advanced<3, T> advance(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    // F_p^-1 <- F_p^-1 exp(-gamma sum_a n_a v_a (x) v_a), gamma n = (1 - share) e'
    const SpaceStep<T> step = flow(F, state, dt);
    Mat<3, T> shrink;
    for (int a = 0; a < 3; ++a) shrink(a, a) = exp((step.share - 1.0) * step.trial.deviator[a]);
    const Mat<3, T>& v = step.response.frame.v;
    const Mat<3, T> G = inverse_plastic(state) * (v * shrink * transpose(v));
    Advanced<3, T> after{state, step.flow.dissipated};
    std::copy(G.c.begin(), G.c.end(), after.state.begin());
    after.state.back() = state.back() + step.flow.increment;
    return after;
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
  /// In space, of the trial.
  template <class T>
  struct SpaceTrial {
    PrincipalFrame<T> frame;
    Vec<3, T> e, deviator;
    T log_J;
    T square() const { return dot(deviator, deviator); }
  };
  template <class T>
  struct SpaceStep {
    SpaceTrial<T> trial;
    FlowRule::Flow<T> flow;
    T share;
    T stored;
    PrincipalResponse<T> response;
  };

  template <class T>
  static Mat<3, T> inverse_plastic(const State<3, T>& state) {
    Mat<3, T> G;
    std::copy(state.begin(), state.begin() + 9, G.c.begin());
    return G;
  }
  template <class T>
  [[gnu::always_inline]] static PlaneTrial<T> trial(const Mat<2, T>& F, const State<2, T>& state) {
    return plane_trial(F, Vec<3, T>{{state[0], state[1], state[2]}});
  }
  template <class T>
  static SpaceTrial<T> trial(const Mat<3, T>& F, const State<3, T>& state) {
    SpaceTrial<T> trial{principal_frame(F * inverse_plastic(state)), {}, {}, {}};
    for (int a = 0; a < 3; ++a) trial.e[a] = log(trial.frame.stretch[a]);
    trial.log_J = trial.e[0] + trial.e[1] + trial.e[2];
    for (int a = 0; a < 3; ++a) trial.deviator[a] = trial.e[a] - (1.0 / 3.0) * trial.log_J;
    return trial;
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
    // W' = mu share; W'' = mu dshare/du, which is round-off over u where u is next to nothing
    const T u = max(step.trial.square(), T(1e-20));
    step.dW = mu * step.share;
    step.ddW = (0.5 * mu) * (1.0 - step.share - 3.0 * mu * step.flow.slope) / u;
    return step;
  }
  template <class T>
  SpaceStep<T> flow(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    SpaceStep<T> step{.trial = trial(F, state), .flow = {}, .share = {}, .stored = {}, .response = {}};
    flow_back(step, state[9], dt);
    const SpaceTrial<T>& trial = step.trial;
    // dtau/de = bulk 1 (x) 1 + 2 mu (share dev + turn n (x) n), n = e'/|e'|
    const T turn = 1.0 - step.share - 3.0 * mu * step.flow.slope;
    const T inverse = 1.0 / max(trial.square(), T(1e-20));
    Mat<3, T> D;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        D(a, b) = bulk + 2.0 * mu *
                             (step.share * ((a == b) - 1.0 / 3.0) +
                              turn * inverse * trial.deviator[a] * trial.deviator[b]);
    step.response.frame = trial.frame;
    differentiate(step.response, trial.e, mu * step.share, (bulk - 2.0 / 3.0 * mu * step.share) * trial.log_J,
                  D);
    return step;
  }
};

/// From Young's modulus E [Pa], Poisson's ratio nu and the rule; UsageError as lame(E, nu) and flow_rule.
inline VonMises von_mises(double E, double nu, const FlowRule& rule) {
  const Lame elastic = lame(E, nu);
  return {elastic.lambda + 2.0 / 3.0 * elastic.mu, elastic.mu, flow_rule(rule)};
}

}  // namespace softgrain
