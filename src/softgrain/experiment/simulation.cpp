#include "softgrain/experiment/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <type_traits>

#include "softgrain/core/error.hpp"
#include "softgrain/core/shared_loop.hpp"
#include "softgrain/observe/stress.hpp"
#include "softgrain/state/archive.hpp"

namespace softgrain {
template <int Dim>
void follow_surface(const ModelOf<Dim>& model, Box<Dim>& box) {
  constexpr double above = 0.01;  // so that a wall that closes there meets no grain at first
  const std::vector<double> radius = model.radii();
  const double mean = std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
  box.walls[top_wall].point[Dim - 1] = model.extent(Dim - 1).second + above * mean;
}

template <int Dim>
SimulationOf<Dim>::SimulationOf(std::unique_ptr<ModelOf<Dim>> model, Box<Dim> box, LoadingOf<Dim> loading,
                                double dt)
    : model_(std::move(model)),
      box_(std::move(box)),
      loading_(std::move(loading)),
      initial_(model_->settings()),
      dt_(dt),
      steps_planned_(loading_.steps_planned(dt)) {
  row_.impulse.assign(box_.faces(), 0);
  apply_settings();
}

template <int Dim>
SimulationOf<Dim>::SimulationOf(const SimulationOf& other)
    : model_(other.model_->copy()),
      box_(other.box_),
      loading_(other.loading_),
      initial_(other.initial_),
      dt_(other.dt_),
      step_(other.step_),
      steps_planned_(other.steps_planned_),
      row_(other.row_) {}

template <int Dim>
void SimulationOf<Dim>::follow(WallMotion motion) {
  loading_.follow(std::move(motion));
  steps_planned_ = loading_.steps_planned(dt_);
}

template <int Dim>
StepReport SimulationOf<Dim>::step() {
  const bool over = finished();  // whoever goes on then has been told why
  const Mat<Dim> before = box_.cell.gradient();
  loading_.drive(box_, *model_, time(), dt_);
  const Mat<Dim> L = box_.cell.gradient();
  if (!(L == before)) model_->follow(L - before);
  const StepReport report = model_->step(box_, dt_);
  ++step_;
  if (box_.open_top && box_.walls[top_wall].open) follow_surface(*model_, box_);
  if (box_.cell.any()) {
    box_.shear += dt_ * L(0, 1);
    box_.moment =
        (dt_ * box_.volume()) * contact_stress(model_->contacts(), model_->centres(), box_.volume());
  }
  for (std::size_t w = 0; w < box_.faces(); ++w) row_.impulse[w] += box_.outward_impulse(w);
  row_.duration += dt_;
  loading_.after_step(box_, time(), dt_, felt_in(report));
  if (!over && model_->is_exhausted(report, box_)) loading_.end(LoadingOf<Dim>::End::exhausted);
  if (loading_.at_turning_point()) apply_settings();
  return report;
}

/// Energies take a look at every body: only where a stage asks for them.
template <int Dim>
StepFelt SimulationOf<Dim>::felt_in(const StepReport& report) {
  StepFelt felt{.overlap_mean = report.overlap_mean, .unrest = 0};
  if (!loading_.asks_for_rest()) return felt;
  gather();
  if (communicator().rank() == 0) {
    const Energies energies = this->energies();
    felt.unrest = energies.kinetic / std::abs(energies.stored);
  }
  tell_all(felt.unrest);
  return felt;
}

template <int Dim>
SolvedContactProblem SimulationOf<Dim>::step_and_catch_problem() {
  model_->catch_problem();
  step();
  return model_->caught_problem(dt_);
}

template <int Dim>
std::string SimulationOf<Dim>::early_end() const {
  return loading_.ended() == LoadingOf<Dim>::End::exhausted ? model_->exhaustion(box_) : loading_.early_end();
}

template <int Dim>
LoadingOutcome SimulationOf<Dim>::outcome() const {
  if (loading_.ended() != LoadingOf<Dim>::End::exhausted) return loading_.outcome();
  return {.completed = false,
          .shortfall = fmt::format("the path ends at a strain of {:.4g}, {}: {}", strain(), loading_.where(),
                                   early_end())};
}

template <int Dim>
Observation SimulationOf<Dim>::observe() const {
  Observation now{.step = step_,
                  .time = time(),
                  .strain = strain(),
                  .leg = loading_.number(),
                  .height = box_.height(),
                  .wall_force = row_.impulse,
                  .shear = {},
                  .packing = {},
                  .energies = energies(),
                  .numbers = {},
                  .means = {}};
  now.numbers = model_->numbers(box_, now.energies);
  for (double& force : now.wall_force) force /= row_.duration > 0 ? row_.duration : dt_;
  if (box_.cell.any()) now.shear = box_.shear;
  now.dimension = Dim;
  if (box_.closed()) {
    now.width = box_.width();
    now.face = box_.face(Dim - 1);
    now.side_face = box_.face(0);
    now.packing = packing();
  } else {
    const auto [low, high] = model_->extent(0);
    now.width = high - low;
    now.face = std::numbers::pi / 4 * now.width * now.width;
  }
  return now;
}

/// Bodies with their velocities over L x_c, at which a periodic cell carries their grains.
template <int Dim>
BodiesOf<Dim> SimulationOf<Dim>::over_cell(BodiesOf<Dim> bodies) const {
  if (!box_.cell.any()) return bodies;
  const Mat<Dim> L = box_.cell.gradient();
  const std::vector<Vec<Dim>> centre = model_->centres();
  for (std::size_t i = 0; i < bodies.velocity.size(); ++i)
    bodies.velocity[i] -= L * centre[static_cast<std::size_t>(bodies.grain[i])];
  return bodies;
}

/// In a periodic cell the energy of motion is that over L x_c; the rest is the cell's.
template <int Dim>
Energies SimulationOf<Dim>::energies() const {
  Energies energies = model_->energies();
  if (!box_.cell.any()) return energies;
  const BodiesOf<Dim> bodies = model_->bodies(), peculiar = over_cell(bodies);
  double carried = 0;
  for (std::size_t i = 0; i < bodies.mass.size(); ++i)
    carried +=
        0.5 * bodies.mass[i] *
        (dot(bodies.velocity[i], bodies.velocity[i]) - dot(peculiar.velocity[i], peculiar.velocity[i]));
  energies.kinetic -= carried;
  energies.wall_work -= carried;
  return energies;
}

template <int Dim>
PackingMeasures SimulationOf<Dim>::packing() const {
  const std::vector<double> radius = model_->radii();
  const std::vector<Vec<Dim>> centre = model_->centres();
  const std::vector<ContactPointOf<Dim>> contacts = model_->contacts();
  const OutlinesOf<Dim> outlines = model_->outlines();
  const BodiesOf<Dim> bodies = over_cell(model_->bodies());
  if constexpr (Dim == 3)
    return measure_packing(SolidPackingView{.volume = box_.volume(),
                                            .radius = radius,
                                            .surface = outlines,
                                            .centre = centre,
                                            .contacts = contacts,
                                            .mass = bodies.mass,
                                            .velocity = bodies.velocity,
                                            .density = model_->density(),
                                            .strain_rate = largest_rate()});
  else
    return measure_packing(PackingView{.width = box_.width(),
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
                                       .strain_rate = largest_rate()});
}

template <int Dim>
void SimulationOf<Dim>::begin_row() {
  std::fill(row_.impulse.begin(), row_.impulse.end(), 0.0);
  row_.duration = 0;
  model_->begin_row();
}

/// The largest of the strain rates of all axes, and of shear [1/s], by which inertia is measured.
template <int Dim>
double SimulationOf<Dim>::largest_rate() const {
  double largest = box_.cell.any() ? std::abs(box_.cell.gradient()(0, 1)) : 0;
  for (int axis = 0; axis < Dim; ++axis) largest = std::max(largest, std::abs(box_.strain_rate(axis)));
  return largest;
}

template <int Dim>
void SimulationOf<Dim>::visit(StateVisitor& visit) {
  model_->visit(visit);
  box_.visit(visit);
  loading_.visit(visit);
  visit({"row_impulse", "N s/m", Owner::wall, Role::sum, "outwards, since the last row"}, row_.impulse);
  visit({"row_duration", "s", Owner::run, Role::sum, "since the last row"}, row_.duration);
}

template <int Dim>
Checkpoint SimulationOf<Dim>::checkpoint() const {
  StateWriter writer;
  const_cast<SimulationOf*>(this)->visit(writer);  // a writer changes nothing
  return {.step = step_, .time = time(), .arrays = std::move(writer.arrays)};
}

template <int Dim>
void SimulationOf<Dim>::restore(const Checkpoint& checkpoint) {
  StateReader reader(checkpoint.arrays);
  loading_.visit(reader);
  apply_settings();
  visit(reader);
  model_->go_on(box_);
  steps_planned_ = loading_.steps_planned(dt_);
  step_ = checkpoint.step;
}

template <int Dim>
void SimulationOf<Dim>::begin_from(const Checkpoint& checkpoint) {
  StateReader reader(checkpoint.arrays);
  model_->visit(reader);
  box_.visit(reader);
  model_->go_on(box_);
  loading_.begin_at(reader, box_);
  steps_planned_ = loading_.steps_planned(dt_);
  begin_row();
}

template void follow_surface<2>(const ModelOf<2>&, Box<2>&);
template void follow_surface<3>(const ModelOf<3>&, Box<3>&);
template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace softgrain
