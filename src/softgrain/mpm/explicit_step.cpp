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

namespace softgrain {
namespace {

/// Contacts are looked for up to this gap at the end of the free flight, in units of a segment of the
/// outline: the impulses of a stable step move a vertex by a few hundredths of it.
constexpr double contact_margin = 0.1;

/// Contacts that a thread takes at once.
constexpr int contacts_at_once = 256;

Vec<2> lane_of(const Vec<2, Wide>& v, int lane) { return {v[0][lane], v[1][lane]}; }

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
  for (auto* of_vertices :
       {&outline_velocity_, &outline_velocity_start_, &outline_.start, &outline_.position})
    of_vertices->resize(grains.outline_size());
  batch_step_.resize(grains.batches.size());
}

SoftStepReport ExplicitDynamics::step(double dt) {
  // contacts where x + dt v will be
  fly_outline(dt);
  for (Wall<2>& wall : walls) wall.point += dt * wall.velocity;
  outline_.walls = walls;
  outline_.dt = dt;
  std::vector<OutlineContact> found = neighbours_.detect(grains, outline_, contact_margin);
  impulse = carried_impulses(grains, contacts, impulse, found);
  contacts = std::move(found);

  LumpedContacts system(contacts, outline_, outline_velocity_, inverse_mass_, lumped_scratch_);
  kick(dt);
  std::vector<double> friction;
  for (const OutlineContact& c : contacts)
    friction.push_back(c.wall >= 0 ? options.wall_friction : options.friction);
  system.apply_impulses(impulse);
  SolverOptions solver = options.solver;
  solver.velocity_scale = mean_radius_ / dt;
  const SolverReport solved = solve_nlgs<2>(system, std::span(impulse), friction, solver);
  impulse_time = dt;
  drift_outline(dt);

  SoftStepReport report{.iterations = 1, .sweeps = solved.sweeps, .converged = solved.converged};
  for (const Vec<2>& p : impulse) report.contacts += p[0] != 0;
  report.penetration_max = penetration_max();
  add_contact_work(dt);
  return report;
}

/// Where the outlines are, and where they would be after dt without forces.
void ExplicitDynamics::fly_outline(double dt) {
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    grains.for_each_vertex(batch, [&](int v, int i, int lane) {
      outline_velocity_[v] = outline_velocity_start_[v] = lane_of(batch.velocity[i], lane);
      outline_.start[v] = lane_of(batch.position[i], lane);
      outline_.position[v] = outline_.start[v] + dt * outline_velocity_[v];
    });
  });
}

/// v_free = v + dt M^-1 (f_ext - f_int), and within the grains, where v_free = v+, x+ = x + dt v+.
void ExplicitDynamics::kick(double dt) {
  std::vector<int> inverted(grains.batches.size(), -1);
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    thread_local WideVectors force;  // of this batch only: it stays in the processor's cache
    GrainBatch& batch = grains.batches[b];
    if (options.damping_time > 0)
      for (std::size_t i = 0; i < batch.position.size(); ++i)
        batch.position[i] += Wide(options.damping_time) * batch.velocity[i];
    inverted[b] = batch.grain_in(internal_force(grains, batch, force));
    if (inverted[b] >= 0) return;
    kick_batch(dt, force, batch, batch_step_[b]);
    grains.for_each_vertex(
        batch, [&](int v, int i, int lane) { outline_velocity_[v] = lane_of(batch.velocity[i], lane); });
  });
  for (const int grain : inverted)
    if (grain >= 0)
      throw NumericalError(
          fmt::format("a material point of grain {} is turned inside out; use a smaller time step", grain));
}

Vec<2, Wide> ExplicitDynamics::weight(const GrainBatch& batch, int node) const {
  const Wide mass = grains.node_mass(batch, node);
  return {options.gravity[0] * mass, options.gravity[1] * mass};
}

void ExplicitDynamics::kick_batch(double dt, const WideVectors& force, GrainBatch& batch,
                                  BatchStep& step) const {
  const Topology& topology = *batch.topology;
  const int outline_begin = topology.grid.outline_begin;
  step.force.assign(force.begin() + outline_begin, force.end());
  step.velocity.assign(batch.velocity.begin() + outline_begin, batch.velocity.end());
  step.internal = step.gravity = 0.0;
  const Wide scale = Wide(dt) / (grains.density * (batch.radius * batch.radius));
  for (int i = 0; i < topology.grid.nodes(); ++i) {
    const Vec<2, Wide> v = batch.velocity[i];
    const Wide rate = scale * Wide(1 / topology.node_volume[i]);
    for (int d = 0; d < 2; ++d) batch.velocity[i][d] += dt * options.gravity[d] - rate * force[i][d];
    batch.position[i] -= Wide(options.damping_time) * v;
    if (i >= outline_begin) continue;
    batch.position[i] += Wide(dt) * batch.velocity[i];
    step.add_work(force[i], weight(batch, i), Wide(dt / 2) * (v + batch.velocity[i]));
  }
}

/// x+ = x + dt v+ of the outlines. The work over the step is that of a motion by dt (v+ + v)/2, in which
/// M (v+ - v) does dK.
void ExplicitDynamics::drift_outline(double dt) {
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    GrainBatch& batch = grains.batches[b];
    BatchStep& step = batch_step_[b];
    grains.for_each_vertex(batch, [&](int v, int i, int lane) {
      for (int d = 0; d < 2; ++d) batch.velocity[i][d].set(lane, outline_velocity_[v][d]);
    });
    const ReferenceGrid& grid = batch.topology->grid;
    for (int i = grid.outline_begin, k = 0; i < grid.nodes(); ++i, ++k) {
      batch.position[i] += Wide(dt) * batch.velocity[i];
      step.add_work(step.force[k], weight(batch, i), Wide(dt / 2) * (step.velocity[k] + batch.velocity[i]));
    }
    grains.for_each_vertex(
        batch, [&](int v, int i, int lane) { outline_.position[v] = lane_of(batch.position[i], lane); });
  });
  for (std::size_t b = 0; b < grains.batches.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      work.internal += batch_step_[b].internal[lane];
      work.gravity += batch_step_[b].gravity[lane];
    }
}

/// Of the contacts that carry impulse, over the smallest radius.
double ExplicitDynamics::penetration_max() const {
  const int count = static_cast<int>(contacts.size());
  std::vector<double> deepest((count + contacts_at_once - 1) / contacts_at_once, 0.0);
  parallel_for(static_cast<int>(deepest.size()), [&](int k) {
    for (int c = k * contacts_at_once; c < std::min(count, (k + 1) * contacts_at_once); ++c)
      if (impulse[c][0] != 0) deepest[k] = std::max(deepest[k], -gap_now(contacts[c], outline_));
  });
  return deepest.empty() ? 0 : *std::ranges::max_element(deepest) / smallest_radius_;
}

void ExplicitDynamics::add_contact_work(double dt) {
  for (std::size_t v = 0; v < outline_velocity_.size(); ++v)  // moved by (v+ + v)/2 dt
    outline_.position[v] = outline_.start[v] + dt / 2 * (outline_velocity_[v] + outline_velocity_start_[v]);
  wall_impulse_.assign(walls.size(), {});
  softgrain::add_contact_work(contacts, impulse, outline_, work, wall_impulse_);
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
