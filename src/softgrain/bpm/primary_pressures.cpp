#include "softgrain/bpm/primary_pressures.hpp"

#include "softgrain/contact/tangents.hpp"
#include "softgrain/geometry/ball.hpp"

namespace softgrain {

template <int Dim>
std::vector<double> primary_pressures(const RigidDynamics<Dim>& dynamics,
                                      const AttractionForcesOf<Dim>& attraction,
                                      const SurfaceAttraction<Dim>& adhesion,
                                      std::span<const double> grain_radius, double impulse_time,
                                      std::type_identity_t<std::span<const BranchForceOf<Dim>>> more) {
  const auto& particles = dynamics.particles;
  const auto& contacts = dynamics.contacts;
  const int n = particles.size();
  const auto attracts_from = [&](int c) { return impulse_time > 0 && c >= contacts.blocks.back().begin(); };
  std::vector<BranchForceOf<Dim>> forces(more.begin(), more.end());
  for (int c = 0; c < contacts.size(); ++c) {
    const double pull = attracts_from(c) ? adhesion.force(particles, contacts, c) : 0;
    if (!(contacts.impulse[c][0] > 0) && !(pull > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    const Vec<Dim>& normal = contacts.normal[c];
    const bool wall = b >= n;
    Vec<Dim> force = (1 / impulse_time) * from_local(normal, contacts.impulse[c]);
    if (pull > 0) force -= pull * normal;
    forces.push_back({.a = a,
                      .b = wall ? -1 : b,
                      .force = force,
                      .branch_a = particles.radius[a] * normal,
                      .branch_b = wall ? Vec<Dim>{} : -particles.radius[b] * normal});
  }
  attraction.for_each_pair([&](int i, int j) {
    const Vec<Dim> d = particles.position[j] - particles.position[i];
    const double r = norm(d);
    const double F = attraction.law(particles.grain[i]).force(r, particles.radius[i] + particles.radius[j]);
    forces.push_back({.a = i, .b = j, .force = (-F / r) * d, .branch_a = 0.5 * d, .branch_b = -0.5 * d});
  });
  // the share of a primary in its grain is that of its size in all of them
  std::vector<double> filled(grain_radius.size(), 0), size(n);
  for (int i = 0; i < n; ++i) filled[particles.grain[i]] += times_power<Dim>(1, particles.radius[i]);
  for (int i = 0; i < n; ++i) {
    const int g = particles.grain[i];
    const double of_grain = times_power<Dim>(unit_ball<Dim>, grain_radius[g]);
    size[i] = times_power<Dim>(of_grain, particles.radius[i]) / filled[g];
  }
  return virial_pressure(forces, size);
}

template std::vector<double> primary_pressures<2>(const RigidDynamics<2>&, const AttractionForcesOf<2>&,
                                                  const SurfaceAttraction<2>&, std::span<const double>,
                                                  double, std::span<const BranchForceOf<2>>);
template std::vector<double> primary_pressures<3>(const RigidDynamics<3>&, const AttractionForcesOf<3>&,
                                                  const SurfaceAttraction<3>&, std::span<const double>,
                                                  double, std::span<const BranchForceOf<3>>);

}  // namespace softgrain
