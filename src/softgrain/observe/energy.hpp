#pragma once
#include <cmath>

namespace softgrain {

/// Energies since the start of a run [J/m].
struct EnergyBudget {
  double wall_work = 0;    ///< done by the walls
  double kinetic = 0;      ///< change of the kinetic energy
  double stored = 0;       ///< change of the elastic energy, or of the potential of the attraction
  double dissipation = 0;  ///< by contacts, friction and plastic flow, each counted on its own

  /// What is missing in wall_work = kinetic + stored + dissipation [J/m]: the error of the time stepping.
  double error() const { return wall_work - kinetic - stored - dissipation; }
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
