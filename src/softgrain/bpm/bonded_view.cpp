#include "softgrain/bpm/bonded_view.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "softgrain/contact/tangents.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/observe/outlines.hpp"

namespace softgrain {

namespace {

/// The primaries of a grain; the probe is one of mean size.
template <int Dim>
struct Primaries {
  Primaries(const RigidParticles<Dim>& particles, const GrainRange& grain)
      : x(std::span(particles.position).subspan(grain.begin, grain.end - grain.begin)),
        radius(std::span(particles.radius).subspan(grain.begin, grain.end - grain.begin)),
        probe(std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size())) {}

  std::span<const Vec<Dim>> x;
  std::span<const double> radius;
  double probe;
};

/// 1 for primaries that are a grain of their own, which then is rigid.
std::vector<char> lone_primaries(const std::vector<GrainRange>& grains, int primaries) {
  std::vector<char> lone(primaries, 0);
  for (const GrainRange& grain : grains)
    if (grain.end - grain.begin == 1) lone[grain.begin] = 1;
  return lone;
}

/// Of the outline that a contact takes [m]. In a row of touching primaries each takes its diameter, also on
/// what is flat, as walls and rigid grains are; two of these meet at a point.
template <int Dim>
double outline_length(const RigidParticles<Dim>& particles, const std::vector<char>& is_rigid, int a, int b) {
  const auto radius = [&](int i) {
    return i < particles.size() && is_rigid[i] == 0 ? particles.radius[i] : 0;
  };
  const double of_a = radius(a), of_b = radius(b);
  return of_a > 0 && of_b > 0 ? of_a + of_b : 2 * (of_a + of_b);
}

/// About a direction for each primary of the surface.
int cells_of_surface(std::size_t primaries) {
  return std::clamp(static_cast<int>(std::lround(1.3 * std::cbrt(primaries))), 4, 24);
}

}  // namespace

template <int Dim>
std::vector<ContactPointOf<Dim>> contact_points(const RigidDynamics<Dim>& dynamics,
                                                const SurfaceAttraction<Dim>& adhesion, double impulse_time) {
  const auto& particles = dynamics.particles;
  const auto& contacts = dynamics.contacts;
  const int n = particles.size();
  const std::vector<char> is_rigid = lone_primaries(dynamics.reference.grains, n);
  std::vector<ContactPointOf<Dim>> points;
  for (int c = 0; c < contacts.size(); ++c) {
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    const bool wall = b >= n;
    if (!wall && particles.grain[a] == particles.grain[b]) continue;
    const double pull = impulse_time > 0 ? adhesion.force(particles, contacts, c) : 0;
    const bool touches = contacts.impulse[c][0] > 0;
    if (!touches && !(pull > 0)) continue;
    const Vec<Dim>& normal = contacts.normal[c];
    const Vec<Dim> push = (1 / impulse_time) * from_local(normal, contacts.impulse[c]);
    points.push_back({.a = particles.grain[a],
                      .b = wall ? wall_index(b - n) : particles.grain[b],
                      .force = pull > 0 ? push - pull * normal : push,
                      .normal = normal,
                      .position = particles.position[a] + particles.radius[a] * normal,
                      .length = touches ? outline_length(particles, is_rigid, a, b) : 0,
                      .image = contacts.shift(c)});
  }
  return points;
}

Outlines outlines_of(const RigidDynamics<2>& dynamics) {
  Outlines all{.vertex = {}, .begin = {0}, .area = 0};
  for (const GrainRange& range : dynamics.reference.grains) {
    const Primaries<2> grain(dynamics.particles, range);
    const std::vector<Vec<2>> outline = disk_outline(grain.x, grain.radius, grain.probe);
    all.vertex.insert(all.vertex.end(), outline.begin(), outline.end());
    all.begin.push_back(static_cast<int>(all.vertex.size()));
  }
  all.area = total_area(all.vertex, all.begin);
  return all;
}

std::vector<GrainSurface> surfaces_of(const RigidDynamics<3>& dynamics) {
  std::map<int, std::shared_ptr<const DirectionGrid>> known;
  std::vector<GrainSurface> all;
  for (const GrainRange& range : dynamics.reference.grains) {
    const int cells = cells_of_surface(static_cast<std::size_t>(range.end - range.begin));
    auto& grid = known[cells];
    if (!grid) grid = std::make_shared<const DirectionGrid>(cells);
    all.push_back({.grid = grid, .surface = {}});
  }
  parallel_for(static_cast<int>(all.size()), [&](int g) {
    const Primaries<3> grain(dynamics.particles, dynamics.reference.grains[g]);
    all[g].surface = rounded_surface(grain.x, grain.radius, grain.probe, *all[g].grid);
  });
  return all;
}

std::vector<SurfaceMeasure> outlines_of(const RigidDynamics<3>& dynamics) {
  std::vector<SurfaceMeasure> measures;
  for (const GrainSurface& grain : surfaces_of(dynamics)) measures.push_back(grain.surface.measure);
  return measures;
}

template std::vector<ContactPointOf<2>> contact_points<2>(const RigidDynamics<2>&,
                                                          const SurfaceAttraction<2>&, double);
template std::vector<ContactPointOf<3>> contact_points<3>(const RigidDynamics<3>&,
                                                          const SurfaceAttraction<3>&, double);

}  // namespace softgrain
