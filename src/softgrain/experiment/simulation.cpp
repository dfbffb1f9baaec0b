#include "softgrain/experiment/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/state/archive.hpp"

namespace softgrain {

Simulation::Simulation(std::unique_ptr<Model> model, Box<2> box, Loading loading, double dt)
    : model_(std::move(model)),
      box_(std::move(box)),
      loading_(std::move(loading)),
      initial_(model_->settings()),
      dt_(dt),
      steps_planned_(loading_.steps_planned(dt)) {
  row_.impulse.assign(box_.walls.size(), 0);
  apply_settings();
}

Simulation::Simulation(const Simulation& other)
    : model_(other.model_->copy()),
      box_(other.box_),
      loading_(other.loading_),
      initial_(other.initial_),
      dt_(other.dt_),
      step_(other.step_),
      steps_planned_(other.steps_planned_),
      row_(other.row_) {}

void Simulation::follow(WallMotion motion) {
  loading_.follow(std::move(motion));
  steps_planned_ = loading_.steps_planned(dt_);
}

StepReport Simulation::step() {
  const bool over = finished();  // whoever goes on then has been told why
  loading_.drive(box_, *model_, time(), dt_);
  const StepReport report = model_->step(box_, dt_);
  ++step_;
  for (std::size_t w = 0; w < box_.walls.size(); ++w) row_.impulse[w] += box_.outward_impulse(w);
  row_.duration += dt_;
  loading_.after_step(box_, time(), dt_, felt_in(report));
  if (!over && model_->is_exhausted(report, box_)) loading_.end(Loading::End::exhausted);
  if (loading_.at_turning_point()) apply_settings();
  return report;
}

/// Energies take a look at every body: only where a stage asks for them.
StepFelt Simulation::felt_in(const StepReport& report) const {
  StepFelt felt{.overlap_mean = report.overlap_mean, .unrest = 0};
  if (!loading_.asks_for_rest()) return felt;
  const Energies energies = model_->energies();
  felt.unrest = energies.kinetic / std::abs(energies.stored);
  return felt;
}

SolvedContactProblem Simulation::step_and_catch_problem() {
  model_->catch_problem();
  step();
  return model_->caught_problem(dt_);
}

std::string Simulation::early_end() const {
  return loading_.ended() == Loading::End::exhausted ? model_->exhaustion(box_) : loading_.early_end();
}

LoadingOutcome Simulation::outcome() const {
  if (loading_.ended() != Loading::End::exhausted) return loading_.outcome();
  return {.completed = false,
          .shortfall = fmt::format("the path ends at a strain of {:.4g}, {}: {}", strain(), loading_.where(),
                                   early_end())};
}

Observation Simulation::observe() const {
  Observation now{.step = step_,
                  .time = time(),
                  .strain = strain(),
                  .leg = loading_.number(),
                  .height = box_.height(),
                  .wall_force = row_.impulse,
                  .packing = {},
                  .energies = model_->energies(),
                  .numbers = model_->numbers(box_),
                  .means = {}};
  for (double& force : now.wall_force) force /= row_.duration > 0 ? row_.duration : dt_;
  if (box_.closed()) {
    now.width = box_.width();
    now.packing = packing();
  } else {
    const auto [low, high] = model_->extent();
    now.width = high - low;
  }
  return now;
}

PackingMeasures Simulation::packing() const {
  const std::vector<double> radius = model_->radii();
  const std::vector<Vec<2>> centre = model_->centres();
  const std::vector<ContactPoint> contacts = model_->contacts();
  const Outlines outlines = model_->outlines();
  const Bodies bodies = model_->bodies();
  return measure_packing({.width = box_.width(),
                          .height = box_.height(),
                          .radius = radius,
                          .grain_area = outlines.area,
                          .centre = centre,
                          .outline = outlines.vertex,
                          .outline_begin = outlines.begin,
                          .contacts = contacts,
                          .mass = bodies.mass,
                          .velocity = bodies.velocity,
                          .density = model_->density(),
                          .strain_rate = box_.strain_rate(1)});
}

void Simulation::begin_row() {
  std::fill(row_.impulse.begin(), row_.impulse.end(), 0.0);
  row_.duration = 0;
  model_->begin_row();
}

Scene Simulation::scene() const {
  Scene scene = model_->scene(box_);
  const double low = box_.low(1).point[1], high = box_.high(1).point[1];
  const auto [left, right] =
      box_.bounded(0) ? std::pair(box_.low(0).point[0], box_.high(0).point[0]) : model_->reach();
  scene.wall_segments = {left, low, right, low, left, high, right, high};  // in the order of BoxWall
  if (box_.bounded(0))
    scene.wall_segments.insert(scene.wall_segments.end(), {left, low, left, high, right, low, right, high});
  return scene;
}

void Simulation::visit(StateVisitor& visit) {
  model_->visit(visit);
  box_.visit(visit);
  loading_.visit(visit);
  visit({"row_impulse", "N s/m", Owner::wall, Role::sum, "outwards, since the last row"}, row_.impulse);
  visit({"row_duration", "s", Owner::run, Role::sum, "since the last row"}, row_.duration);
}

Checkpoint Simulation::checkpoint() const {
  StateWriter writer;
  const_cast<Simulation*>(this)->visit(writer);  // a writer changes nothing
  return {.step = step_, .time = time(), .arrays = std::move(writer.arrays)};
}

void Simulation::restore(const Checkpoint& checkpoint) {
  StateReader reader(checkpoint.arrays);
  loading_.visit(reader);
  apply_settings();
  visit(reader);
  model_->go_on(box_);
  steps_planned_ = loading_.steps_planned(dt_);
  step_ = checkpoint.step;
}

void Simulation::begin_from(const Checkpoint& checkpoint) {
  StateReader reader(checkpoint.arrays);
  model_->visit(reader);
  box_.visit(reader);
  model_->go_on(box_);
  loading_.begin_at(reader, box_);
  steps_planned_ = loading_.steps_planned(dt_);
  begin_row();
}

}  // namespace softgrain
