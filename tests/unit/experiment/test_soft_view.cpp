#include "softgrain/soft/soft_view.hpp"
#include "support/simulations.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace softgrain;

namespace {

std::map<std::string, double> row_of(Simulation& simulation) {
  std::map<std::string, double> row;
  for (const Quantity& quantity : test::next_row(simulation)) row[quantity.name] = quantity.value;
  return row;
}

const std::vector<double>& reals(const Array& array) { return std::get<std::vector<double>>(array.values); }
const std::vector<std::int64_t>& integers(const Array& array) {
  return std::get<std::vector<std::int64_t>>(array.values);
}

Case packing(Integrator integrator) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.mpm.cells = 3;
  c.mpm.integrator = integrator;
  c.contact.friction = 0.3;
  c.sample.grains = 5;
  c.sample.packing_fraction = 0.6;
  c.loading = {.wall_velocity = 5, .max_strain = 0.35, .unload_at = {}};
  return c;
}

}  // namespace

TEST_CASE(
    "the contacts of a scene of elastic grains carry the forces that their outlines and the top wall feel") {
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
    CAPTURE(integrator);
    const auto simulation = create_simulation(packing(integrator));
    for (auto left = 4 * simulation->steps_planned() / 5; left > 0; --left) simulation->step();
    test::next_row(*simulation);
    simulation->step();
    auto row = row_of(*simulation);  // of this step alone
    const Scene scene = simulation->scene();
    const auto& pair = integers(scene.contacts.at("pair"));
    const std::size_t contacts = pair.size() / 2;
    for (const char* name : {"total_force", "normal", "position"})
      REQUIRE(reals(scene.contacts.at(name)).size() == 2 * contacts);
    const auto &force = reals(scene.contacts.at("force")), &vector = reals(scene.contacts.at("total_force")),
               &normal = reals(scene.contacts.at("normal")), &position = reals(scene.contacts.at("position")),
               &walls = scene.wall_segments;
    REQUIRE(force.size() == contacts);

    std::vector<double> on_grain(10, 0);
    std::vector<double> on_wall(4, 0);
    int pairs = 0;
    for (std::size_t k = 0; k < contacts; ++k) {
      const auto a = pair[2 * k], b = pair[2 * k + 1];
      CHECK(std::hypot(normal[2 * k], normal[2 * k + 1]) == doctest::Approx(1));
      CHECK(force[k] > 0);
      for (int d = 0; d < 2; ++d) {
        on_grain[2 * a + d] -= vector[2 * k + d];
        if (b < 5) on_grain[2 * b + d] += vector[2 * k + d];
      }
      if (b < 5) {
        ++pairs;
        continue;
      }
      const auto w = static_cast<std::size_t>(b - 5);
      REQUIRE(w < 4);
      on_wall[w] += force[k];
      // the wall's segment is where the contact is
      const double* at = &walls[4 * w];
      const double away = at[0] == at[2] ? position[2 * k] - at[0] : position[2 * k + 1] - at[1];
      CHECK(std::fabs(away) < 1e-4 * std::fabs(walls[2] - walls[0]));
    }
    CHECK(pairs >= 3);
    CHECK(2 * pairs / 5.0 == doctest::Approx(row["z"]));
    CHECK(on_wall[0] == doctest::Approx(row["force_bottom"]).epsilon(1e-9));
    CHECK(on_wall[1] == doctest::Approx(row["force_top"]).epsilon(1e-9));

    std::vector<double> on_outline(10, 0);
    const auto& grain = integers(scene.outlines.at("grain"));
    const auto& vertex_force = reals(scene.outlines.at("force"));
    for (std::size_t v = 0; v < grain.size(); ++v)
      for (int d = 0; d < 2; ++d) on_outline[2 * grain[v] + d] += vertex_force[2 * v + d];
    const double largest = *std::max_element(force.begin(), force.end());
    for (int k = 0; k < 10; ++k) CHECK(std::fabs(on_grain[k] - on_outline[k]) < 1e-9 * largest);
  }
}

TEST_CASE("one elastic grain between walls has contacts with walls 1 and 2, in both formulations") {
  for (const Formulation formulation : {Formulation::total_lagrangian, Formulation::updated_lagrangian}) {
    CAPTURE(formulation);
    Case c;
    c.experiment = {.loading = LoadingPath::diametral, .model = GrainModel::mpm};
    c.grain.radius = 1e-3;
    c.mpm.cells = 4;
    c.mpm.formulation = formulation;
    c.contact.wall_friction = 0;
    c.loading = {.wall_velocity = 1, .max_strain = 0.1, .unload_at = {}};
    const auto simulation = create_simulation(c);
    while (!simulation->finished()) simulation->step();
    const Scene scene = simulation->scene();
    CHECK(integers(scene.contacts.at("pair")) == std::vector<std::int64_t>{0, 2, 0, 1});
    const auto& normal = reals(scene.contacts.at("normal"));
    CHECK(normal[1] == doctest::Approx(1));  // the second wall is the top wall
    CHECK(normal[3] == doctest::Approx(-1));
  }
}
