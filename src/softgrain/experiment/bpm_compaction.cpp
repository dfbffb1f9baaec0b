#include "softgrain/experiment/bpm_compaction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/isotropic_path.hpp"
#include "softgrain/experiment/packing_row.hpp"
#include "softgrain/observe/outlines.hpp"

namespace softgrain {
namespace {

/// Beyond this mean overlap of the contacts, over the mean radius, primaries that fill at least this share of
/// the box are at their random close packing: the overlap is ten times smaller before, and grows tenfold with
/// each per cent of strain.
constexpr double close_packing_overlap = 5e-4;
constexpr double close_packing_fraction = 0.82;
constexpr double fullest_fraction = 0.95;  // no random packing of disks is as dense, overlaps included

/// sigma_I = F0/<a0> is the same in every grain.
std::vector<Attraction> laws_of(const Case& c, const BpmSample& sample) {
  std::vector<Attraction> laws;
  for (const double a0 : sample.mean_distance)
    laws.push_back({.F0 = c.bpm.cohesive_pressure * a0, .gamma = c.bpm.exponent});
  return laws;
}

FrictionRule friction_rule(const Case& c, std::vector<int> grain_of) {
  const double inner = c.bpm.inner_friction, between = c.contact.friction, wall = c.contact.wall_friction;
  return [=, grain = std::move(grain_of)](int a, int b) {
    if (b >= static_cast<int>(grain.size())) return wall;
    return grain[a] == grain[b] ? inner : between;
  };
}

/// Lists reach this share of the smallest <a0> further than the contacts: few rebuilds at 5 m/s, few idle
/// pairs.
constexpr double skin_share = 0.25;

double skin_of(const BpmSample& sample) {
  return skin_share * *std::min_element(sample.mean_distance.begin(), sample.mean_distance.end());
}

/// Mass of a sixteenth of a full box; the damper takes up the waves of a material as stiff as its bonds, ten
/// times sigma_I.
PlateBody bonded_plates(const Case& c, double height) {
  const double wave_speed = std::sqrt(10 * c.bpm.cohesive_pressure / c.grain.density);
  return {.mass = c.grain.density * height / 16,
          .damper = c.grain.density * wave_speed,
          .patience = height / wave_speed};
}

}  // namespace

BpmCompaction::BpmCompaction(const Case& c) : BpmCompaction(c, sample_box(c)) {}

BpmCompaction::BpmCompaction(const Case& c, BoxSample box)
    : BpmCompaction(c, box, fill_box(box, prepare_library(c), c)) {}

BpmCompaction::BpmCompaction(const Case& c, BoxSample box, BpmSample sample)
    : BpmSimulation(c, box_path(c, box.height, bonded_time_step(c)), laws_of(c, sample), sample.particles,
                    friction_rule(c, sample.particles.grain), skin_of(sample)),
      box_(std::move(box)),
      begin_(std::move(sample.begin)),
      displaced_(sample.displaced) {
  drive_.plates = bonded_plates(c, plate_distance());
}

void BpmCompaction::judge(const StepReport& report) {
  const double dt = case_.time.step;
  const double stress = (wall_impulse_[bottom_wall] + wall_impulse_[top_wall]) / (2 * dt * width());
  drive_.watch(stress, plate_distance(), step_);
  const double most = case_.loading.max_overlap;
  const bool close_packed =
      report.overlap_mean > close_packing_overlap && solid_fraction() > close_packing_fraction;
  if (close_packed && !finished() && solid_fraction() > fullest_fraction)
    throw NumericalError(
        fmt::format("primaries fill {:.3f} of the box, more than fits: they have passed through each other "
                    "or the walls; use a "
                    "smaller time.step or more solver.max_sweeps",
                    solid_fraction()));
  if (most > 0 && report.overlap_mean >= most)
    drive_.state.ended = WallDrive::End::max_overlap;
  else if (close_packed)
    drive_.state.ended = WallDrive::End::close_packing;
}

std::string BpmCompaction::early_end() const {
  if (drive_.state.ended != WallDrive::End::close_packing) return drive_.early_end(step_);
  return fmt::format(
      "the rigid primaries fill {:.3f} of the box, their random close packing, and overlap by more than {} "
      "of "
      "their radius in the mean: no smaller box holds them",
      solid_fraction(), close_packing_overlap);
}

PathOutcome BpmCompaction::outcome() const {
  if (drive_.state.ended != WallDrive::End::close_packing) return drive_.outcome(step_);
  return {
      .completed = false,
      .shortfall = fmt::format("the path ends at a strain of {:.4g}, before loading.max_strain {:.4g}: {}",
                               strain(), case_.loading.max_strain, early_end())};
}

double BpmCompaction::width() const {
  const auto& walls = dynamics_.particles.walls;
  return walls[right_wall].point[0] - walls[left_wall].point[0];
}

double BpmCompaction::solid_fraction() const {
  double squares = 0;
  for (const double r : dynamics_.particles.radius) squares += r * r;
  return std::numbers::pi * squares / (width() * plate_distance());
}

double BpmCompaction::grain_area(int grain) const {
  return std::numbers::pi * box_.grains[grain].radius * box_.grains[grain].radius;
}

std::vector<ContactPoint> BpmCompaction::contact_points() const {
  const auto& particles = dynamics_.particles;
  const auto& contacts = dynamics_.contacts;
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
                      .force = (1 / case_.time.step) * impulse,
                      .normal = normal,
                      .position = particles.position[a] + particles.radius[a] * normal,
                      // a row of touching primaries: each takes its diameter of the outline
                      .length = particles.radius[a] + particles.radius[wall ? a : b]});
  }
  return points;
}

std::vector<Vec<2>> BpmCompaction::outlines(std::vector<int>& begin) const {
  const auto& particles = dynamics_.particles;
  std::vector<Vec<2>> all;
  begin.assign(1, 0);
  for (std::size_t g = 0; g + 1 < begin_.size(); ++g) {
    const auto first = static_cast<std::size_t>(begin_[g]), count = begin_[g + 1] - first;
    const auto x = std::span(particles.position).subspan(first, count);
    const auto radius = std::span(particles.radius).subspan(first, count);
    // the probe is a primary of mean size
    const double probe = std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(count);
    const std::vector<Vec<2>> outline = disk_outline(x, radius, probe);
    all.insert(all.end(), outline.begin(), outline.end());
    begin.push_back(static_cast<int>(all.size()));
  }
  return all;
}

std::vector<Vec<2>> BpmCompaction::centres() const {
  const auto& particles = dynamics_.particles;
  std::vector<Vec<2>> centre(box_.grains.size());
  std::vector<double> mass(box_.grains.size(), 0);
  for (int i = 0; i < particles.size(); ++i) {
    centre[particles.grain[i]] += particles.mass[i] * particles.position[i];
    mass[particles.grain[i]] += particles.mass[i];
  }
  for (std::size_t g = 0; g < centre.size(); ++g) centre[g] *= 1 / mass[g];
  return centre;
}

std::vector<Quantity> BpmCompaction::observe() {
  const auto& particles = dynamics_.particles;
  const double height = plate_distance();
  const double side_force = (wall_force(left_wall) + wall_force(right_wall)) / 2;
  std::vector<Quantity> own{
      {"width", "m", width()},
      {"stress_bottom", "Pa", wall_force(bottom_wall) / width()},
      {"stress_top", "Pa", wall_force(top_wall) / width()},
      {"stress_side", "Pa", side_force / height},
      {"force_bottom", "N/m", wall_force(bottom_wall)},
      {"force_top", "N/m", wall_force(top_wall)},
      {"sigma_I", "Pa", case_.bpm.cohesive_pressure},
      {"solid_fraction", "", solid_fraction()},
  };
  const auto velocity_of = [&](int wall) { return particles.velocity[particles.wall_body(wall)][1]; };
  std::vector<double> radius;
  for (const PlacedGrain& grain : box_.grains) radius.push_back(grain.radius);
  const std::vector<Vec<2>> centre = centres();
  const std::vector<ContactPoint> contacts = contact_points();
  std::vector<int> begin;
  const std::vector<Vec<2>> outline = outlines(begin);
  const std::vector<Quantity> packing =
      packing_row({.width = width(),
                   .height = height,
                   .radius = radius,
                   .grain_area = total_area(outline, begin),
                   .centre = centre,
                   .outline = outline,
                   .outline_begin = begin,
                   .contacts = contacts,
                   .mass = particles.mass,
                   .velocity = std::span(particles.velocity).first(particles.position.size()),
                   .density = case_.grain.density,
                   .strain_rate = (velocity_of(top_wall) - velocity_of(bottom_wall)) / height});
  own.insert(own.end(), packing.begin(), packing.end());
  std::vector<Quantity> row = row_of(std::move(own));
  start_new_row();
  return row;
}

void BpmCompaction::complete_scene(Scene& scene) const {
  const auto& particles = dynamics_.particles;
  scene.particles["grain"] = {1, std::vector<std::int64_t>(particles.grain.begin(), particles.grain.end())};
  std::vector<int> begin;
  scene.outlines["position"] = to_array<2>(outlines(begin));
  std::vector<std::int64_t> grain_of_vertex;
  for (std::size_t g = 0; g + 1 < begin.size(); ++g)
    grain_of_vertex.insert(grain_of_vertex.end(), begin[g + 1] - begin[g], static_cast<std::int64_t>(g));
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  const double low = particles.walls[bottom_wall].point[1], high = particles.walls[top_wall].point[1];
  const double left = particles.walls[left_wall].point[0], right = particles.walls[right_wall].point[0];
  scene.wall_segments = {left, low, right, low,  left,  high, right, high,  // in the order of BoxWall
                         left, low, left,  high, right, low,  right, high};
}

}  // namespace softgrain
