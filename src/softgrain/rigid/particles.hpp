#pragma once
#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/periodic_cell.hpp"
#include "softgrain/geometry/press.hpp"
#include "softgrain/geometry/wall.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Components of a rotation: 1 in the plane, 3 in space.
template <int Dim>
inline constexpr int spin_size = Dim == 2 ? 1 : 3;

template <int Dim>
using Spin = Vec<spin_size<Dim>>;

/// The particles whose motion this process follows: all, or with ranks those of its grains, begin .. end - 1,
/// and others that may touch other grains or walls.
struct Followed {
  int begin = 0, end = std::numeric_limits<int>::max();
  std::vector<int> others{};

  /// work(begin, end) for ranges that make them up, of n particles.
  template <class Work>
  void for_each_range(int n, const Work& work) const {
    parallel_ranges(std::min(end, n) - begin, [&](int b, int e) { work(begin + b, begin + e); });
    for (const int i : others) work(i, i + 1);
  }
};

/// Rigid disks (Dim = 2, per metre of depth) or spheres (Dim = 3), then the walls, in one array of bodies.
///
/// Bodies 0 .. size() - 1 are particles; body size() + w is wall w, of infinite mass (inverse_mass = 0), so
/// that a contact needs no question about what it touches. The spin is s = R omega [m/s], the speed of the
/// surface: with it no radius enters the contact equations (theory (12)).
template <int Dim>
struct RigidParticles {
  std::vector<Vec<Dim>> position;    ///< (n) [m]
  std::vector<double> radius;        ///< (n) [m]
  std::vector<double> mass;          ///< (n) [kg/m in 2D, kg in 3D]
  std::vector<int> grain;            ///< (n) that a particle belongs to; those of one lie one after the other
  std::vector<Vec<Dim>> velocity;    ///< (n + walls) [m/s]
  std::vector<Spin<Dim>> spin;       ///< (n + walls) s = R omega [m/s]
  std::vector<double> inverse_mass;  ///< (n + walls) [1/kg], 0 for walls
  double inertia_ratio = Dim == 2 ? 2.0 : 2.5;  ///< kappa = m R^2 / I: 2 for disks, 5/2 for spheres
  std::vector<Wall<Dim>> walls;
  std::vector<Press> presses;  ///< that move some of the walls
  PeriodicCell<Dim> cell;      ///< that repeats them
  Followed followed;           ///< positions, velocities and spins of others are those of an earlier step

  int size() const { return static_cast<int>(position.size()); }
  int wall_body(int wall) const { return size() + wall; }
  /// Share of a body in the press that moves it; 0 for particles and other walls.
  double press_share(int body) const;
};

/// Particles at rest with the masses given. Raises UsageError for radii or masses that are not positive.
template <int Dim>
RigidParticles<Dim> rigid_particles(std::vector<Vec<Dim>> position, std::vector<double> radius,
                                    std::vector<double> mass, std::vector<Wall<Dim>> walls);

/// x += dt v, for the particles that are followed, walls and the cell.
template <int Dim>
void drift(RigidParticles<Dim>& particles, double dt);

/// Gives the walls of a press the velocities that belong to its speed v [m/s].
template <int Dim>
void set_press_speed(RigidParticles<Dim>& particles, const Press& press, double v);

/// Gives a wall another velocity [m/s].
template <int Dim>
void set_wall_velocity(RigidParticles<Dim>& particles, int wall, const Vec<Dim>& velocity);

/// sum 1/2 m v^2 + 1/2 I omega^2 [J/m in 2D, J in 3D].
template <int Dim>
double kinetic_energy(const RigidParticles<Dim>& particles);

}  // namespace softgrain
