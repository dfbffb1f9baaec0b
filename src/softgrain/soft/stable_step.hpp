#pragma once
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// A quick step [s]: `safety` times the smallest distance of two nodes of a cell over the wave speed of
/// its unstrained material.
double stable_time_step(const SoftGrains& grains, double safety = 0.5);

/// The longest stable step [s] of ExplicitDynamics from where the grains are now, deformed as they are:
///   dt_c = 2/(omega sqrt(1 + 2 beta)),
/// with damping over a share beta of the step. omega^2 is the largest eigenvalue of M^-1 K, which is at most
/// that of the worst cell by itself (Irons), here from above to 5 %. Cells that are not numbers are left out.
double longest_stable_step(const SoftGrains& grains, double damping_share);

}  // namespace softgrain
