#include "softgrain/mpm/explicit_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/mpm/contact_work.hpp"
#include "softgrain/mpm/equilibrium.hpp"
#include "softgrain/mpm/lumped_contacts.hpp"

namespace softgrain {
namespace {

/// Contacts are looked for up to this gap at the end of the free flight, in units of a segment of the
/// outline: the impulses of a stable step move a vertex by a few hundredths of it.
constexpr double contact_margin = 0.1;

}  // namespace

ExplicitDynamics::ExplicitDynamics(SoftGrains soft_grains, std::vector<Wall<2>> plates,
                                   const ExplicitOptions& explicit_options)
    : grains(std::move(soft_grains)), walls(std::move(plates)), options(explicit_options) {
  require(grains.size() > 0, "there is no grain");
  require(options.friction >= 0 && options.wall_friction >= 0, "friction must be >= 0, got {} and {}",
          options.friction, options.wall_friction);
  smallest_radius_ = grains.radius(0);
  for (int g = 0; g < grains.size(); ++g) {
    mean_radius_ += grains.radius(g) / grains.size();
    smallest_radius_ = std::min(smallest_radius_, grains.radius(g));
    const Topology& shape = grains.topology(g);
    for (int i = shape.grid.outline_begin; i < shape.grid.nodes(); ++i)
      inverse_mass_.push_back(1 /
                              (grains.density * shape.node_volume[i] * grains.radius(g) * grains.radius(g)));
  }
  outline_velocity_.resize(grains.outline_size());
  force_.resize(grains.batches.size());
  velocity_start_.resize(grains.batches.size());
}

SoftStepReport ExplicitDynamics::step(double dt) {
  // contacts where x + dt v will be
  grains.gather_outline(outline_.start);
  read_outline();
  velocity_start_outline_ = outline_velocity_;
  outline_.position = outline_.start;
  for (std::size_t v = 0; v < outline_velocity_.size(); ++v)
    outline_.position[v] += dt * outline_velocity_[v];
  for (Wall<2>& wall : walls) wall.point += dt * wall.velocity;
  outline_.walls = walls;
  outline_.dt = dt;
  std::vector<OutlineContact> found = neighbours_.detect(grains, outline_, contact_margin);
  impulse = carried_impulses(grains, contacts, impulse, found);
  contacts = std::move(found);

  LumpedContacts system(contacts, walls, outline_velocity_, inverse_mass_, dt);
  kick(dt);
  read_outline();
  std::vector<double> friction;
  for (const OutlineContact& c : contacts)
    friction.push_back(c.wall >= 0 ? options.wall_friction : options.friction);
  for (int c = 0; c < system.size(); ++c)
    if (impulse[c][0] > 0) system.apply_impulse(c, impulse[c]);
  SolverOptions solver = options.solver;
  solver.velocity_scale = mean_radius_ / dt;
  const SolverReport solved = solve_nlgs<2>(system, std::span(impulse), friction, solver);
  impulse_time = dt;
  write_outline();
  drift(dt);
  grains.gather_outline(outline_.position);
  add_contact_work(dt);

  SoftStepReport report{.iterations = 1, .sweeps = solved.sweeps, .converged = solved.converged};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (impulse[c][0] == 0) continue;  // open
    ++report.contacts;
    report.penetration_max =
        std::max(report.penetration_max, -gap_now(contacts[c], outline_) / smallest_radius_);
  }
  return report;
}

/// v_free = v + dt M^-1 (f_ext - f_int)
void ExplicitDynamics::kick(double dt) {
  std::vector<int> inverted(grains.batches.size(), -1);
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    GrainBatch& batch = grains.batches[b];
    if (options.damping_time > 0)
      for (std::size_t i = 0; i < batch.position.size(); ++i)
        batch.position[i] += Wide(options.damping_time) * batch.velocity[i];
    inverted[b] = batch.grain_in(internal_force(grains, batch, force_[b]));
    velocity_start_[b] = batch.velocity;
    const Wide scale = Wide(dt) / (grains.density * (batch.radius * batch.radius));
    for (std::size_t i = 0; i < batch.position.size(); ++i) {
      if (options.damping_time > 0) batch.position[i] -= Wide(options.damping_time) * batch.velocity[i];
      const Wide rate = scale * Wide(1 / batch.topology->node_volume[i]);
      for (int d = 0; d < 2; ++d) batch.velocity[i][d] += dt * options.gravity[d] - rate * force_[b][i][d];
    }
  });
  for (const int grain : inverted)
    if (grain >= 0)
      throw NumericalError(
          fmt::format("a material point of grain {} is turned inside out; use a smaller time step", grain));
}

/// x+ = x + dt v+, and the work over the step, in which M (v+ - v) does (v+ + v)/2 . M (v+ - v) = dK.
void ExplicitDynamics::drift(double dt) {
  std::vector<Wide> internal(grains.batches.size(), 0.0), gravity(grains.batches.size(), 0.0);
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    GrainBatch& batch = grains.batches[b];
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      batch.position[i] += Wide(dt) * batch.velocity[i];
      const Vec<2, Wide> moved = Wide(dt / 2) * (batch.velocity[i] + velocity_start_[b][i]);
      internal[b] += dot(force_[b][i], moved);
      gravity[b] +=
          grains.node_mass(batch, i) * (options.gravity[0] * moved[0] + options.gravity[1] * moved[1]);
    }
  });
  for (std::size_t b = 0; b < internal.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      work.internal += internal[b][lane];
      work.gravity += gravity[b][lane];
    }
}

void ExplicitDynamics::add_contact_work(double dt) {
  OutlineState mean = outline_;  // moved by (v+ + v)/2 dt
  for (std::size_t v = 0; v < outline_velocity_.size(); ++v)
    mean.position[v] = mean.start[v] + dt / 2 * (outline_velocity_[v] + velocity_start_outline_[v]);
  wall_impulse_.assign(walls.size(), {});
  softgrain::add_contact_work(contacts, impulse, mean, work, wall_impulse_);
}

/// Velocities of the outlines out of the lanes, and back.
void ExplicitDynamics::read_outline() {
  for (const GrainBatch& batch : grains.batches) {
    const ReferenceGrid& grid = batch.topology->grid;
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      for (int i = grid.outline_begin; i < grid.nodes(); ++i)
        outline_velocity_[grains.outline_begin(batch.grain[lane]) + i - grid.outline_begin] = {
            batch.velocity[i][0][lane], batch.velocity[i][1][lane]};
  }
}
void ExplicitDynamics::write_outline() {
  for (GrainBatch& batch : grains.batches) {
    const ReferenceGrid& grid = batch.topology->grid;
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      for (int i = grid.outline_begin; i < grid.nodes(); ++i)
        for (int d = 0; d < 2; ++d)
          batch.velocity[i][d].set(
              lane, outline_velocity_[grains.outline_begin(batch.grain[lane]) + i - grid.outline_begin][d]);
  }
}

double stable_time_step(const SoftGrains& grains, double safety) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int g = 0; g < grains.size(); ++g) {
    const ReferenceGrid& grid = grains.topology(g).grid;
    for (const auto& cell : grid.cell)
      for (int a = 0; a < 4; ++a)
        shortest =
            std::min(shortest, grains.radius(g) * norm(grid.node[cell[a]] - grid.node[cell[(a + 1) % 4]]));
  }
  const double speed =
      std::visit([&](const auto& law) { return law.wave_speed(grains.density); }, grains.law);
  return safety * shortest / speed;
}

}  // namespace softgrain
