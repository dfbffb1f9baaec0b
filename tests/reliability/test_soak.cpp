#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "softgrain/experiment/bpm_compaction.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/mpm_simulation.hpp"
#include "support/program_runs.hpp"

using namespace softgrain;

namespace {

/// Four grains with friction, loaded, and then unloaded and loaded again by 1 % of strain over and over.
Case cyclic_case(GrainModel model) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = model};
  c.sample = {.seed = 3, .grains = 4, .packing_fraction = 0.65};
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

/// Mass, momentum and first moment of all bodies.
struct Bodies {
  double mass = 0;          // [kg/m]
  Vec<2> momentum, centre;  // [kg/s], [m]
};

Bodies bodies_of(const RigidDynamics<2>& dynamics) {
  const auto& p = dynamics.particles;
  Bodies all;
  for (int i = 0; i < p.size(); ++i) {
    all.mass += p.mass[i];
    all.momentum += p.mass[i] * p.velocity[i];
    all.centre += p.mass[i] * p.position[i];
  }
  all.centre *= 1 / all.mass;
  return all;
}

Bodies bodies_of(const ImplicitDynamics& dynamics) {
  const SoftGrains& grains = dynamics.grains;
  Bodies all;
  all.momentum = grains.momentum();
  for (const GrainBatch& batch : grains.batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
        const double m = grains.node_mass(batch, i)[lane];
        all.mass += m;
        all.centre += m * Vec<2>{batch.position[i][0][lane], batch.position[i][1][lane]};
      }
  all.centre *= 1 / all.mass;
  return all;
}

/// Memory of this process [bytes].
double resident_memory() {
  double pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// The most compressed state of a cycle.
struct Turn {
  double height = 0;                       // of the lid [m]
  double wall_work = 0, energy_error = 0;  // [J/m]
  double memory = 0;                       // [bytes]
  Vec<2> centre;                           // of all mass [m]
};

Turn turn_of(Simulation& simulation, const Bodies& bodies) {
  std::map<std::string, double> row;
  for (const Quantity& quantity : simulation.observe()) row[quantity.name] = quantity.value;
  return {.height = row.at("wall_height"),
          .wall_work = row.at("wall_work"),
          .energy_error = row.at("energy_error"),
          .memory = resident_memory(),
          .centre = bodies.centre};
}

/// How far the turns of a run are from an early one, at most.
struct Drift {
  double memory = 0;              // [bytes]
  double energy = 0;              // error over the work of the walls
  double height = 0, travel = 0;  // of lid and centre, over the height
  void add(const Turn& early, const Turn& turn) {
    memory = std::max(memory, turn.memory - early.memory);
    energy = std::max(energy, std::abs(turn.energy_error) / turn.wall_work);
    height = std::max(height, std::abs(turn.height - early.height) / early.height);
    travel = std::max(travel, norm(turn.centre - early.centre) / early.height);
  }
};

/// Steps through many cycles; after the first tenth of them nothing may grow, leak or wander.
template <class Experiment>
void soak(const Case& c, int steps, double energy_tolerance) {
  const auto simulation = create_simulation(c);
  const auto& dynamics = dynamic_cast<Experiment&>(*simulation).dynamics();
  Vec<2> pushed;         // impulse of all walls on the bodies [N s/m]
  double exchanged = 0;  // sum of its absolute values
  std::optional<Turn> early;
  Drift drift;
  int legs = 0;
  for (int step = 0; step < steps; ++step) {
    simulation->step();
    for (int w = 0; w < 4; ++w) {
      pushed -= dynamics.wall_impulse(w);
      exchanged += norm(dynamics.wall_impulse(w));
    }
    if (!simulation->at_turning_point() || ++legs % 2 == 0) continue;
    const Turn turn = turn_of(*simulation, bodies_of(dynamics));
    if (!early && step >= steps / 10) early = turn;
    if (early) drift.add(*early, turn);
  }
  const double momentum_error = norm(bodies_of(dynamics).momentum - pushed) / exchanged;
  MESSAGE(c.experiment.model << ": " << steps << " steps, " << legs / 2 << " cycles, memory + "
                             << drift.memory << " bytes, momentum " << momentum_error
                             << " of what the walls gave, energy " << drift.energy << " of their work, lid "
                             << drift.height << ", centre " << drift.travel << " of the height");
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
  soak<BpmCompaction>(cyclic_case(GrainModel::bpm), test::repeats(10000, 1000000), 1e-5);
}

TEST_CASE(
    "through endless cycles nothing grows, momentum and energy close, and the sample stays: elastic grains") {
  soak<MpmSimulation<ImplicitDynamics>>(cyclic_case(GrainModel::mpm), test::repeats(600, 1000000), 1e-3);
}
