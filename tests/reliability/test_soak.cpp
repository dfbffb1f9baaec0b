#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "support/program_runs.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

/// Four grains with friction, loaded, and then unloaded and loaded again by 1 % of strain over and over.
Case cyclic_case(GrainModel model) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = model};
  c.sample.seed = 3;
  c.sample.grains = 4;
  c.sample.packing_fraction = 0.65;
  c.bpm.primaries = 20;
  c.bpm.library = 1;
  c.bpm.inner_friction = 0.2;
  c.mpm.cells = 2;
  c.contact.friction = 0.3;
  c.contact.wall_friction = 0.2;
  c.time.step = model == GrainModel::bpm ? 0.5e-6 : 10e-6;
  c.loading.wall_velocity = model == GrainModel::bpm ? 1 : 0.5;
  c.loading.unload_by = 0.01;
  for (int turn = 0; turn < 100000; ++turn) c.loading.unload_at.push_back(0.25 + 1e-12 * turn);
  c.loading.max_strain = 0.26;
  return c;
}

/// All grains together.
struct Whole {
  Vec<2> momentum, centre;  // [kg/s], of mass [m]
};

Whole whole_of(const Model& model) {
  Whole whole;
  const Bodies bodies = model.bodies();
  for (std::size_t i = 0; i < bodies.mass.size(); ++i) whole.momentum += bodies.mass[i] * bodies.velocity[i];
  const std::vector<double> radius = model.radii();
  const std::vector<Vec<2>> centre = model.centres();
  double squares = 0;
  for (std::size_t g = 0; g < radius.size(); ++g) {
    squares += radius[g] * radius[g];
    whole.centre += radius[g] * radius[g] * centre[g];
  }
  whole.centre *= 1 / squares;
  return whole;
}

/// Memory of this process [bytes].
double resident_memory() {
  double pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// The most compressed state of a cycle.
struct Turn {
  double height = 0;                       // of the top wall [m]
  double wall_work = 0, energy_error = 0;  // [J/m]
  double memory = 0;                       // [bytes]
  Vec<2> centre;                           // of all mass [m]
};

Turn turn_of(Simulation& simulation, const Whole& whole) {
  std::map<std::string, double> row;
  for (const Quantity& quantity : test::next_row(simulation)) row[quantity.name] = quantity.value;
  return {.height = row.at("wall_height"),
          .wall_work = row.at("wall_work"),
          .energy_error = row.at("energy_error"),
          .memory = resident_memory(),
          .centre = whole.centre};
}

/// How far the turns of a run are from an early one, at most.
struct Drift {
  double memory = 0;              // [bytes]
  double energy = 0;              // error over the work of the walls
  double height = 0, travel = 0;  // of top wall and centre, over the height
  void add(const Turn& early, const Turn& turn) {
    memory = std::max(memory, turn.memory - early.memory);
    energy = std::max(energy, std::abs(turn.energy_error) / turn.wall_work);
    height = std::max(height, std::abs(turn.height - early.height) / early.height);
    travel = std::max(travel, norm(turn.centre - early.centre) / early.height);
  }
};

/// Steps through many cycles; after the first tenth of them nothing may grow, leak or wander.
void soak(const Case& c, int steps, double energy_tolerance) {
  const auto simulation = create_simulation(c);
  Vec<2> pushed;         // impulse of all walls on the bodies [N s/m]
  double exchanged = 0;  // sum of its absolute values
  std::optional<Turn> early;
  Drift drift;
  int legs = 0;
  for (int step = 0; step < steps; ++step) {
    simulation->step();
    for (const Vec<2>& impulse : simulation->box().impulse) {
      pushed -= impulse;
      exchanged += norm(impulse);
    }
    if (!simulation->at_turning_point() || ++legs % 2 == 0) continue;
    const Turn turn = turn_of(*simulation, whole_of(simulation->model()));
    if (!early && step >= steps / 10) early = turn;
    if (early) drift.add(*early, turn);
  }
  const double momentum_error = norm(whole_of(simulation->model()).momentum - pushed) / exchanged;
  MESSAGE(c.experiment.model << ": " << steps << " steps, " << legs / 2 << " cycles, memory + "
                             << drift.memory << " bytes, momentum " << momentum_error
                             << " of what the walls gave, energy " << drift.energy
                             << " of their work, height " << drift.height << ", centre " << drift.travel
                             << " of the height");
  CHECK(legs > 20);
  CHECK(drift.memory < 1e6);
  CHECK(momentum_error < 1e-12);
  CHECK(drift.energy < energy_tolerance);
  CHECK(drift.height < 1e-9);
  CHECK(drift.travel < 0.05);
}

}  // namespace

TEST_CASE(
    "through endless cycles nothing grows, momentum and energy close, and the sample stays: bonded grains") {
  soak(cyclic_case(GrainModel::bpm), test::repeats(10000, 1000000), 1e-5);
}

TEST_CASE(
    "through endless cycles nothing grows, momentum and energy close, and the sample stays: elastic grains") {
  soak(cyclic_case(GrainModel::mpm), test::repeats(600, 1000000), 1e-3);
}
