#pragma once
#include <cmath>

namespace softgrain {

/// Energies of grains, and work since the start of a run [J/m].
struct Energies {
  double kinetic = 0;
  double stored = 0;       ///< elastic energy, or the potential of the attraction
  double wall_work = 0;    ///< done by the walls
  double dissipation = 0;  ///< by contacts, friction, damping, rearrangement, and what time stepping took
  double contact = 0;      ///< of `dissipation`: in contacts between grains and with walls
  double friction = 0;     ///< of `contact`: by sliding
  /// What is missing in wall_work = change of (kinetic + stored) + dissipation, with the energy of adhesion
  /// where grains adhere (a column of its own): how far the equations of
  /// motion were not solved.
  double error = 0;
};

/// Inertial number of a packing: I = strain_rate d sqrt(rho/p) (theory (63)), the time that a grain of
/// diameter d [m] and density rho [kg/m^3] takes to move by d under the pressure p [Pa], over that of the
/// strain [1/s]. Below 1e-3 loading is quasi-static. 0 where
/// nothing presses (p <= 0): grains that nothing holds have no such time.
inline double inertial_number(double strain_rate, double diameter, double density, double pressure) {
  if (!(pressure > 0)) return 0;
  return std::abs(strain_rate) * diameter * std::sqrt(density / pressure);
}

}  // namespace softgrain
