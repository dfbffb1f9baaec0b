#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "softgrain/loading/loading.hpp"
#include "softgrain/observe/packing_measures.hpp"
#include "softgrain/sample/box_sample.hpp"
#include "support/solid_grains.hpp"

using namespace softgrain;

TEST_CASE("random spheres fill the fraction that is asked for, without overlap, turned each its own way") {
  const BoxSampleOptions options{
      .grains = 40, .sizes = {.smallest = 1e-3, .largest = 1.5e-3}, .packing_fraction = 0.45, .aspect = 1.5};
  const BoxSampleOf<3> sample = sample_solid_box(options);
  const Box<3> box = box_of(sample);
  CHECK(box.walls.size() == 6);
  CHECK(box.closed());
  CHECK(sample.width == doctest::Approx(1.5 * sample.height));
  double volume = 0;
  for (const auto& a : sample.grains) {
    volume += 4 * std::numbers::pi / 3 * std::pow(a.radius, 3);
    for (const Wall<3>& wall : box.walls) CHECK(dot(a.centre - wall.point, wall.normal) > a.radius);
    for (const auto& b : sample.grains)
      if (&a != &b) CHECK(norm(a.centre - b.centre) > a.radius + b.radius);
    const Mat<3> product = a.angle * transpose(a.angle);
    CHECK(contract(product, product) == doctest::Approx(3));
    CHECK(determinant(a.angle) == doctest::Approx(1));
  }
  CHECK(volume / box.volume() == doctest::Approx(0.45));
  CHECK(!(sample.grains[0].angle == sample.grains[1].angle));
}

namespace {

class NoGrains final : public ModelOf<3> {
 public:
  std::unique_ptr<ModelOf<3>> copy() const override { return std::make_unique<NoGrains>(*this); }
  StepReport step(Box<3>& box, double dt) override {
    box.advance(dt);
    return {};
  }
  void visit(StateVisitor&) override {}
  double density() const override { return 1; }
  std::vector<double> radii() const override { return {}; }
  std::vector<Vec<3>> centres() const override { return {}; }
  BodiesOf<3> bodies() const override { return {}; }
  std::vector<ContactPointOf<3>> contacts() const override { return {}; }
  std::vector<SurfaceMeasure> outlines() const override { return {}; }
  std::pair<double, double> extent(int /*axis*/) const override { return {0, 1}; }
  Energies energies() const override { return {}; }
  Numbers numbers(const Box<3>&, const Energies&) const override { return {}; }
  Scene scene(const Box<3>&) const override { return {}; }
  std::pair<double, double> reach() const override { return {0, 1}; }
  std::vector<GrainView> grains() const override { return {}; }
};

Box<3> unit_cube() {
  BoxSampleOf<3> sample;
  sample.width = sample.height = 1;
  return box_of(sample);
}

}  // namespace

TEST_CASE("an isotropic path in space brings six walls to the strain, a compaction the top wall alone") {
  const auto lengths_after = [](Part part) {
    Box<3> box = unit_cube();
    NoGrains model;
    Stage stage{.drives = {{.part = part, .control = Control::velocity, .value = 0.01}}, .towards = true};
    stage.until.strain[0] = 0.2;
    LoadingOf<3> loading({stage}, {.measure = {}, .wall_velocity = 0.01, .dimension = 3}, box);
    for (double time = 0; !loading.finished(); time += 0.1) {
      loading.drive(box, model, time, 0.1);
      model.step(box, 0.1);
      loading.after_step(box, time + 0.1, 0.1, {});
    }
    return Vec<3>{box.length(0), box.length(1), box.length(2)};
  };
  const double end = std::exp(-0.2);
  CHECK(norm(lengths_after(Part::all) - Vec<3>{end, end, end}) < 1e-12);
  CHECK(norm(lengths_after(Part::top) - Vec<3>{1, 1, end}) < 1e-12);
}

// Three spheres in a row along z between two walls: sigma_zz V = f (4 R + 2 R), and a neighbour counts once.
TEST_CASE("a column of spheres has Love and Weber's stress, its coordination and its fraction") {
  const std::vector<double> radius{1, 1, 1}, mass;
  const std::vector<Vec<3>> centre{{1, 1, 1}, {1, 1, 3}, {1, 1, 5}}, velocity;
  const double f = 7;
  const std::vector<ContactPointOf<3>> contacts{
      {.a = 0, .b = 1, .force = {0, 0, f}, .normal = {0, 0, 1}, .position = {1, 1, 2}},
      {.a = 1, .b = 2, .force = {0, 0, f}, .normal = {0, 0, 1}, .position = {1, 1, 4}},
      {.a = 0, .b = wall_index(0), .force = {0, 0, -f}, .normal = {0, 0, -1}, .position = {1, 1, 0}},
      {.a = 2, .b = wall_index(1), .force = {0, 0, f}, .normal = {0, 0, 1}, .position = {1, 1, 6}}};
  const SurfaceMeasure ball{4 * std::numbers::pi / 3, 4 * std::numbers::pi};
  const std::vector<SurfaceMeasure> surface{ball, ball, ball};
  const PackingMeasures measures = measure_packing(SolidPackingView{.volume = 24,
                                                                    .radius = radius,
                                                                    .surface = surface,
                                                                    .centre = centre,
                                                                    .contacts = contacts,
                                                                    .mass = mass,
                                                                    .velocity = velocity,
                                                                    .density = 1,
                                                                    .strain_rate = 0});
  CHECK(measures.stress(2, 2) == doctest::Approx(6 * f / 24));
  CHECK(std::abs(measures.stress(0, 0)) < 1e-15);
  CHECK(measures.coordination.z == doctest::Approx(4.0 / 3));
  CHECK(measures.coordination.z_with_walls == doctest::Approx(8.0 / 3));
  CHECK(measures.phi.deformed == doctest::Approx(std::numbers::pi / 6));
  CHECK(measures.coordination.rattlers == 1);  // two contacts hold no sphere
  for (const auto& [name, value] : measures.numbers)
    if (name == "sphericity") CHECK(value == doctest::Approx(1));
}
