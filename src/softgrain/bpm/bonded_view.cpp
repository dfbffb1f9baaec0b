#include "softgrain/bpm/bonded_view.hpp"

#include <numeric>

#include "softgrain/observe/outlines.hpp"

namespace softgrain {

std::vector<ContactPoint> contact_points(const RigidDynamics<2>& dynamics, double impulse_time) {
  const auto& particles = dynamics.particles;
  const auto& contacts = dynamics.contacts;
  const int n = particles.size();
  std::vector<ContactPoint> points;
  for (int c = 0; c < contacts.size(); ++c) {
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    const bool wall = b >= n;
    if (!(contacts.impulse[c][0] > 0) || (!wall && particles.grain[a] == particles.grain[b])) continue;
    const Vec<2>& normal = contacts.normal[c];
    const Vec<2> impulse = contacts.impulse[c][0] * normal + contacts.impulse[c][1] * perpendicular(normal);
    points.push_back({.a = particles.grain[a],
                      .b = wall ? wall_index(b - n) : particles.grain[b],
                      .force = (1 / impulse_time) * impulse,
                      .normal = normal,
                      .position = particles.position[a] + particles.radius[a] * normal,
                      // a row of touching primaries: each takes its diameter of the outline
                      .length = particles.radius[a] + particles.radius[wall ? a : b],
                      .image = contacts.shift(c)});
  }
  return points;
}

Outlines outlines_of(const RigidDynamics<2>& dynamics) {
  const auto& particles = dynamics.particles;
  Outlines all{.vertex = {}, .begin = {0}, .area = 0};
  for (const GrainRange& grain : dynamics.reference.grains) {
    const auto first = static_cast<std::size_t>(grain.begin), count = grain.end - first;
    const auto x = std::span(particles.position).subspan(first, count);
    const auto radius = std::span(particles.radius).subspan(first, count);
    // the probe is a primary of mean size
    const double probe = std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(count);
    const std::vector<Vec<2>> outline = disk_outline(x, radius, probe);
    all.vertex.insert(all.vertex.end(), outline.begin(), outline.end());
    all.begin.push_back(static_cast<int>(all.vertex.size()));
  }
  all.area = total_area(all.vertex, all.begin);
  return all;
}

}  // namespace softgrain
