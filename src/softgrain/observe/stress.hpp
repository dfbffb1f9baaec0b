#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"
#include "softgrain/observe/contact_network.hpp"

namespace softgrain {

/// A force between two bodies: the force of a on b [N/m, N in space], and the branches from the centres to
/// the point where it acts [m].
template <int Dim>
struct BranchForceOf {
  int a = 0, b = 0;  ///< indices of particles; -1 for a body whose stress is not asked for (a wall)
  Vec<Dim> force;    ///< on b; -force acts on a
  Vec<Dim> branch_a, branch_b;
};
using BranchForce = BranchForceOf<2>;

/// Pressure of each particle from the virial of its forces (Love-Weber), compression positive:
///   p_i = -(1/2 A_i) sum_c f_c . l_c  [Pa], with f_c the force on i and l_c from its centre to where the
///   force acts; in space over 3 V_i.
std::vector<double> virial_pressure(std::span<const BranchForce> forces, std::span<const double> area);
std::vector<double> virial_pressure(std::span<const BranchForceOf<3>> forces, std::span<const double> volume);

/// Stress of a packing in a box of the given area [m^2] (Love-Weber, theory (62)), compression positive:
///   sigma = (1/V) sum_c f_c (x) l_c  [Pa],
/// with f_c the force of a on b and l_c from the centre [m] of grain a to that of grain b (of its image
/// across the edge of a periodic cell), or to the point of contact with a wall. At rest it is the stress on
/// the walls.
Mat<2> contact_stress(std::span<const ContactPoint> contacts, std::span<const Vec<2>> centre, double area);
Mat<3> contact_stress(std::span<const ContactPointOf<3>> contacts, std::span<const Vec<3>> centre,
                      double volume);

/// Stress of the motion [Pa], compression positive: (1/V) sum m (v - v_mean) (x) (v - v_mean), for any bodies
/// with masses [kg/m] and velocities [m/s].
Mat<2> kinetic_stress(std::span<const double> mass, std::span<const Vec<2>> velocity, double area);
Mat<3> kinetic_stress(std::span<const double> mass, std::span<const Vec<3>> velocity, double volume);

}  // namespace softgrain
