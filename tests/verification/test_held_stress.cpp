#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/stages_of_case.hpp"

using namespace softgrain;

namespace {

constexpr double stress = 1e5;

/// What side walls bear over what they are asked for, step after step.
struct Borne {
  std::vector<double> ratio;

  double mean(std::size_t begin, std::size_t end) const {
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) sum += ratio[k];
    return sum / static_cast<double>(end - begin);
  }
  /// Largest distance from 1 of the means over so many equal times.
  double worst(std::size_t times) const {
    const std::size_t steps = std::max<std::size_t>(1, ratio.size() / times);
    double worst = 0;
    for (std::size_t k = 0; k + steps <= ratio.size(); k += steps)
      worst = std::max(worst, std::abs(mean(k, k + steps) - 1));
    return worst;
  }
};

/// Carries out a stage, whose sides keep asked(time since it began) [Pa]. The force of a step is over the
/// faces as they were when it began.
template <int Dim, class Asked>
std::vector<Borne> sides_of_stage(SimulationOf<Dim>& simulation, const Asked& asked) {
  std::vector<Borne> sides(Dim - 1);
  const double start = simulation.time();
  do {
    const double began = simulation.time();
    std::vector<double> face;
    for (int axis = 0; axis < Dim - 1; ++axis) face.push_back(simulation.box().face(axis));
    simulation.step();
    const Box<Dim>& box = simulation.box();
    for (int axis = 0; axis < Dim - 1; ++axis) {
      const std::size_t wall = 2 * static_cast<std::size_t>(Dim - 1 - axis);
      const double impulse = (box.outward_impulse(wall) + box.outward_impulse(wall + 1)) / 2;
      sides[axis].ratio.push_back(impulse / (simulation.time() - began) / face[axis] /
                                  asked(simulation.time() - start));
    }
  } while (!simulation.finished() && !simulation.at_turning_point());
  return sides;
}

template <int Dim>
void finish_stage(SimulationOf<Dim>& simulation) {
  do simulation.step();
  while (!simulation.at_turning_point());
}

Case packing(GrainModel model, Integrator integrator, int grains) {
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = model};
  c.mpm.integrator = integrator;
  c.mpm.material = {.young_modulus = 1e7, .poisson_ratio = 0.45};
  c.mpm.cells = 4;
  c.bpm.primaries = 30;
  c.contact.friction = 0.3;
  c.contact.wall_friction = 0;
  c.sample.grains = grains;
  c.sample.seed = 2;
  c.sample.packing_fraction = 0.7;
  return c;
}

Drive moves(Part part, double velocity) {
  return {.part = part, .control = Control::velocity, .value = velocity};
}
Drive keeps(Part part, double value) { return {.part = part, .control = Control::stress, .value = value}; }

/// Walls come in to the stress, keep it, and then top and bottom come in while the sides keep it.
void confine_and_compress(Case& c, double closing, double hold, double velocity, double time) {
  c.loading.wall_velocity = velocity;
  Stage confine{.drives = {moves(Part::yy, closing), moves(Part::xx, closing)}};
  confine.until.stress[number_of(Part::yy)] = stress;
  Stage keep{.drives = {keeps(Part::yy, stress), keeps(Part::xx, stress)}, .until = {.time = hold}};
  Stage compress{.drives = {moves(Part::yy, velocity), keeps(Part::xx, stress)}, .until = {.time = time}};
  if (c.experiment.dimension == 3) {
    confine.drives.push_back(moves(Part::xy, closing));
    keep.drives.push_back(keeps(Part::xy, stress));
    compress.drives.push_back(keeps(Part::xy, stress));
  }
  c.stages = {confine, keep, compress};
}

double constant(double /*time*/) { return stress; }

/// Of all wall work, what the account of energy of a run leaves open.
template <int Dim>
double energy_error(const SimulationOf<Dim>& simulation) {
  const Energies energies = simulation.model().energies();
  return std::abs(energies.error / energies.wall_work);
}

/// The third stage of a case bears its stress within 1 % in the mean and 5 % in the worst of 200 times.
template <int Dim>
void check_kept(SimulationOf<Dim>& simulation) {
  finish_stage(simulation);
  finish_stage(simulation);
  for (const Borne& side : sides_of_stage(simulation, constant)) {
    const std::size_t all = side.ratio.size();
    CHECK(std::abs(side.mean(all / 2, all) - 1) < 0.01);
    CHECK(side.worst(200) < 0.05);
  }
}

}  // namespace

TEST_CASE("side walls bear what they are asked for while explicit elastic grains between them rearrange") {
  Case c = packing(GrainModel::mpm, Integrator::symplectic_euler, 9);
  confine_and_compress(c, 0.5, 1e-3, 0.1, 4e-3);
  const auto simulation = create_simulation(c);
  check_kept(*simulation);
  CHECK(energy_error(*simulation) < 1e-9);
}

TEST_CASE("side walls bear what they are asked for while bonded grains between them rearrange") {
  Case c = packing(GrainModel::bpm, Integrator::symplectic_euler, 12);
  confine_and_compress(c, 0.5, 1e-3, 0.5, 2e-3);
  const auto simulation = create_simulation(c);
  check_kept(*simulation);
  CHECK(energy_error(*simulation) < 1e-4);
}

TEST_CASE(
    "side walls give way to grains that snap off rough walls, and bear no more than they are asked for") {
  Case c = packing(GrainModel::mpm, Integrator::backward_euler, 12);
  c.mpm.cells = 3;
  c.contact.wall_friction = 0.3;
  c.sample.seed = 11;
  c.experiment.loading = LoadingPath::biaxial;
  c.loading = {.wall_velocity = 0.1, .max_strain = 0.35, .unload_at = {}, .hold = 20e-3};
  c.loading.confining_stress = stress;
  const auto simulation = create_simulation(c);
  check_kept(*simulation);
  CHECK(simulation->outcome().completed);
}

TEST_CASE("side walls of a triaxial test bear what they are asked for, each pair its own") {
  Case c = packing(GrainModel::mpm, Integrator::symplectic_euler, 8);
  c.experiment.dimension = 3;
  c.mpm.cells = 2;
  c.contact.friction = 0.5;
  c.sample.packing_fraction = 0.45;
  confine_and_compress(c, 0.5, 1e-3, 1, 1e-3);
  const auto simulation = create_any_simulation(c);
  check_kept(dynamic_cast<SimulationOf<3>&>(*simulation));
}

TEST_CASE("side walls follow a stress that swings, is raised and is lowered while others move") {
  for (const auto& [model, integrator] : {std::pair{GrainModel::mpm, Integrator::backward_euler},
                                          {GrainModel::mpm, Integrator::symplectic_euler},
                                          {GrainModel::bpm, Integrator::symplectic_euler}}) {
    CAPTURE(static_cast<int>(model));
    CAPTURE(static_cast<int>(integrator));
    Case c = packing(model, integrator, 9);
    confine_and_compress(c, 0.5, 1e-3, 0.1, 2e-3);
    constexpr double amplitude = 0.3, period = 1e-3;
    Drive swings = keeps(Part::xx, stress);
    swings.amplitude = amplitude * stress;
    swings.period = period;
    swings.wave = Wave::sine;
    c.stages[2].drives[1] = swings;
    for (const double next : {4 * stress, stress})
      c.stages.push_back({.drives = {moves(Part::yy, 0.1), keeps(Part::xx, next)}, .until = {.time = 1e-3}});
    const auto simulation = create_simulation(c);
    finish_stage(*simulation);
    finish_stage(*simulation);
    const auto sine = [](double time) {
      return stress * (1 + amplitude * std::sin(2 * std::acos(-1.0) * time / period));
    };
    CHECK(sides_of_stage(*simulation, sine)[0].worst(100) < 0.05);
    for (const double next : {4 * stress, stress}) {
      const Borne side = sides_of_stage(*simulation, [&](double) { return next; })[0];
      const std::size_t all = side.ratio.size();
      CHECK(std::abs(side.mean(all / 2, all) - 1) < 0.01);
      if (next > stress)  // no overshoot on its way
        CHECK(*std::max_element(side.ratio.begin(), side.ratio.end()) < 1.2);
    }
  }
}
