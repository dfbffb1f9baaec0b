#pragma once
#include <string>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Time steps of bonded grains, from the case alone: no grain needs to be prepared.
///
/// Two of the smallest primaries, of mass m and with a0 = 2 r, bonded with F0, have the period
///   T = 2 pi sqrt(m a0 / (2 gamma F0)) [s],
/// that of a spring of stiffness |F'(a0)| = gamma F0/a0. In a box F0 = sigma_I <a0>, in the smallest grain;
/// in space sigma_I <a0>^2. Where surfaces attract (SurfaceAttraction) and that is shorter: that of the same
/// two between two grains, or of one at a wall, of stiffness |F'| = l 2 w/delta^2, in space l^2 2 w/delta^2.
double bond_period(const Case& the_case);

/// <a0> of the smallest grain [m]: the mean distance at which its primaries touch.
double mean_touching_distance(const Case& the_case);

/// sigma_I [Pa] of grains whose primaries attract each other with F0 and touch at <a0> [m] in the mean, and
/// F0 of a sigma_I: F0 = sigma_I <a0> [N/m], in space sigma_I <a0>^2 [N].
template <int Dim>
double cohesive_pressure(double F0, double a0) {
  return F0 / (Dim == 2 ? a0 : a0 * a0);
}
template <int Dim>
double attraction_with(double sigma_I, double a0) {
  return sigma_I * (Dim == 2 ? a0 : a0 * a0);
}

/// T/pi [s], beyond which central differences of that spring have no bound: a longer step is refused.
double critical_bond_step(const Case& the_case);

/// What time.step = 0 stands for [s]: the share of T that 0.25 us is for the paper's grain of 1750 primaries
/// (1/43, 7 % of the critical step), and no more than the walls need for 1 % of the radius of the smallest
/// primary.
double stable_bond_step(const Case& the_case);

/// time.step, or the stable step where that is 0 [s]. Raises UsageError where the bonds have no period.
double bonded_time_step(const Case& the_case);

/// The same; raises UsageError for one that is too long, too.
double checked_bonded_time_step(const Case& the_case);

/// "time.step ... is longer than the critical ..." for a bonded case that gives such a step, else "".
std::string bond_step_too_long(const Case& the_case);

}  // namespace softgrain
