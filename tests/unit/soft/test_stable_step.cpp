#include "softgrain/soft/stable_step.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

SoftGrains one_disk(int cells, MaterialLaw law = MaterialLaw::neo_hookean, double nu = 0.45) {
  return {{test::placed(test::disk(cells), 1e-3, {0, 0})}, make_law(law, 1e7, nu), 1000};
}

/// Largest angular frequency of small vibrations about where the grain of the first lane is, by power
/// iteration on M^-1 (f(x + d) - f(x - d))/2.
double largest_frequency(const SoftGrains& grains) {
  const GrainBatch& batch = grains.batches[0];
  GrainBatch moved = batch;
  WideVectors forward, backward, mode(batch.position.size());
  test::RandomNumbers random(5);
  for (Vec<2, Wide>& d : mode) {
    const Vec<2> v = random.vector<2>(1);
    d = {v[0], v[1]};
  }
  double square = 0;
  for (int iteration = 0; iteration < 300; ++iteration) {
    double size = 0;
    for (const Vec<2, Wide>& d : mode) size += dot(d, d)[0];
    const double step = 1e-9 / std::sqrt(size);
    const auto force = [&](double sign, WideVectors& f) {
      for (std::size_t i = 0; i < mode.size(); ++i)
        moved.position[i] = batch.position[i] + Wide(sign * step) * mode[i];
      internal_force(grains, moved, f);
    };
    force(1, forward), force(-1, backward);
    square = 0;
    for (std::size_t i = 0; i < mode.size(); ++i) {
      const Wide mass = grains.node_mass(batch, static_cast<int>(i));
      mode[i] = (0.5 / (1e-9 * mass)) * (forward[i] - backward[i]);
      square += dot(mode[i], mode[i])[0];
    }
  }
  return std::pow(square, 0.25);
}

}  // namespace

TEST_CASE("the stable step of a grain lies below 2/omega of its fastest vibration, by at most a third") {
  for (const MaterialLaw law :
       {MaterialLaw::neo_hookean, MaterialLaw::hencky, MaterialLaw::st_venant_kirchhoff})
    for (const double squeeze : {1.0, 0.6, 0.35}) {
      CAPTURE(law);
      CAPTURE(squeeze);
      SoftGrains grains = one_disk(4, law, 0.3);
      const auto press = [&](int, const Vec<2>& x) {
        return Vec<2>{x[0] / std::sqrt(squeeze), squeeze * x[1]};
      };
      test::move_nodes(grains, press);
      const double exact = 2 / largest_frequency(grains);
      CHECK(longest_stable_step(grains, 0) < exact);
      CHECK(longest_stable_step(grains, 0) > exact / 1.34);
      // with damping 4 = (omega dt)^2 (1 + 2 beta)
      CHECK(longest_stable_step(grains, 1.5) == doctest::Approx(longest_stable_step(grains, 0) / 2));
    }
}

TEST_CASE("a grain that vibrates with all its modes gains no energy in a step that its cells do not bear") {
  SoftGrains grains = one_disk(4);
  test::move_nodes(grains, [](int, const Vec<2>& x) { return Vec<2>{x[0] / 0.5, 0.5 * x[1]}; });
  test::shake(grains, 1e-6);
  const auto energy = [](const SoftGrains& of) {
    return of.kinetic_energy() + elastic_energy(of, of.batches[0])[0];
  };
  const double start = energy(grains), dt = 3.7 * longest_stable_step(grains, 0.5);
  ExplicitDynamics dynamics(std::move(grains), {}, {.damping_share = 0.5});
  for (int step = 0; step < 100; ++step) {
    const SoftStepReport report = dynamics.step(dt);
    CHECK(report.iterations >= 3);  // sub-steps
    CHECK(energy(dynamics.grains) <= start * (1 + 1e-3));
  }
}

TEST_CASE("walls that meet, or go too far in a step, end an explicit run") {
  const auto step = [](double top, double speed) {
    ExplicitDynamics dynamics(
        one_disk(2),
        {test::floor_at(-1.2e-3), {.point = {0, top}, .normal = {0, -1}, .velocity = {0, -speed}}}, {});
    dynamics.step(1e-7);
  };
  CHECK_NOTHROW(step(1.2e-3, 1));
  CHECK_THROWS_WITH_AS(step(1.2e-3, 1e5), doctest::Contains("wall 1 moves by 0.01 m in a step"),
                       NumericalError);
  CHECK_THROWS_WITH_AS(step(-1.3e-3, 1), doctest::Contains("walls 0 and 1 have met"), NumericalError);
  CHECK_THROWS_AS(step(1.2e-3, std::nan("")), NumericalError);
}
