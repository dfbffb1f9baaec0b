#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

struct Energy {
  double start = 0, rise = 0, walls = 0;  // [J/m]
};

/// Two bonded grains that touch nothing; `rise`: the most that kinetic + attraction energy came up again.
Energy energy_of_free_grains(Activation activation, double e, double push_out, double mu) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm};
  c.bpm.primaries = 19;
  c.bpm.inner_friction = mu;
  c.contact = {.friction = mu, .restitution = e, .activation = activation, .push_out = push_out};
  c.sample.grains = 2;
  c.sample.packing_fraction = 0.3;
  c.loading = {.wall_velocity = 0.5, .max_strain = 0.05};
  c.time.step = 0.2e-6;
  Simulation simulation = test::simulation_of(c);
  Energy energy;
  double lowest = 0;
  for (int k = 0; k < 40; ++k) {
    std::map<std::string, double> row;
    for (const Quantity& quantity : test::next_row(simulation)) row[quantity.name] = quantity.value;
    const double now = row["kinetic_energy"] + row["attraction_energy"];
    if (k == 0) energy.start = lowest = now;
    lowest = std::min(lowest, now);
    energy.rise = std::max(energy.rise, now - lowest);
    energy.walls += std::abs(row["wall_work"]);
    for (int step = 0; step < 100; ++step) simulation.step();
  }
  return energy;
}

}  // namespace

TEST_CASE(
    "free bonded grains never gain energy, from e = 0 to 1, with any push-out and rule, rough or smooth") {
  struct Law {
    double e, push_out, mu;
  };
  for (const Activation activation : {Activation::closed_at_mid_step, Activation::closed_at_end_of_step})
    for (const auto& [e, push_out, mu] :
         {Law{0, 0.1, 0}, Law{0.5, 0.1, 0.3}, Law{0.9, 0.1, 0}, Law{0.95, 0.1, 0}, Law{0.99, 0.1, 0},
          Law{0.99, 1, 0.3}, Law{1, 0.1, 0}, Law{1, 1, 0.3}}) {
      CAPTURE(activation);
      CAPTURE(e);
      CAPTURE(push_out);
      const Energy energy = energy_of_free_grains(activation, e, push_out, mu);
      REQUIRE(energy.walls == 0);
      CHECK(energy.rise < 1e-3 * std::abs(energy.start));  // the tolerance of the solver; 0.2 to 2.7 before
    }
  for (const double push_out : {0.1, 1.0})
    CHECK(energy_of_free_grains(Activation::anticipated, 0, push_out, 0.3).rise < 1e-5);
}
