#include "softgrain/rigid/particles.hpp"

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"

namespace softgrain {

template <int Dim>
RigidParticles<Dim> rigid_particles(std::vector<Vec<Dim>> position, std::vector<double> radius,
                                    std::vector<double> mass, std::vector<Wall<Dim>> walls) {
  const std::size_t n = position.size();
  require(radius.size() == n && mass.size() == n, "{} positions need as many radii ({}) and masses ({})", n,
          radius.size(), mass.size());
  RigidParticles<Dim> particles;
  for (std::size_t i = 0; i < n; ++i) {
    require(radius[i] > 0 && mass[i] > 0, "particle {}: radius {} m and mass {} kg must be positive", i,
            radius[i], mass[i]);
    particles.inverse_mass.push_back(1 / mass[i]);
  }
  particles.position = std::move(position);
  particles.radius = std::move(radius);
  particles.mass = std::move(mass);
  particles.grain.assign(n, 0);
  particles.velocity.resize(n);
  particles.spin.resize(n + walls.size());
  for (const Wall<Dim>& wall : walls) {
    particles.velocity.push_back(wall.velocity);
    particles.inverse_mass.push_back(0);
  }
  particles.walls = std::move(walls);
  return particles;
}

template <int Dim>
void drift(RigidParticles<Dim>& particles, double dt) {
  particles.followed.for_each_range(particles.size(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) particles.position[i] += dt * particles.velocity[i];
  });
  for (Wall<Dim>& wall : particles.walls) wall.point += dt * wall.velocity;
  particles.cell.advance(dt);
}

template <int Dim>
void set_wall_velocity(RigidParticles<Dim>& particles, int wall, const Vec<Dim>& velocity) {
  particles.walls[static_cast<std::size_t>(wall)].velocity = velocity;
  particles.velocity[static_cast<std::size_t>(particles.wall_body(wall))] = velocity;
}

template <int Dim>
void set_press_speed(RigidParticles<Dim>& particles, const Press& press, double v) {
  for (std::size_t w = 0; w < particles.walls.size(); ++w)
    if (press.share[w] != 0)
      set_wall_velocity(particles, static_cast<int>(w), press.share[w] * v * particles.walls[w].normal);
}

template <int Dim>
double RigidParticles<Dim>::press_share(int body) const {
  double share = 0;
  if (body >= size())
    for (const Press& press : presses) share += press.share[static_cast<std::size_t>(body - size())];
  return share;
}

template <int Dim>
double kinetic_energy(const RigidParticles<Dim>& particles) {
  double energy = 0;
  for (std::size_t i = 0; i < particles.position.size(); ++i) {
    const double v2 = dot(particles.velocity[i], particles.velocity[i]);
    const double s2 = dot(particles.spin[i], particles.spin[i]);
    energy += 0.5 * particles.mass[i] * (v2 + s2 / particles.inertia_ratio);  // I omega^2 = m s^2 / kappa
  }
  return energy;
}

template RigidParticles<2> rigid_particles<2>(std::vector<Vec<2>>, std::vector<double>, std::vector<double>,
                                              std::vector<Wall<2>>);
template RigidParticles<3> rigid_particles<3>(std::vector<Vec<3>>, std::vector<double>, std::vector<double>,
                                              std::vector<Wall<3>>);
template void drift<2>(RigidParticles<2>&, double);
template void drift<3>(RigidParticles<3>&, double);
template void set_wall_velocity<2>(RigidParticles<2>&, int, const Vec<2>&);
template void set_wall_velocity<3>(RigidParticles<3>&, int, const Vec<3>&);
template void set_press_speed<2>(RigidParticles<2>&, const Press&, double);
template void set_press_speed<3>(RigidParticles<3>&, const Press&, double);
template double RigidParticles<2>::press_share(int) const;
template double RigidParticles<3>::press_share(int) const;
template double kinetic_energy<2>(const RigidParticles<2>&);
template double kinetic_energy<3>(const RigidParticles<3>&);

}  // namespace softgrain
