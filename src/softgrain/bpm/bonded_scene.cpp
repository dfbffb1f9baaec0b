#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/bpm/primary_pressures.hpp"

namespace softgrain {

/// Outlines and grains of a box, primaries and their contacts always.
Scene BondedGrains::scene(const Box<2>& box) const {
  const auto& particles = dynamics_.particles;
  const auto& contacts = dynamics_.contacts;
  const int n = particles.size();
  std::vector<double> coordination(n, 0), force;
  std::vector<std::int64_t> pairs;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    ++coordination[a];
    if (b < n) ++coordination[b];
    pairs.insert(pairs.end(), {a, b});  // from n on: walls
    force.push_back(contacts.impulse[c][0] / impulse_time_);
  }
  Scene scene;
  scene.particles["position"] = to_array(particles.position);
  scene.particles["velocity"] = to_array(bodies().velocity);
  scene.particles["radius"] = {1, particles.radius};
  scene.particles["pressure"] = {1, primary_pressures(dynamics_, attraction_, grain_radius_, impulse_time_)};
  scene.particles["coordination"] = {1, std::move(coordination)};
  scene.contacts["pair"] = {2, std::move(pairs)};
  scene.contacts["force"] = {1, std::move(force)};
  if (!box.closed()) return scene;
  scene.particles["grain"] = {1, std::vector<std::int64_t>(particles.grain.begin(), particles.grain.end())};
  const Outlines all = outlines();
  std::vector<std::int64_t> grain_of_vertex;
  for (std::size_t g = 0; g + 1 < all.begin.size(); ++g)
    grain_of_vertex.insert(grain_of_vertex.end(), all.begin[g + 1] - all.begin[g],
                           static_cast<std::int64_t>(g));
  scene.outlines["position"] = to_array(all.vertex);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  return scene;
}

std::vector<GrainView> BondedGrains::grains() const {
  const auto& particles = dynamics_.particles;
  std::vector<GrainView> views;
  for (int i = 0; i < particles.size(); ++i) {  // the primaries of a grain lie one after the other
    if (particles.grain[i] == static_cast<int>(views.size()))
      views.push_back({.position = {.begin = particles.position[i].c.data()},
                       .velocity = {.begin = particles.velocity[i].c.data()},
                       .outline = {}});
    views.back().velocity.rows = ++views.back().position.rows;
  }
  return views;
}

}  // namespace softgrain
