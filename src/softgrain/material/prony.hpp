#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_flow.hpp"
#include "softgrain/material/space_flow.hpp"
#include "softgrain/material/volumetric.hpp"

namespace softgrain {

/// What a step does to a dashpot, x the step over its time of relaxation (theory (46d)): a strain rate that
/// is steady over the step is followed exactly, so rest and steady flow are exact at any step.
struct Decay {
  explicit Decay(double x) {
    const double left = exp(Wide(-x))[0];  // not libm's: the same bits on every machine
    mean = mean_of(x, left);
    rest = left / mean;
    at_end = 1 / mean_of(2 * x, left * left) - 1;
    at_start = 2 * x - at_end;
  }
  double rest;      ///< e <- rest e before the step's strain comes, rest mean = exp(-x)
  double mean;      ///< and e <- mean e after it: (1 - exp(-x))/x
  double at_start;  ///< the step dissipates mu (at_start |e|^2 at its start + at_end |e|^2 at its end)
  double at_end;

 private:
  /// (1 - left)/x, left = exp(-x).
  static double mean_of(double x, double left) {
    constexpr double small = 0.05;
    if (x > small) return (1 - left) / x;
    double sum = 1;
    for (int k = 9; k > 1; --k) sum = 1 - x / k * sum;
    return sum;
  }
};

/// Viscoelastic solid (theory (46b)-(46d)), a generalised Maxwell model of finite strain: Hencky's law of the
/// moduli at once, of whose shear modulus the shares g_i relax with the times tau_i (Prony's series). Each
/// branch has a spring and a dashpot, F = F_e F_v, with Hencky's energy mu g_i |e'|^2 in the spring and the
/// flow e'/tau_i in the dashpot; pressure does not relax. In plane strain, or in space.
struct Prony {
  static constexpr bool objective = true;
  static constexpr int most_branches = 4;
  double bulk = 0;                          ///< K = lambda + 2/3 mu [Pa]
  double mu = 0;                            ///< shear modulus at once [Pa]
  int branches = 0;                         ///< so many of the following
  std::array<double, most_branches> g{};    ///< shares of mu
  std::array<double, most_branches> tau{};  ///< [s]

  /// What a point remembers: U in C = U^T U at the end of the last step (11, 22, 12), and C_v^-1 of each
  /// branch in the plane (11, 22, 12); in space F then, and F_v^-1 of each branch, row by row.
  template <int Dim, class T>
  using State = std::array<T, (Dim == 2 ? 3 : 9) * (1 + most_branches)>;
  template <int Dim, class T>
  static State<Dim, T> undeformed() {
    State<Dim, T> state{};
    if constexpr (Dim == 2)
      for (std::size_t k = 0; k < state.size(); k += 3) state[k] = state[k + 1] = T(1.0);
    else
      for (std::size_t k = 0; k < state.size(); k += 9) state[k] = state[k + 4] = state[k + 8] = T(1.0);
    return state;
  }
  /// Nothing yields.
  template <class T, std::size_t N>
  static T plastic_strain(const std::array<T, N>&) {
    return T(0.0);
  }

  /// Incremental potential [J/m^3 of the undeformed material] of a step of dt [s].
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F, const State<Dim, T>& state, double dt) const {
    const auto whole = elastic(F);
    T energy = 0.5 * bulk * whole.log_J * whole.log_J + lasting() * whole.square();
    for (int k = 0; k < branches; ++k) {
      const auto step = branch(F, state, k, dt);
      energy += mu * g[at(k)] * step.decay.mean * step.trial.square();
    }
    return energy;
  }
  /// First Piola-Kirchhoff stress P [Pa], the derivative of the incremental potential.
  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F, const State<Dim, T>& state, double dt) const {
    Mat<Dim, T> P = stress_at(elastic(F), bulk, T(lasting()));
    for (int k = 0; k < branches; ++k) P += stress_of(branch(F, state, k, dt), k);
    return P;
  }
  /// Algorithmic tangent dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L); symmetric.
  template <class T>
  Mat<4, T> tangent(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const PlaneTrial<T> whole = elastic(F);
    Mat<4, T> A = tangent_of(whole, respond(whole, bulk, T(lasting()), T(0.0)));
    for (int k = 0; k < branches; ++k) {
      const auto step = branch(F, state, k, dt);
      A += tangent_of(step.trial, respond(step.trial, 0, T(mu * g[at(k)] * step.decay.mean), T(0.0)));
    }
    return A;
  }
  template <class T>
  Mat<9, T> tangent(const Mat<3, T>& F, const State<3, T>& state, double dt) const {
    Mat<9, T> A = tangent_of(elastic(F), bulk, T(lasting()), T(0.0));
    for (int k = 0; k < branches; ++k) {
      const auto step = branch(F, state, k, dt);
      A += tangent_of(step.trial, 0, T(mu * g[at(k)] * step.decay.mean), T(0.0));
    }
    return A;
  }
  /// The state after a step that ends at F, and what the step dissipated.
  template <int Dim, class T>
  struct Advanced {
    State<Dim, T> state;
    T dissipated;  ///< [J/m^3]
  };
  template <int Dim, class T>
  Advanced<Dim, T> advance(const Mat<Dim, T>& F, const State<Dim, T>& state, double dt) const {
    Advanced<Dim, T> after = moved(F, state);
    if (dt > 0)
      for (int k = 0; k < branches; ++k) relax(branch(F, state, k, dt), k, after);
    return after;
  }
  /// stress and advance at once: both begin with the same trial.
  template <int Dim, class T>
  std::pair<Mat<Dim, T>, Advanced<Dim, T>> stress_and_advance(const Mat<Dim, T>& F,
                                                              const State<Dim, T>& state, double dt) const {
    std::pair<Mat<Dim, T>, Advanced<Dim, T>> both{stress_at(elastic(F), bulk, T(lasting())), moved(F, state)};
    for (int k = 0; k < branches; ++k) {
      const auto step = branch(F, state, k, dt);
      both.first += stress_of(step, k);
      if (dt > 0) relax(step, k, both.second);
    }
    return both;
  }
  /// Elastic energy [J/m^3] of a point at F with this state, as it is.
  template <int Dim, class T>
  T stored(const Mat<Dim, T>& F, const State<Dim, T>& state) const {
    return energy(F, state, 0);
  }
  /// Kirchhoff's stress across the plane [Pa].
  template <class T>
  T stress_across(const Mat<2, T>& F, const State<2, T>& state, double dt) const {
    const PlaneTrial<T> whole = elastic(F);
    T across = bulk * whole.log_J - 4.0 * lasting() * whole.d;
    for (int k = 0; k < branches; ++k) {
      const auto step = branch(F, state, k, dt);
      across -= 4.0 * mu * g[at(k)] * step.decay.mean * step.trial.d;
    }
    return across;
  }

  /// As it answers before anything relaxes: it does so within no time.
  const Prony& without_flow() const { return *this; }

  /// Speed of pressure waves [m/s] in the unstrained material, before anything relaxes.
  double wave_speed(double density) const { return Lame{bulk - 2.0 / 3.0 * mu, mu}.wave_speed(density); }

  /// For mean dilatation: the points keep of the bulk modulus what Hencky's law keeps, of the modulus that
  /// lasts, or of a tenth of mu where less lasts.
  Prony deviatoric() const {
    Prony part = *this;
    part.bulk = local_bulk();
    return part;
  }
  LogVolume volume() const { return {bulk - local_bulk()}; }
  Determinant dilatation() const { return {}; }

  /// Shear modulus after a long time [Pa].
  double lasting() const {
    double share = 1;
    for (int k = 0; k < branches; ++k) share -= g[at(k)];
    return share * mu;
  }

 private:
  static constexpr std::size_t at(int branch) { return static_cast<std::size_t>(branch); }

  double local_bulk() const { return std::min(bulk, 2.0 / 3.0 * std::max(lasting(), 0.1 * mu)); }

  template <class T>
  static PlaneTrial<T> elastic(const Mat<2, T>& F) {
    return plane_trial(F, Vec<3, T>{{T(1.0), T(1.0), T(0.0)}});
  }
  template <class T>
  static SpaceTrial<T> elastic(const Mat<3, T>& F) {
    return space_trial(F, identity<3, T>());
  }
  /// P of tau' = 2 shear e' and the pressure of `bulk_part`.
  template <class T>
  static Mat<2, T> stress_at(const PlaneTrial<T>& e, double bulk_part, const T& shear) {
    return softgrain::stress_of(e, respond(e, bulk_part, shear, T(0.0)));
  }
  template <class T>
  static Mat<3, T> stress_at(const SpaceTrial<T>& e, double bulk_part, const T& shear) {
    return softgrain::stress_of(e, bulk_part, shear);
  }

  /// A spring at F, its dashpot at rest since it relaxed by `decay.rest` at the F before.
  template <class Trial, class T>
  struct Branch {
    Decay decay;
    T before;  ///< |e'|^2 at the start of the step
    Trial trial;
  };
  template <class T>
  Branch<PlaneTrial<T>, T> branch(const Mat<2, T>& F, const State<2, T>& state, int k, double dt) const {
    const T* of_branch = &state[3 + 3 * at(k)];
    Vec<3, T> G{{of_branch[0], of_branch[1], of_branch[2]}};
    const Decay decay(dt / tau[at(k)]);
    T before{};
    if (dt > 0) {
      const PlaneTrial<T> start = plane_trial(Mat<2, T>{{state[0], state[2], T(0.0), state[1]}}, G);
      before = start.square();
      G = flowed(start, T(decay.rest));
    }
    return {decay, before, plane_trial(F, G)};
  }
  template <class T>
  Branch<SpaceTrial<T>, T> branch(const Mat<3, T>& F, const State<3, T>& state, int k, double dt) const {
    const auto matrix = [&](std::size_t row) {
      Mat<3, T> m;
      std::copy_n(&state[9 * row], 9, m.c.begin());
      return m;
    };
    Mat<3, T> G = matrix(1 + at(k));
    const Decay decay(dt / tau[at(k)]);
    T before{};
    if (dt > 0) {
      const SpaceTrial<T> start = space_trial(matrix(0), G);
      before = start.square();
      G = flowed(start, T(decay.rest));
    }
    return {decay, before, space_trial(F, G)};
  }
  template <class Trial, class T>
  auto stress_of(const Branch<Trial, T>& step, int k) const {
    return stress_at(step.trial, 0, T(mu * g[at(k)] * step.decay.mean));
  }
  /// The state with C at the end of a step; the branches follow.
  template <class T>
  static Advanced<2, T> moved(const Mat<2, T>& F, const State<2, T>& state) {
    Advanced<2, T> after{state, T(0.0)};
    const T C_11 = F(0, 0) * F(0, 0) + F(1, 0) * F(1, 0), C_12 = F(0, 0) * F(0, 1) + F(1, 0) * F(1, 1);
    after.state[0] = sqrt(C_11);
    after.state[1] = determinant(F) / after.state[0];
    after.state[2] = C_12 / after.state[0];
    return after;
  }
  template <class T>
  static Advanced<3, T> moved(const Mat<3, T>& F, const State<3, T>& state) {
    Advanced<3, T> after{state, T(0.0)};
    std::copy(F.c.begin(), F.c.end(), after.state.begin());
    return after;
  }
  template <class Trial, int Dim, class T>
  void relax(const Branch<Trial, T>& step, int k, Advanced<Dim, T>& after) const {
    const Decay& decay = step.decay;
    const auto G = flowed(step.trial, T(decay.mean));
    std::copy(G.c.begin(), G.c.end(), &after.state[G.c.size() * (1 + at(k))]);
    after.dissipated +=
        mu * g[at(k)] *
        (decay.at_start * step.before + decay.at_end * decay.mean * decay.mean * step.trial.square());
  }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu at once, and the branches: shares of the shear modulus
/// and times [s] where the share is > 0. UsageError as lame(E, nu), for a share without a time or the other
/// way round, and unless something lasts.
inline Prony prony(double E, double nu, const std::array<double, Prony::most_branches>& shares,
                   const std::array<double, Prony::most_branches>& times) {
  const Lame elastic = lame(E, nu);
  Prony law{.bulk = elastic.lambda + 2.0 / 3.0 * elastic.mu, .mu = elastic.mu};
  for (std::size_t k = 0; k < shares.size(); ++k) {
    require(shares[k] >= 0 && times[k] >= 0 && (shares[k] > 0) == (times[k] > 0),
            "relaxation_share_{0} and relaxation_time_{0} belong together: both > 0, or both 0; got {1} and "
            "{2} s",
            k + 1, shares[k], times[k]);
    if (shares[k] == 0) continue;
    law.g[static_cast<std::size_t>(law.branches)] = shares[k];
    law.tau[static_cast<std::size_t>(law.branches)] = times[k];
    ++law.branches;
  }
  require(law.branches > 0, "what relaxes needs a relaxation_share_1 > 0 and a relaxation_time_1 > 0 s");
  require(law.lasting() > 0,
          "the relaxation shares must add up to less than 1: a grain of which nothing lasts is a fluid; got "
          "a sum of {}",
          1 - law.lasting() / law.mu);
  return law;
}

}  // namespace softgrain
