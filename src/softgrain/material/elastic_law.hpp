#pragma once
#include <concepts>
#include <limits>

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

/// A law of one material point without history: parameters, and pure functions of F.
/// wave_speed(density [kg/m^3]) [m/s] is that of pressure waves in the unstrained material;
/// needs_positive_J says that the functions mean something only where det F > 0.
template <class L, int Dim>
concept ElasticLaw = RespondsTo<L, Dim, double> && RespondsTo<L, Dim, Wide> &&
    requires(const L& law, double density) {
  { law.wave_speed(density) } -> std::same_as<double>;
  { L::needs_positive_J } -> std::convertible_to<bool>;
};

/// An elastic law that comes apart as psi(F) = deviatoric().energy(F) + volume().energy(det F), so that a
/// cell may take its volume change from the mean J of its points (mean dilatation, theory (43), against
/// locking from nu = 0.49 on; the tangent stays symmetric). The first part keeps some stiffness against
/// volume change, of the order of mu; what grows without bound towards nu = 1/2 is all in the second.
template <class L, int Dim>
concept SplitLaw = ElasticLaw<L, Dim> && requires(const L& law, double J) {
  { law.deviatoric() } -> ElasticLaw<Dim>;
  { law.volume().energy(J) } -> std::same_as<double>;             // U [J/m^3]
  { law.volume().derivative(J) } -> std::same_as<double>;         // U' [Pa]
  { law.volume().second_derivative(J) } -> std::same_as<double>;  // U'' [Pa]
};

/// A law with memory (VonMises is one). `L::State<T>` is plain data, one per point, owned by the caller and
/// changed once a step: every iteration of a step asks for energy (incremental potential), stress and tangent
/// at F from the state at the *start* of the step, and when the step is accepted `state = law.advance(F,
/// state)`. A rejected step so has nothing to undo.
template <class L, int Dim, class T>
concept RemembersIn = requires(const L& law, const Mat<Dim, T>& F,
                               const typename L::template State<T>& state) {
  { law.energy(F, state) } -> std::same_as<T>;
  { law.stress(F, state) } -> std::same_as<Mat<Dim, T>>;
  { law.tangent(F, state) } -> std::same_as<Mat<Dim * Dim, T>>;
  { law.advance(F, state) } -> std::same_as<typename L::template State<T>>;
};
template <class L, int Dim>
concept HistoryLaw = RemembersIn<L, Dim, double> && RemembersIn<L, Dim, Wide> &&
    requires(const L& law, double density) {
  { law.wave_speed(density) } -> std::same_as<double>;
  { L::needs_positive_J } -> std::convertible_to<bool>;
};

/// Whether the law may be asked about F, lane by lane; false where F has a NaN. Ask before the law, and
/// reject the step: behind a logarithm of J <= 0 there are only NaN.
template <class L, int Dim, class T>
auto admissible(const L&, const Mat<Dim, T>& F) {
  return determinant(F) > T(L::needs_positive_J ? 0.0 : -std::numeric_limits<double>::infinity());
}

}  // namespace softgrain
