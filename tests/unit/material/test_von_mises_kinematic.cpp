#include "softgrain/material/von_mises_kinematic.hpp"

#include <doctest/doctest.h>

#include "incremental_potential.hpp"
#include "samples.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/material/von_mises.hpp"

using namespace softgrain;
using namespace softgrain::test;

static_assert(SplitHistoryLaw<VonMisesKinematic, 2>);

namespace {

using State = VonMisesKinematic::State<2, double>;

constexpr double dt = 0.1;
const FlowRule viscous_voce{
    .yield_stress = 0.05, .hardening = 0.02, .saturation = 0.1, .rate = 12, .viscosity = 0.03};
const VonMisesKinematic mixed = von_mises_kinematic(E, nu, 0.3, viscous_voce);
const VonMisesKinematic pure = von_mises_kinematic(E, nu, 0.3, {.yield_stress = 0.05});

State undeformed() { return VonMisesKinematic::undeformed<2, double>(); }
Mat<2> pure_shear(double x) { return Mat<2>::diagonal({std::exp(x), std::exp(-x)}); }
template <class Law>
Mat<2> kirchhoff(const Law& law, const Mat<2>& F, const State& state) {
  return law.stress(F, state, 0) * transpose(F);
}
/// A point that has flowed along two different axes.
State flowed_state(const VonMisesKinematic& law) {
  const State once = law.advance({{1.25, 0.3, -0.1, 0.9}}, undeformed(), dt).state;
  return law.advance({{0.9, -0.2, 0.4, 1.3}}, once, dt).state;
}

}  // namespace

TEST_CASE("without a back stress the law is von Mises' by another road, whatever the path") {
  const VonMisesKinematic law = von_mises_kinematic(E, nu, 0, viscous_voce);
  const VonMises known = von_mises(E, nu, viscous_voce);
  State state = undeformed(), same = undeformed();
  for (int k = 0; k < 200; ++k) {
    const double t = 0.1 * k;
    const Mat<2> F{
        {1 + 0.3 * std::sin(t), 0.4 * std::sin(1.7 * t), 0.3 * std::sin(0.6 * t), 1 - 0.2 * std::cos(t)}};
    CHECK(difference(law.stress(F, state, dt), known.stress(F, same, dt)) < 1e-12);
    CHECK(difference(law.tangent(F, state, dt), known.tangent(F, same, dt)) < 1e-10);
    CHECK(law.energy(F, state, dt) == doctest::Approx(known.energy(F, same, dt)).epsilon(1e-10));
    CHECK(law.stress_across(F, state, dt) ==
          doctest::Approx(known.stress_across(F, same, dt)).epsilon(1e-10));
    state = law.advance(F, state, dt).state;
    same = known.advance(F, same, dt).state;
    CHECK(state[3] == doctest::Approx(same[3]).epsilon(1e-11));
  }
  CHECK(state[3] > 1);
}

TEST_CASE("stress and tangent of a point with a back stress are derivatives of its incremental potential") {
  for (const VonMisesKinematic& law : {mixed, pure, mixed.deviatoric()}) {
    const State state = flowed_state(law);
    int flowing = 0;
    for (const Mat<2>& F : sample_deformations<2>()) {
      flowing += law.advance(F, state, dt).state[3] > state[3] ? 1 : 0;
      check_incremental_potential(law, state, F, dt);
    }
    CHECK(flowing > 3);
  }
}

// E/sigma_y = 100, H/sigma_y = 1, nu = .3, to x = .3 and back; numbers of an independent integration.
TEST_CASE("with kinematic hardening the stress at which a point yields back is lower: Bauschinger's cycle") {
  const VonMisesKinematic law = von_mises_kinematic(100, 0.3, 1, {.yield_stress = 1});
  const double mu = 100 / 2.6, reached = .770671119, reverse = -.384029419;
  for (const int steps : {1, 30}) {
    State state = undeformed();
    for (int k = 1; k <= steps; ++k) state = law.advance(pure_shear(0.3 * k / steps), state, 0).state;
    CHECK(kirchhoff(law, pure_shear(0.3), state)(0, 0) == doctest::Approx(reached).epsilon(1e-9));
    const double way = (reached - reverse) / (2 * mu);
    CHECK(reached - reverse == doctest::Approx(2 / std::sqrt(3.0)).epsilon(1e-8));
    CHECK(law.advance(pure_shear(0.3 - way * (1 - 1e-6)), state, 0).state[3] == state[3]);
    CHECK(law.advance(pure_shear(0.3 - way * (1 + 1e-6)), state, 0).state[3] > state[3]);
  }
}

TEST_CASE("a closed cycle with kinematic hardening alone loses the yield stress times the plastic strain") {
  State state = undeformed();
  double work = 0, dissipated = 0;
  constexpr int steps = 4000;
  const auto strain = [](int k) { return 0.2 * std::sin(2 * 3.14159265358979324 * k / steps); };
  for (int k = 0; k < steps; ++k) {
    const Mat<2> start = pure_shear(strain(k)), end = pure_shear(strain(k + 1));
    const auto [next, taken] = pure.advance(end, state, 0);
    work += contract(0.5 * (pure.stress(start, state, 0) + pure.stress(end, next, 0)), end - start);
    dissipated += taken;
    state = next;
  }
  CHECK(state[3] > 0.6);
  CHECK(dissipated == doctest::Approx(0.05 * state[3]).epsilon(1e-12));
  CHECK(work - pure.stored(identity<2>(), state) == doctest::Approx(dissipated).epsilon(1e-4));
}

// Hencky's stress in simple shear is largest at gamma = 3.0; a back stress with Jaumann's rate would fall
// below zero at gamma = pi.
TEST_CASE(
    "in simple shear a back stress has one maximum, where Hencky's law has its own, and no oscillation") {
  State state = undeformed();
  double before = 0, largest = 0, at = 0;
  int turns = 0;
  for (int k = 1; k <= 2000; ++k) {
    const Mat<2> F{{1, 0.006 * k, 0, 1}};
    const double stress = kirchhoff(pure, F, state)(0, 1);
    if (stress > largest) {
      largest = stress;
      at = F(0, 1);
    } else if (stress > before) {
      ++turns;
    }
    before = stress;
    state = pure.advance(F, state, 0).state;
  }
  CHECK(turns == 0);
  CHECK(at == doctest::Approx(3.0).epsilon(0.15));
  CHECK(before > 0.05 / std::sqrt(3.0));
}

TEST_CASE("flow keeps the volume, the state holds the stress of its end, and a turned point flows alike") {
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}}, Q = sample_rotation<2>(2);
  const State before = flowed_state(mixed), after = mixed.advance(F, before, dt).state;
  CHECK(after[3] > before[3]);
  CHECK(mixed.advance(F, after, 0).state[3] == doctest::Approx(after[3]).epsilon(1e-12));
  CHECK(difference(mixed.stress(Q * F, before, dt), Q * mixed.stress(F, before, dt)) < 1e-13);
  const State turned = mixed.advance(Q * F, before, dt).state;
  for (std::size_t k = 0; k < after.size(); ++k) CHECK(turned[k] == doctest::Approx(after[k]).epsilon(1e-12));
}

TEST_CASE("eight points with a back stress at once flow as each does alone") {
  const auto samples = sample_deformations<2>();
  Mat<2, Wide> F;
  for (int lane = 0; lane < Wide::size; ++lane)
    for (std::size_t k = 0; k < F.c.size(); ++k)
      F.c[k].set(lane, samples[static_cast<std::size_t>(lane)].c[k]);
  const auto first = mixed.advance(F, VonMisesKinematic::undeformed<2, Wide>(), dt).state;
  const Mat<2, Wide> P = mixed.stress(transpose(F), first, dt);
  for (int lane = 0; lane < Wide::size; ++lane) {
    const Mat<2>& alone = samples[static_cast<std::size_t>(lane)];
    const State expected = mixed.advance(alone, undeformed(), dt).state;
    for (std::size_t k = 0; k < expected.size(); ++k)
      CHECK(first[k][lane] == doctest::Approx(expected[k]).epsilon(1e-12));
    CHECK(std::abs(P(0, 1)[lane] - mixed.stress(transpose(alone), expected, dt)(0, 1)) < 1e-12);
  }
}

TEST_CASE("the parts of a point with a back stress make up the law") {
  const State state = flowed_state(mixed);
  for (const Mat<2>& F : sample_deformations<2>()) {
    const Mat<2> P =
        mixed.deviatoric().stress(F, state, dt) + mixed.volume().derivative(determinant(F)) * cofactor(F);
    CHECK(difference(P, mixed.stress(F, state, dt)) < 1e-12 * (1 + largest_entry(P)));
  }
  CHECK_THROWS_WITH_AS(von_mises_kinematic(E, nu, -1, {.yield_stress = 1}),
                       "the kinematic modulus must be >= 0 Pa, got -1", UsageError);
}
