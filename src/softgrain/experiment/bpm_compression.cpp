#include "softgrain/experiment/bpm_compression.hpp"

#include <numbers>

#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/diametral_path.hpp"

namespace softgrain {
namespace {

RigidParticles<2> grain_between_plates(const Case& c, const Aggregate& aggregate) {
  std::vector<Vec<2>> position = aggregate.position;
  std::vector<double> radius = aggregate.radius, mass;
  double area = 0;  // of the disks over pi
  for (const double r : radius) area += r * r;
  const double grain_mass = c.grain.density * std::numbers::pi * c.grain.radius * c.grain.radius;
  for (const double r : radius) mass.push_back(grain_mass * r * r / area);
  for (Vec<2>& x : position) x *= c.grain.radius;
  for (double& r : radius) r *= c.grain.radius;
  const double low = -support(position, radius, {0, -1}), high = support(position, radius, {0, 1});
  std::vector<Wall<2>> walls(2);
  walls[bottom_wall] = {.point = {0, low}, .normal = {0, 1}, .velocity = {}};
  walls[top_wall] = {.point = {0, high}, .normal = {0, -1}, .velocity = {}};
  return rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), std::move(walls));
}

FrictionRule friction_rule(const Case& c) {
  const int primaries = c.bpm.primaries;
  const double inner = c.bpm.inner_friction, wall = c.contact.wall_friction;
  return [=](int, int b) { return b < primaries ? inner : wall; };
}

}  // namespace

BpmCompression::BpmCompression(const Case& c)
    : BpmCompression(c, prepare_aggregate({.primaries = c.bpm.primaries,
                                           .size_ratio = c.bpm.size_ratio,
                                           .gamma = c.bpm.exponent,
                                           .seed = static_cast<std::uint64_t>(c.sample.seed)})) {}

BpmCompression::BpmCompression(const Case& c, const Aggregate& aggregate)
    : BpmSimulation(c, std::make_unique<DiametralPath>(c.loading, c.grain.radius, bonded_time_step(c)),
                    {{.F0 = c.bpm.attraction, .gamma = c.bpm.exponent}}, grain_between_plates(c, aggregate),
                    friction_rule(c), 0.15 * aggregate.mean_distance * c.grain.radius),
      mean_distance_(aggregate.mean_distance * c.grain.radius) {}

double BpmCompression::sigma_I() const { return case_.bpm.attraction / mean_distance_; }

double BpmCompression::width() const {
  const auto& p = dynamics_.particles;
  return support(p.position, p.radius, {1, 0}) + support(p.position, p.radius, {-1, 0});
}

double BpmCompression::grain_area(int) const {
  return std::numbers::pi * case_.grain.radius * case_.grain.radius;
}

std::vector<Quantity> BpmCompression::observe() {
  const double force_bottom = wall_force(bottom_wall), force_top = wall_force(top_wall);
  std::vector<Quantity> row = row_of({
      {"width", "m", width()},
      {"stress_bottom", "Pa", force_bottom / width()},
      {"stress_top", "Pa", force_top / width()},
      {"force_bottom", "N/m", force_bottom},
      {"force_top", "N/m", force_top},
      {"sigma_I", "Pa", sigma_I()},
  });
  start_new_row();
  return row;
}

void BpmCompression::complete_scene(Scene& scene) const {
  const double reach = 1.1 * case_.grain.radius + width() / 2;
  for (const Wall<2>& wall : dynamics_.particles.walls)
    scene.wall_segments.insert(scene.wall_segments.end(), {-reach, wall.point[1], reach, wall.point[1]});
}

}  // namespace softgrain
