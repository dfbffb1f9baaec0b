#pragma once
#include <limits>
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// How fast a case is, before it runs.
struct Advice {
  double time_step = 0;  ///< dt, as the run will begin [s]
  /// The longest stable step of the scheme [s]; infinite where there is none.
  double longest_step = 0;
  /// The stress at which the case is judged [Pa]: of one grain the material's own, E, the yield stress or
  /// sigma_I = F0/<a0>; in a box the one that the loading names, else a hundredth of the material's own.
  double stress = 0;
  /// I = |d eps/dt| d sqrt(rho/p) at p = stress, with the fastest rate at the start (fastest_rate) and the
  /// mean diameter; for one grain between walls v sqrt(rho/p). Quasi-static below 1e-3; 0: nothing moves.
  double inertial_number = 0;
  /// rho c v over the yield stress, v the speed of the walls, of grains that flow: the stress of a blow with
  /// that speed. Below 0.1 the grains are pressed, from 1 on they are struck. 0 where nothing yields.
  double blow = 0;
  /// v/c, v the speed of the walls and c that of pressure waves in the grains: the strain behind a wave that
  /// the walls send out. From some tenths on grains are crushed before the next one feels it.
  double mach = 0;
  /// mpm.tolerance times E over the yield stress, of grains that flow in implicit steps: how far from balance
  /// Newton's method may leave them, by its last correction over R. 0 where nothing yields.
  double imbalance = 0;
  /// The shortest time for which walls keep a stress over L/c, in which a wave crosses the box, L its height
  /// at the start. Below least_hold walls still come in when they are judged. Infinite where none keep a
  /// stress for a time, and for rigid grains.
  double hold = std::numeric_limits<double>::infinity();

  static constexpr double least_hold = 8;  ///< docs/decisions/0073
};

/// Rate of strain [1/s] at which the inertial number is loading.inertial_number, at the stress of Advice:
///   I/(d sqrt(rho/p)), of the densest kind and the mean diameter.
double quasi_static_rate(const Case& the_case);
/// Gives a case this rate wherever it leaves a speed or a rate to the inertial number (wall_velocity or
/// shear_rate 0, Drive::quasi_static); speeds of walls are those at the height at the start. False for rigid
/// grains that no stress presses, which have no such rate: they get any.
bool set_quasi_static_speeds(Case& the_case);

/// Of a valid case.
Advice advise(const Case& the_case);

}  // namespace softgrain
