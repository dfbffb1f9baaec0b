#pragma once
#include <concepts>

#include "softgrain/math/tensor.hpp"
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// What a law (theory (36)) answers about one deformation gradient F = dx/dX, in two dimensions plane strain,
/// or about eight of them when T is Wide:
///   energy    psi [J/m^3 of undeformed material], 0 at F = 1
///   stress    P = dpsi/dF [Pa], first Piola-Kirchhoff, tension positive
///   tangent   dP_iJ/dF_kL [Pa] at row i Dim + J, column k Dim + L; symmetric
template <class L, int Dim, class T>
concept RespondsTo = requires(const L& law, const Mat<Dim, T>& F) {
  { law.energy(F) } -> std::same_as<T>;
  { law.stress(F) } -> std::same_as<Mat<Dim, T>>;
  { law.tangent(F) } -> std::same_as<Mat<Dim * Dim, T>>;
};

/// A law of one material point without history: parameters, and pure functions of F, which mean something
/// where det F > 0. wave_speed(density [kg/m^3]) [m/s] is that of pressure waves in the unstrained material;
/// objective says that psi(Q F) = psi(F) for every rotation Q, as it must be in a grain that turns.
template <class L, int Dim>
concept ElasticLaw = RespondsTo<L, Dim, double> && RespondsTo<L, Dim, Wide> &&
    requires(const L& law, double density) {
  { law.wave_speed(density) } -> std::same_as<double>;
  { L::objective } -> std::convertible_to<bool>;
};

/// An elastic law that comes apart as psi(F) = deviatoric().energy(F) + volume().energy(theta(F)), with theta
/// one of the measures in dilatation.hpp, so that a cell may take its volume change from the mean theta of
/// its points (mean dilatation, theory (43), against locking; the tangent stays symmetric). The first part
/// keeps some stiffness against volume change, of the order of mu; what grows without bound towards nu = 1/2
/// is all in the second.
template <class L, int Dim>
concept SplitLaw = ElasticLaw<L, Dim> && requires(const L& law, const Mat<Dim>& F, double J) {
  { law.deviatoric() } -> ElasticLaw<Dim>;
  { law.volume().energy(J) } -> std::same_as<double>;             // U [J/m^3]
  { law.volume().derivative(J) } -> std::same_as<double>;         // U' [Pa]
  { law.volume().second_derivative(J) } -> std::same_as<double>;  // U'' [Pa]
  { law.dilatation().value(F) } -> std::same_as<double>;
  { law.dilatation().gradient(F) } -> std::same_as<Mat<Dim>>;
};

/// A law with memory (VonMises is one). `L::State<Dim, T>` is an array of numbers, one for each point, owned
/// by the caller and changed once a step: every iteration of a step of dt [s] asks for energy (the
/// incremental potential), stress and tangent at F from the state at the *start* of the step, and when the
/// step is accepted advance(F, state, dt) gives the state at its end and what was dissipated [J/m^3]. A
/// rejected step so has nothing to undo. `stored` is the elastic energy as it is, without a step.
template <class L, int Dim, class T>
concept RemembersIn = requires(const L& law, const Mat<Dim, T>& F,
                               const typename L::template State<Dim, T>& state, double dt) {
  { law.energy(F, state, dt) } -> std::same_as<T>;
  { law.stress(F, state, dt) } -> std::same_as<Mat<Dim, T>>;
  { law.tangent(F, state, dt) } -> std::same_as<Mat<Dim * Dim, T>>;
  { law.advance(F, state, dt).state } -> std::convertible_to<typename L::template State<Dim, T>>;
  { law.advance(F, state, dt).dissipated } -> std::convertible_to<T>;
  { law.stored(F, state) } -> std::same_as<T>;
  { L::template undeformed<Dim, T>() } -> std::same_as<typename L::template State<Dim, T>>;
};
template <class L, int Dim>
concept HistoryLaw = RemembersIn<L, Dim, double> && RemembersIn<L, Dim, Wide> &&
    requires(const L& law, double density) {
  { law.wave_speed(density) } -> std::same_as<double>;
  { L::objective } -> std::convertible_to<bool>;
};

/// A law with memory that comes apart as SplitLaw does; what flows is all in the first part.
template <class L, int Dim>
concept SplitHistoryLaw = HistoryLaw<L, Dim> && requires(const L& law, const Mat<Dim>& F, double J) {
  { law.deviatoric() } -> HistoryLaw<Dim>;
  law.stress_and_advance(F, L::template undeformed<Dim, double>(), 0.0);  // a pair of what both say
  { law.volume().energy(J) } -> std::same_as<double>;
  { law.volume().derivative(J) } -> std::same_as<double>;
  { law.volume().second_derivative(J) } -> std::same_as<double>;
  { law.dilatation().gradient(F) } -> std::same_as<Mat<Dim>>;
};

/// Whether a law may be asked about F, lane by lane: false where a point is turned inside out, which no
/// material can be, or F has a NaN. Ask before the law, and reject the step: behind a logarithm of J <= 0
/// there are only NaN, and laws without one go on with nonsense.
template <int Dim, class T>
auto admissible(const Mat<Dim, T>& F) {
  return determinant(F) > T(0.0);
}

}  // namespace softgrain
