#include "softgrain/bpm/primary_pressures.hpp"

#include <numbers>

#include "softgrain/observe/stress.hpp"

namespace softgrain {

std::vector<double> primary_pressures(const RigidDynamics<2>& dynamics, const AttractionForces& attraction,
                                      std::span<const double> grain_radius, double impulse_time) {
  const auto& particles = dynamics.particles;
  const auto& contacts = dynamics.contacts;
  const int n = particles.size();
  std::vector<BranchForce> forces;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    const Vec<2>& normal = contacts.normal[c];
    const Vec<2> impulse = contacts.impulse[c][0] * normal + contacts.impulse[c][1] * perpendicular(normal);
    const bool wall = b >= n;
    forces.push_back({.a = a,
                      .b = wall ? -1 : b,
                      .force = (1 / impulse_time) * impulse,
                      .branch_a = particles.radius[a] * normal,
                      .branch_b = wall ? Vec<2>{} : -particles.radius[b] * normal});
  }
  attraction.for_each_pair([&](int i, int j) {
    const Vec<2> d = particles.position[j] - particles.position[i];
    const double r = norm(d);
    const double F = attraction.law(particles.grain[i]).force(r, particles.radius[i] + particles.radius[j]);
    forces.push_back({.a = i, .b = j, .force = (-F / r) * d, .branch_a = 0.5 * d, .branch_b = -0.5 * d});
  });
  std::vector<double> squares(grain_radius.size(), 0), area(n);
  for (int i = 0; i < n; ++i) squares[particles.grain[i]] += particles.radius[i] * particles.radius[i];
  for (int i = 0; i < n; ++i) {
    const double R = grain_radius[particles.grain[i]];
    area[i] =
        std::numbers::pi * R * R * particles.radius[i] * particles.radius[i] / squares[particles.grain[i]];
  }
  return virial_pressure(forces, area);
}

}  // namespace softgrain
