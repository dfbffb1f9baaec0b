#pragma once
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// How fast a case is, before it runs.
struct Advice {
  double time_step = 0;  ///< dt, as the run will begin [s]
  /// The longest stable step of the scheme [s]; infinite where there is none.
  double longest_step = 0;
  /// The stress at which the case is judged [Pa]: loading.hold_stress or max_stress where one is given, else
  /// the material's own, E or sigma_I = F0/<a0>.
  double stress = 0;
  /// I = |d eps/dt| d sqrt(rho/p) at p = stress, with the rate at the start and the mean diameter; for one
  /// grain between walls v sqrt(rho/p). Loading is quasi-static below 1e-3.
  double inertial_number = 0;
  /// rho c v over the yield stress, v the speed of the walls, of grains that flow: the stress of a blow with
  /// that speed. Below 0.1 the grains are pressed, from 1 on they are struck. 0 where nothing yields.
  double blow = 0;
};

/// Of a valid case.
Advice advise(const Case& the_case);

}  // namespace softgrain
