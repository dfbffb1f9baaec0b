#include <algorithm>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/bpm/primary_pressures.hpp"
#include "softgrain/model/grain_contacts.hpp"

namespace softgrain {
namespace {

std::vector<std::int64_t> numbers_of(const std::vector<int>& grain) { return {grain.begin(), grain.end()}; }

/// Contacts of primaries: the pair, walls from the number of primaries on, and their normal force.
Arrays contacts_of_primaries(const RigidDynamics<2>& dynamics, double impulse_time) {
  const auto& contacts = dynamics.contacts;
  std::vector<std::int64_t> pairs;
  std::vector<double> force;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    pairs.insert(pairs.end(), {contacts.body_a[c], contacts.body_b[c]});
    force.push_back(contacts.impulse[c][0] / impulse_time);
  }
  return {{"pair", {2, std::move(pairs)}}, {"force", {1, std::move(force)}}};
}

/// How many contacts that carry impulse each primary has.
template <int Dim>
std::vector<double> coordination_of(const RigidDynamics<Dim>& dynamics) {
  const auto& contacts = dynamics.contacts;
  const int n = dynamics.particles.size();
  std::vector<double> coordination(n, 0);
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    ++coordination[contacts.body_a[c]];
    if (contacts.body_b[c] < n) ++coordination[contacts.body_b[c]];
  }
  return coordination;
}

void add_outlines(const Outlines& all, Scene& scene) {
  std::vector<std::int64_t> grain_of_vertex;
  for (std::size_t g = 0; g + 1 < all.begin.size(); ++g)
    grain_of_vertex.insert(grain_of_vertex.end(), all.begin[g + 1] - all.begin[g],
                           static_cast<std::int64_t>(g));
  scene.outlines["position"] = to_array(all.vertex);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
}

/// Quads with the mean pressure of the primaries at their corners.
void add_surfaces(const std::vector<GrainSurface>& grains, const std::vector<GrainRange>& range,
                  const std::vector<double>& pressure_of_primary, Scene& scene) {
  std::vector<Vec<3>> vertex;
  std::vector<double> pressure;
  std::vector<std::int64_t> grain_of_vertex, quads, grain_of_quad;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const auto begin = static_cast<std::int64_t>(vertex.size());
    const RoundedSurface& surface = grains[g].surface;
    vertex.insert(vertex.end(), surface.vertex.begin(), surface.vertex.end());
    grain_of_vertex.insert(grain_of_vertex.end(), surface.vertex.size(), static_cast<std::int64_t>(g));
    const auto pressure_at = [&](int corner) {
      const int i = surface.sphere[corner];
      return i < 0 ? 0 : pressure_of_primary[range[g].begin + i];
    };
    for (const auto& quad : grains[g].grid->quad) {
      double mean = 0;
      for (const int corner : quad) {
        quads.push_back(begin + corner);
        mean += pressure_at(corner) / 4;
      }
      pressure.push_back(mean);
      grain_of_quad.push_back(static_cast<std::int64_t>(g));
    }
  }
  scene.outlines["position"] = to_array(vertex);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  scene.surface["quad"] = {4, std::move(quads)};
  scene.surface["grain"] = {1, std::move(grain_of_quad)};
  scene.surface["pressure"] = {1, std::move(pressure)};
}

}  // namespace

/// Outlines and grains of a box, primaries and their contacts always. In space surfaces and contacts of
/// grains, always.
template <int Dim>
Scene BondedGrainsOf<Dim>::scene_with(const Box<Dim>& box, std::span<const BranchForceOf<Dim>> more) const {
  const auto& particles = dynamics_.particles;
  Scene scene;
  std::vector<double> pressure =
      primary_pressures(dynamics_, attraction_, adhesion_, grain_radius_, impulse_time_, more);
  scene.particles["position"] = to_array(particles.position);
  scene.particles["velocity"] = to_array(bodies().velocity);
  scene.particles["radius"] = {1, particles.radius};
  scene.particles["coordination"] = {1, coordination_of(dynamics_)};
  if constexpr (Dim == 3) {
    scene.particles["grain"] = {1, numbers_of(particles.grain)};
    add_surfaces(surfaces_of(dynamics_), dynamics_.reference.grains, pressure, scene);
    scene.contacts = grain_contacts(contacts(), static_cast<int>(grain_radius_.size()));
  } else {
    scene.contacts = contacts_of_primaries(dynamics_, impulse_time_);
    if (box.closed()) {
      scene.particles["grain"] = {1, numbers_of(particles.grain)};
      add_outlines(outlines(), scene);
    }
  }
  scene.particles["pressure"] = {1, std::move(pressure)};
  if (kinds() > 1) {
    std::vector<std::int64_t> kind;
    for (const int g : particles.grain) kind.push_back(kind_[g]);
    scene.particles["kind"] = {1, std::move(kind)};
  }
  return scene;
}

template <int Dim>
std::vector<GrainView> BondedGrainsOf<Dim>::grains() const {
  const auto& particles = dynamics_.particles;
  std::vector<GrainView> views;
  for (int i = 0; i < particles.size(); ++i) {  // the primaries of a grain lie one after the other
    if (particles.grain[i] == static_cast<int>(views.size()))
      views.push_back({.position = {.begin = particles.position[i].c.data(), .row = Dim},
                       .velocity = {.begin = particles.velocity[i].c.data(), .row = Dim},
                       .outline = {}});
    views.back().velocity.rows = ++views.back().position.rows;
  }
  return views;
}

template Scene BondedGrainsOf<2>::scene_with(const Box<2>&, std::span<const BranchForceOf<2>>) const;
template Scene BondedGrainsOf<3>::scene_with(const Box<3>&, std::span<const BranchForceOf<3>>) const;
template std::vector<GrainView> BondedGrainsOf<2>::grains() const;
template std::vector<GrainView> BondedGrainsOf<3>::grains() const;

}  // namespace softgrain
