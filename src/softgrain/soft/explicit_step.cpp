#include "softgrain/soft/explicit_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/solid_equilibrium.hpp"

namespace softgrain {
namespace {

/// Sub-steps between two looks at the cells: fewer after a change of the stable step by more than half of
/// what it lies above the sub-step, more after one by less than an eighth of that.
constexpr int fewest_between_looks = 16, most_between_looks = 256;
constexpr double much = 0.5, little = 0.125;

/// Share of the stable step that is taken, since cells change between two looks.
constexpr double share_taken = 0.97;

/// A step that needs more sub-steps than this has crushed cells.
constexpr double most_sub_steps = 2000;

}  // namespace

template <int Dim>
ExplicitStep<Dim>::ExplicitStep(GrainsOf<Dim> soft_grains, Box<Dim> box_of_grains,
                                const ExplicitOptionsOf<Dim>& explicit_options)
    : grains(std::move(soft_grains)), box(std::move(box_of_grains)), options(explicit_options) {
  require(grains.size() > 0, "there is no grain");
  require(options.damping >= 0, "damping must be >= 0, got {} 1/s", options.damping);
  friction_by_kind();  // says what is wrong with it
  if constexpr (Dim == 2) {
    adhesion_ = {grains, options.adhesion};
    if (adheres())
      neighbours_.keep(adhesion_.range(),
                       [law = adhesion_](int kind, int other) { return law.adhere(kind, other); });
  }
  if constexpr (Dim == 3)
    for (int k = 0; k < grains.kinds(); ++k) require_solid(grains.material(k));
  smallest_radius_ = grains.radius(0);
  for (int g = 0; g < grains.size(); ++g) {
    mean_radius_ += grains.radius(g) / grains.size();
    smallest_radius_ = std::min(smallest_radius_, grains.radius(g));
    const TopologyOf<Dim>& shape = grains.topology(g);
    body_of_grain_.push_back(shape.rigid() ? static_cast<int>(bodies_.body.size()) : -1);
    if (shape.rigid()) bodies_.body.emplace_back();
    for (int i = shape.grid.outline_begin; i < shape.grid.nodes(); ++i)
      inverse_mass_.push_back(1 / (grains.material(grains.kind(g)).density * shape.node_volume[i] *
                                   grains.radius(g) * grains.radius(g) * (Dim == 3 ? grains.radius(g) : 1)));
  }
  outline_velocity_.resize(grains.outline_size());
  outline_velocity_start_.resize(grains.outline_size());
  for (auto* of_vertices : {&outline_.start, &outline_.position}) of_vertices->resize(grains.outline_size());
  if (!bodies_.body.empty())
    for (int v = 0; v < grains.outline_size(); ++v)
      bodies_.of_vertex.push_back(body_of_grain_[grains.grain_of_vertex(v)]);
  if (Dim == 3 && !bodies_.body.empty()) outline_.rolled.resize(grains.outline_size());
  batch_step_.resize(grains.batches.size());
}

template <int Dim>
SoftStepReport ExplicitStep<Dim>::step(double dt, const JointSolve<Dim>& joint) {
  SoftStepReport report{.converged = true};
  box.impulse.assign(box.walls.size(), {});
  double rest = dt;
  while (rest > 0) {
    if (stable.until_look == 0) look_at_cells(rest);
    --stable.until_look;
    const double count = sub_steps(rest);
    if (!(count <= most_sub_steps))
      throw NumericalError(
          fmt::format("cells are crushed: the stable step has fallen to {:.3g} s, {:.0f} times less than the "
                      "time step; stop at a smaller strain",
                      stable.longest, dt / stable.longest));
    sub_step(rest / count, joint, report);
    rest = count > 1 ? rest - rest / count : 0;
  }
  if (box.cell.any()) grains.know_all();  // the stress of a cell asks for centres of mass after each step
  return report;
}

template <int Dim>
double ExplicitStep<Dim>::sub_steps(double dt) const {
  return std::max(1.0, std::ceil(dt / (share_taken * stable.longest) * (1 - 1e-12)));
}

template <int Dim>
void ExplicitStep<Dim>::look_at_cells(double dt) {
  const double longest = longest_stable_step(grains, options.damping_share);
  const double change = std::abs(longest - stable.longest);
  stable.longest = std::min(longest, std::numeric_limits<double>::max());  // of rigid grains, as a number
  const double margin = longest - dt / sub_steps(dt);
  if (change > much * margin)
    stable.between_looks = std::max(fewest_between_looks, stable.between_looks / 2);
  else if (change < little * margin)
    stable.between_looks = std::min(most_between_looks, 2 * stable.between_looks);
  stable.until_look = stable.between_looks;
}

template <int Dim>
void ExplicitStep<Dim>::sub_step(double dt, const JointSolve<Dim>& joint, SoftStepReport& report) {
  for (const Press& press : box.presses) box.set_speed(press, press.speed);
  check_wall_motion(box, dt, smallest_radius_);
  damping_ = {options.damping, dt, box};
  if constexpr (Dim == 2) take_back_spin();
  find_contacts(dt);
  const SolverReport solved = kick_and_solve(dt, joint);
  outline_.walls = box.walls;
  drift_outline(dt);
  if (grains.has_history()) add_flow();
  add_adhesion();
  add_contact_work(dt);

  ++report.iterations;
  report.sweeps += solved.sweeps;
  report.residual_mean = std::max(report.residual_mean, solved.residual_mean);
  report.residual = std::max(report.residual, solved.residual_max);
  report.converged = report.converged && solved.converged;
  report.contacts =
      static_cast<int>(std::count_if(impulse.begin(), impulse.end(), [](auto& p) { return p[0] != 0; }));
  add_overlaps(report);
}

/// Where the outlines are, and where they would be after dt without forces.
template <int Dim>
void ExplicitStep<Dim>::fly_outline(double dt) {
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    const BatchOf<Dim>& batch = grains.batches[b];
    grains.for_each_vertex(batch, [&](int v, int i, int lane) {
      outline_velocity_start_[v] = lane_of(batch.velocity[i], lane);
      outline_velocity_[v] = outline_velocity_start_[v];
      outline_.start[v] = lane_of(batch.position[i], lane);
      outline_.position[v] = outline_.start[v] + dt * outline_velocity_[v];
    });
    if (batch.topology->rigid()) fly_rigid(dt, batch);
  });
}

/// v_free = v + dt M^-1 (f_ext - f_int), and within the grains, where v_free = v+, x+ = x + dt v+.
template <int Dim>
void ExplicitStep<Dim>::kick(double dt) {
  std::vector<int> inverted(grains.batches.size(), -1);
  const auto kick_elastic = [&](int b) {
    thread_local WidePlaces<Dim> force;  // of this batch only: it stays in the processor's cache
    BatchOf<Dim>& batch = grains.batches[b];
    if (batch.topology->rigid()) return;
    if (options.damping_share > 0)
      for (std::size_t i = 0; i < batch.position.size(); ++i)
        batch.position[i] += Wide(options.damping_share * dt) * batch.velocity[i];
    const unsigned lanes = internal_force_and_history(grains, batch, force, dt, batch_step_[b].flow);
    inverted[b] = batch.grain_in(lanes);
    if (inverted[b] >= 0) return;
    kick_batch(dt, force, batch, batch_step_[b]);
    grains.for_each_vertex(
        batch, [&](int v, int i, int lane) { outline_velocity_[v] = lane_of(batch.velocity[i], lane); });
  };
  const int batches = static_cast<int>(grains.batches.size());
  shared_for(grains.shares, batches, kick_elastic, [&](int b, Message& message) {
    message(inverted[b]);
    pass_kicked(b, message);
  });
  if (grains.has_rigid())
    parallel_for(batches, [&](int b) {
      if (grains.batches[b].topology->rigid()) kick_rigid(dt, grains.batches[b], batch_step_[b]);
    });
  for (const int grain : inverted)
    if (grain >= 0)
      throw NumericalError(
          fmt::format("a material point of grain {} is turned inside out; use a smaller time step", grain));
}

/// What contacts and the end of the step need of the grains of a batch.
template <int Dim>
void ExplicitStep<Dim>::pass_kicked(int b, Message& message) {
  BatchOf<Dim>& batch = grains.batches[b];
  if (batch.topology->rigid()) return;
  BatchStep& step = batch_step_[b];
  const auto outline = static_cast<std::size_t>(batch.topology->grid.outline_nodes());
  step.force.resize(outline), step.velocity.resize(outline);
  message(step.force), message(step.velocity);
  message(step.internal), message(step.gravity), message(step.damping), message(step.flow);
  message(std::span(batch.position).last(outline));
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
    message(std::span(outline_velocity_).subspan(grains.outline_begin(batch.grain[lane]), outline));
}

template <int Dim>
Vec<Dim, Wide> ExplicitStep<Dim>::weight(const BatchOf<Dim>& batch, int node) const {
  Vec<Dim, Wide> force;
  for (int d = 0; d < Dim; ++d) force[d] = options.gravity[d] * grains.node_mass(batch, node);
  return force;
}

/// The work of a node's forces over its way [J/m in the plane].
template <int Dim>
inline void ExplicitStep<Dim>::add_work(const BatchOf<Dim>& batch, int node,
                                        const Vec<Dim, Wide>& internal_force, const Vec<Dim, Wide>& way,
                                        BatchStep& step) const {
  step.internal += dot(internal_force, way);
  if (!(options.gravity == Vec<Dim>{})) step.gravity += dot(weight(batch, node), way);
}

template <int Dim>
void ExplicitStep<Dim>::kick_batch(double dt, const WidePlaces<Dim>& force, BatchOf<Dim>& batch,
                                   BatchStep& step) const {
  const TopologyOf<Dim>& topology = *batch.topology;
  const int outline_begin = topology.grid.outline_begin;
  step.force.assign(force.begin() + outline_begin, force.end());
  step.velocity.assign(batch.velocity.begin() + outline_begin, batch.velocity.end());
  step.internal = step.gravity = step.damping = 0.0;
  const Wide scale = Wide(dt) / (grains.density(batch) * body_unit<Dim>(batch.radius));
  for (int i = 0; i < topology.grid.nodes(); ++i) {
    const Vec<Dim, Wide> v = batch.velocity[i];
    const Wide rate = scale * Wide(1 / topology.node_volume[i]);
    for (int d = 0; d < Dim; ++d) batch.velocity[i][d] += dt * options.gravity[d] - rate * force[i][d];
    if (options.damping_share > 0) batch.position[i] -= Wide(options.damping_share * dt) * v;
    const bool inside = i < outline_begin;
    if (options.damping > 0) {
      const Vec<Dim, Wide> damped = damping_.velocity_change(batch.position[i], v);
      batch.velocity[i] += damped;
      if (inside) step.damping -= grains.node_mass(batch, i) * (0.5 * dot(damped, v + batch.velocity[i]));
    }
    if (!inside) continue;
    batch.position[i] += Wide(dt) * batch.velocity[i];
    add_work(batch, i, force[i], Wide(dt / 2) * (v + batch.velocity[i]), step);
  }
}

/// x+ = x + dt v+ of a batch's outlines. The work over the step is that of a motion by dt (v+ + v)/2, in
/// which M (v+ - v) does dK.
template <int Dim>
void ExplicitStep<Dim>::drift_batch(double dt, BatchOf<Dim>& batch, BatchStep& step) const {
  grains.for_each_vertex(batch, [&](int v, int i, int lane) {
    for (int d = 0; d < Dim; ++d) batch.velocity[i][d].set(lane, outline_velocity_[v][d]);
  });
  const auto& grid = batch.topology->grid;
  for (int i = grid.outline_begin, k = 0; i < grid.nodes(); ++i, ++k) {
    const Vec<Dim, Wide> twice = step.velocity[k] + batch.velocity[i];
    if (options.damping > 0)
      step.damping -= grains.node_mass(batch, i) *
                      (0.5 * dot(damping_.velocity_change(batch.position[i], step.velocity[k]), twice));
    batch.position[i] += Wide(dt) * batch.velocity[i];
    add_work(batch, i, step.force[k], Wide(dt / 2) * twice, step);
  }
}

/// The outlines at the end of the step.
template <int Dim>
void ExplicitStep<Dim>::drift_outline(double dt) {
  parallel_for(static_cast<int>(grains.batches.size()), [&](int b) {
    BatchOf<Dim>& batch = grains.batches[b];
    BatchStep& step = batch_step_[b];
    batch.topology->rigid() ? drift_rigid(dt, batch, step) : drift_batch(dt, batch, step);
    grains.for_each_vertex(
        batch, [&](int v, int i, int lane) { outline_.position[v] = lane_of(batch.position[i], lane); });
  });
  for (std::size_t b = 0; b < grains.batches.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      work.internal += batch_step_[b].internal[lane];
      work.gravity += batch_step_[b].gravity[lane];
      work.damping += batch_step_[b].damping[lane];
    }
}

template <int Dim>
void ExplicitStep<Dim>::add_flow() {
  std::vector<FlowOfStep> flows;
  for (const BatchStep& step : batch_step_) flows.push_back(step.flow);
  last_flow = sum_of<Dim>(grains, flows);
  work.flow += last_flow.dissipated;
}

template class ExplicitStep<2>;
template class ExplicitStep<3>;

}  // namespace softgrain
