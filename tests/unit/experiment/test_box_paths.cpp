#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/experiment/sample.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

Case soft_packing(LoadingPath loading, Integrator integrator = Integrator::backward_euler) {
  Case c;
  c.experiment = {.loading = loading, .model = GrainModel::mpm};
  c.mpm.cells = 3;
  c.mpm.integrator = integrator;
  c.contact.friction = c.contact.wall_friction = 0.3;
  c.sample.grains = 6;
  c.sample.packing_fraction = 0.6;
  c.loading = {.wall_velocity = 2, .max_strain = 0.4, .unload_at = {}};
  return c;
}

Case bonded_packing(LoadingPath loading) {
  Case c = soft_packing(loading);
  c.experiment.model = GrainModel::bpm;
  c.bpm.primaries = 30;
  c.bpm.library = 2;
  c.loading.wall_velocity = 5;
  c.time.step = 0.4e-6;
  return c;
}

Vec<2> momentum(const Model& model) {
  const Bodies bodies = model.bodies();
  Vec<2> sum;
  for (std::size_t i = 0; i < bodies.mass.size(); ++i) sum += bodies.mass[i] * bodies.velocity[i];
  return sum;
}

/// Largest error of the momentum balance of grains and walls over a step, over the largest impulse of a wall.
double momentum_error(Simulation& simulation) {
  double error = 0, largest = 0;
  int walls_hit = 0;
  while (!simulation.finished()) {
    const Vec<2> before = momentum(simulation.model());
    simulation.step();
    Vec<2> change = momentum(simulation.model()) - before;
    int hit = 0;
    for (const Vec<2>& impulse : simulation.box().impulse) {
      change += impulse;
      largest = std::max(largest, norm(impulse));
      hit += norm(impulse) > 0 ? 1 : 0;
    }
    walls_hit = std::max(walls_hit, hit);
    error = std::max(error, norm(change));
  }
  CHECK(walls_hit == 4);
  return error / largest;
}

/// Means over the second half of the hold: stress of the walls that keep it [Pa], weighted by time.
double held_stress(Simulation& simulation, std::int64_t hold_steps, bool top_alone) {
  while (!simulation.at_turning_point() && !simulation.finished()) simulation.step();
  REQUIRE_FALSE(simulation.finished());
  for (std::int64_t step = 0; step < hold_steps / 2; ++step) simulation.step();
  test::next_row(simulation);
  while (!simulation.finished()) simulation.step();
  CHECK(simulation.early_end().starts_with("loading.hold_stress was"));
  CHECK(simulation.progress() == 1);
  const auto row = test::next_row(simulation);
  const double top = test::value_of(row, "stress_top");
  return top_alone ? top : (top + test::value_of(row, "stress_bottom")) / 2;
}

void check_same_bits(const Checkpoint& a, const Checkpoint& b) {
  CHECK(a.step == b.step);
  REQUIRE(a.arrays.size() == b.arrays.size());
  for (const auto& [name, array] : a.arrays) {
    CAPTURE(name);
    CHECK((array.values == b.arrays.at(name).values));
  }
}

}  // namespace

TEST_CASE("an isotropic box keeps its shape and its centre, and Phi_0 = Phi_start e^(2 eps)") {
  for (Case c : {soft_packing(LoadingPath::isotropic), bonded_packing(LoadingPath::isotropic)}) {
    CAPTURE(c.experiment.model);
    c.sample.aspect = 1.5;
    const auto simulation = create_simulation(c);
    const double start = test::value_of(test::next_row(*simulation), "wall_height");
    for (int step = 0; step < 20; ++step) simulation->step();
    const auto row = test::next_row(*simulation);
    const double h = start - c.loading.wall_velocity * simulation->time();
    CHECK(h < start);
    CHECK(test::value_of(row, "wall_height") / h == doctest::Approx(1).epsilon(1e-9));
    CHECK(test::value_of(row, "width") / (1.5 * h) == doctest::Approx(1).epsilon(1e-9));
    CHECK(test::value_of(row, "strain") / std::log(start / h) == doctest::Approx(1).epsilon(1e-6));
    CHECK(test::value_of(row, "phi_0") == doctest::Approx(0.6 * start * start / (h * h)));
    const double low = (start - h) / 2, high = (start + h) / 2;
    const Checkpoint state = simulation->checkpoint();
    const auto& wall = std::get<std::vector<double>>(state.arrays.at("wall_point").values);
    CHECK(wall[1] / low == doctest::Approx(1).epsilon(1e-9));
    CHECK(wall[3] / high == doctest::Approx(1).epsilon(1e-9));
    CHECK(wall[4] / (1.5 * low) == doctest::Approx(1).epsilon(1e-9));
    CHECK(wall[6] / (1.5 * high) == doctest::Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("what the momentum of grains loses, the four walls of an isotropic box gain") {
  CHECK(momentum_error(*create_simulation(soft_packing(LoadingPath::isotropic))) < 1e-6);
  Case c = soft_packing(LoadingPath::isotropic, Integrator::symplectic_euler);
  c.loading.wall_velocity = 20;
  CHECK(momentum_error(*create_simulation(c)) < 1e-12);
  CHECK(momentum_error(*create_simulation(bonded_packing(LoadingPath::isotropic))) < 1e-12);
}

TEST_CASE("walls keep the stress of a packing that they are asked to keep") {
  for (const LoadingPath loading : {LoadingPath::compaction, LoadingPath::isotropic}) {
    CAPTURE(loading);
    Case c = soft_packing(loading);
    c.time.step = 5e-6;
    c.loading.hold = 1.5e-3;
    c.loading.hold_stress = 4e5;
    const bool top_alone = loading == LoadingPath::compaction;
    CHECK(held_stress(*create_simulation(c), 300, top_alone) == doctest::Approx(4e5).epsilon(0.01));
  }
  Case c = bonded_packing(LoadingPath::compaction);
  c.loading.hold = 4e-3;
  c.loading.hold_stress = 2e5;
  CHECK(held_stress(*create_simulation(c), 10000, true) == doctest::Approx(2e5).epsilon(0.02));
}

TEST_CASE("a held stress is kept, in grains soft and stiff, and never far exceeded") {
  for (const double young_modulus : {1e6, 1e9}) {
    CAPTURE(young_modulus);
    Case c = soft_packing(LoadingPath::compaction);
    c.mpm.material.young_modulus = young_modulus;
    c.loading.wall_velocity = 0.5;
    c.loading.hold = young_modulus > 1e8 ? 60e-3 : 12e-3;  // stiff grains are hit long before they are packed
    c.loading.hold_stress = 1e4;
    const auto simulation = create_simulation(c);
    while (!simulation->finished()) simulation->step();
    CAPTURE(simulation->early_end());
    CHECK(simulation->early_end().starts_with("loading.hold_stress was kept"));
    CHECK(simulation->outcome().completed);
  }
  Case c = soft_packing(LoadingPath::isotropic, Integrator::symplectic_euler);
  c.mpm.material.young_modulus = 1e7;
  c.loading.wall_velocity = 0.5;
  c.loading.hold = 12e-3;
  c.loading.hold_stress = 1e5;
  const auto simulation = create_simulation(c);
  while (!simulation->finished()) simulation->step();
  CAPTURE(simulation->early_end());
  CHECK(simulation->outcome().completed);
}

TEST_CASE("a stress that is raised is reached with less than 5 % too much, by walls and by a cell") {
  const auto keep = [](double stress, double time) {
    return Stage{.drives = {{.part = Part::yy, .control = Control::stress, .value = stress},
                            {.part = Part::xx, .control = Control::stress, .value = stress}},
                 .until = {.time = time}};
  };
  Stage press{.drives = {{.part = Part::yy, .control = Control::velocity, .value = 0.5},
                         {.part = Part::xx, .control = Control::velocity, .value = 0.5}}};
  press.until.stress[0] = 2e5;
  for (const bool is_cell : {false, true}) {
    CAPTURE(is_cell);
    Case c = soft_packing(LoadingPath::stages);
    c.sample.grains = 20;
    c.loading.wall_velocity = 0.5;
    c.stages = {press, keep(2e5, 4e-3), keep(7e5, 2e-3)};
    if (is_cell) c.box.x = c.box.y = BoxEnd::periodic;
    const auto simulation = create_simulation(c);
    double largest = 0, last = 0;
    while (!simulation->finished()) {
      const double began = simulation->time();
      simulation->step();
      const Box<2>& box = simulation->box();
      last = (box.outward_impulse(bottom_wall) + box.outward_impulse(top_wall)) /
             (2 * (simulation->time() - began) * box.width());
      largest = std::max(largest, last);
    }
    CHECK(last == doctest::Approx(7e5).epsilon(0.01));
    CHECK(largest < 1.05 * 7e5);
  }
}

TEST_CASE("side walls keep their stress within 5 % at any time while the grains between them rearrange") {
  Case c = soft_packing(LoadingPath::biaxial);
  c.mpm.material = {.young_modulus = 1e7, .poisson_ratio = 0.45};
  c.sample.grains = 12;
  c.sample.packing_fraction = 0.7;
  c.loading.wall_velocity = 0.1;
  c.contact.wall_friction = 0;
  c.loading.max_strain = 0.2;
  c.loading.confining_stress = 1e5;
  c.loading.hold = 10e-3;
  const auto simulation = create_simulation(c);
  for (int stage = 0; stage < 2; stage += simulation->at_turning_point() ? 1 : 0) simulation->step();
  double largest = 0, sum = 0, count = 0;
  while (!simulation->finished()) {
    const double began = simulation->time(), height = simulation->box().height();
    simulation->step();
    const Box<2>& box = simulation->box();
    const double stress = (box.outward_impulse(left_wall) + box.outward_impulse(right_wall)) /
                          (2 * (simulation->time() - began) * height * 1e5);
    largest = std::max(largest, stress);
    sum += stress;
    ++count;
  }
  CHECK(std::abs(sum / count - 1) < 0.005);
  CHECK(largest < 1.05);
  CHECK(simulation->outcome().completed);
}

TEST_CASE("walls that keep a stress go on from a checkpoint bit for bit") {
  Case soft = soft_packing(LoadingPath::isotropic), bonded = bonded_packing(LoadingPath::compaction);
  soft.loading.hold_stress = bonded.loading.hold_stress = 2e5;
  soft.loading.hold = bonded.loading.hold = 3e-4;
  for (const Case& c : {soft, bonded}) {
    CAPTURE(c.experiment.model);
    const auto whole = create_simulation(c), resumed = create_simulation(c);
    while (!whole->at_turning_point()) whole->step();
    for (int step = 0; step < 10; ++step) whole->step();
    resumed->restore(whole->checkpoint());
    while (!whole->finished()) whole->step();
    while (!resumed->finished()) resumed->step();
    check_same_bits(whole->checkpoint(), resumed->checkpoint());
    CHECK(resumed->early_end() == whole->early_end());
  }
}

TEST_CASE("the inertial number of a box is that of the axis along which it strains fastest") {
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = GrainModel::mpm};
  c.mpm.cells = 4;
  c.sample.placed = {{{1e-3, 1e-3}, 1e-3}};  // one grain that the walls touch
  c.box = {.width = 2e-3, .height = 2e-3};
  const Case still = complete_sample(c);
  const auto number_of = [&](Part part) {
    Case moved = still;
    moved.stages = {{.drives = {{part, Control::rate, 40}}, .until = {.time = 1e-3}}};
    Simulation simulation = test::simulation_of(moved);
    test::advance(simulation, 3);
    const auto row = test::next_row(simulation);
    const double p = (test::value_of(row, "stress_xx") + test::value_of(row, "stress_yy")) / 2;
    REQUIRE(p > 0);
    return test::value_of(row, "inertial_number") / (40 * 2e-3 * std::sqrt(c.grain.density / p));
  };
  CHECK(std::abs(number_of(Part::yy) - 1) < 5e-3);  // the walls slow down within a step
  CHECK(std::abs(number_of(Part::xx) - 1) < 5e-3);
}

TEST_CASE("a corner holds no vertex between two walls that come in, however much they rub") {
  Case c = soft_packing(LoadingPath::isotropic);
  c.mpm.cells = 4;
  c.sample.grains = 8;
  c.sample.packing_fraction = 0.7;
  c.contact.wall_friction = 3;
  c.loading = {.wall_velocity = 0.2, .max_strain = 0.202, .unload_at = {}};
  Simulation simulation = test::simulation_of(c);
  while (!simulation.finished()) {
    simulation.begin_row();
    simulation.step();
  }
  const auto row = row_of(simulation.observe());
  const double top = test::value_of(row, "stress_top"), bottom = test::value_of(row, "stress_bottom");
  CHECK(test::value_of(row, "stress_side") == doctest::Approx((top + bottom) / 2).epsilon(0.15));
  CHECK(top == doctest::Approx(bottom).epsilon(0.15));
}
