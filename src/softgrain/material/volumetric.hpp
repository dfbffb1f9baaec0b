#pragma once
#include "softgrain/math/wide.hpp"

namespace softgrain {

// Energies of volume change U(J) [J/m^3], J = det F or another measure of dilatation.hpp, with
// U(1) = U'(1) = 0. `derivative` is U' and `second_derivative` U'' [Pa]. `kirchhoff` is J U' [Pa], given ln
// J. Part of the elastic laws, and what mean dilatation evaluates at the mean J of a cell.

/// U = lambda/2 (ln J)^2: infinite at J = 0, but softer than linear for J > 1 and concave for J > e.
struct LogVolume {
  double lambda = 0;  ///< [Pa]

  template <class T>
  T energy(const T& J) const {
    const T log_J = log(J);
    return 0.5 * lambda * log_J * log_J;
  }
  template <class T>
  T derivative(const T& J) const {
    return lambda * log(J) * (1.0 / J);
  }
  template <class T>
  T kirchhoff(const T&, const T& log_J) const {
    return lambda * log_J;
  }
  template <class T>
  T second_derivative(const T& J) const {
    const T inverse_J = 1.0 / J;
    return lambda * (1.0 - log(J)) * (inverse_J * inverse_J);
  }
};

/// U = lambda/2 (J - 1)^2: no logarithm and convex, but finite at J = 0.
struct QuadraticVolume {
  double lambda = 0;  ///< [Pa]

  template <class T>
  T energy(const T& J) const {
    return 0.5 * lambda * (J - 1.0) * (J - 1.0);
  }
  template <class T>
  T derivative(const T& J) const {
    return lambda * (J - 1.0);
  }
  template <class T>
  T kirchhoff(const T& J, const T&) const {
    return lambda * (J - 1.0) * J;
  }
  template <class T>
  T second_derivative(const T&) const {
    return T(lambda);
  }
};

/// U = 0: what is left of a law when its U(J) is evaluated elsewhere.
struct NoVolume {
  static constexpr double lambda = 0;

  template <class T>
  T energy(const T&) const {
    return T(0.0);
  }
  template <class T>
  T derivative(const T&) const {
    return T(0.0);
  }
  template <class T>
  T kirchhoff(const T&, const T&) const {
    return T(0.0);
  }
  template <class T>
  T second_derivative(const T&) const {
    return T(0.0);
  }
};

}  // namespace softgrain
