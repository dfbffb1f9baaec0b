#include "softgrain/material/prony.hpp"

#include <doctest/doctest.h>

#include "incremental_potential.hpp"
#include "samples.hpp"
#include "softgrain/core/error.hpp"

using namespace softgrain;
using namespace softgrain::test;

static_assert(SplitHistoryLaw<Prony, 2> && SplitHistoryLaw<Prony, 3> && !ElasticLaw<Prony, 2>);

namespace {

using State = Prony::State<2, double>;

const Prony gel = prony(E, nu, {0.4, 0.3}, {0.1, 1});
const Prony one = prony(E, nu, {0.8}, {0.5});

State undeformed() { return Prony::undeformed<2, double>(); }
Mat<2> pure_shear(double x) { return Mat<2>::diagonal({std::exp(x), std::exp(-x)}); }
double kirchhoff(const Prony& law, const Mat<2>& F, const State& state) {
  return (law.stress(F, state, 0) * transpose(F))(0, 0);
}

/// A point that was strained along different axes, for a while each.
State strained(const Prony& law) {
  State state = law.advance(Mat<2>{{1.25, 0.3, -0.1, 0.9}}, undeformed(), 0.07).state;
  return law.advance(Mat<2>{{0.9, -0.2, 0.4, 1.3}}, state, 0.2).state;
}

}  // namespace

TEST_CASE("held at a strain the stress falls as Prony's series says, exactly and whatever the steps") {
  const Mat<2> F = pure_shear(0.3);
  const State at_once = gel.advance(F, undeformed(), 1e-12).state;  // strained within no time
  const double first = hencky(E, nu).stress(F)(0, 0) * F(0, 0);
  CHECK(kirchhoff(gel, F, at_once) == doctest::Approx(first).epsilon(1e-10));
  const struct {
    double time, left;
  } known[] = {{0.1, .718603}, {1, .410382}, {10, .300014}};  // worked out apart
  for (const auto& [time, left] : known) {
    const double series = 0.3 + 0.4 * std::exp(-time / 0.1) + 0.3 * std::exp(-time / 1);
    CHECK(series == doctest::Approx(left).epsilon(2e-6));
    for (const int steps : {1, 7, 1000}) {
      State state = at_once;
      for (int k = 0; k < steps; ++k) state = gel.advance(F, state, time / steps).state;
      CHECK(kirchhoff(gel, F, state) / first == doctest::Approx(series).epsilon(1e-10));
    }
  }
}

TEST_CASE("what relaxes at rest is dissipated: no energy is lost or made, at any step") {
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}};
  State state = gel.advance(F, undeformed(), 1e-12).state;
  for (const double dt : {1e-3, 0.1, 2.0, 100.0}) {
    const auto [after, dissipated] = gel.advance(F, state, dt);
    CHECK(dissipated > 0);
    CHECK(gel.stored(F, state) - gel.stored(F, after) == doctest::Approx(dissipated).epsilon(1e-10));
    state = after;
  }
}

TEST_CASE(
    "sheared at a steady rate a branch carries its viscous stress and dissipates its power, at any step") {
  const double rate = 0.3, viscous = 2 * 0.8 * one.mu * 0.5 * rate;  // 2 mu g tau x'
  for (const double dt : {0.01, 0.5, 5.0}) {
    State state = undeformed();
    double x = 0, taken = 0;
    for (double t = 0; t < 20; t += dt) {
      x += rate * dt;
      const auto [after, dissipated] = one.advance(pure_shear(x), state, dt);
      state = after;
      taken = dissipated;
    }
    const double lasting = 2 * 0.2 * one.mu * x;
    CHECK(kirchhoff(one, pure_shear(x), state) - lasting == doctest::Approx(viscous).epsilon(1e-9));
    CHECK(taken == doctest::Approx(2 * viscous * rate * dt).epsilon(1e-9));
  }
}

TEST_CASE("a ramp of strain has the closed form of a generalised Maxwell model, at any step") {
  const double rate = 0.5, time = 0.4, x = rate * time;
  double expected = 0.3 * x;
  for (const auto& [g, tau] : {std::pair{0.4, 0.1}, std::pair{0.3, 1.0}})
    expected += g * rate * tau * (1 - std::exp(-time / tau));
  for (const int steps : {1, 10, 300}) {
    State state = undeformed();
    for (int k = 1; k <= steps; ++k)
      state = gel.advance(pure_shear(x * k / steps), state, time / steps).state;
    CHECK(kirchhoff(gel, pure_shear(x), state) == doctest::Approx(2 * gel.mu * expected).epsilon(1e-11));
  }
}

TEST_CASE("the work of a cycle of shear is what a generalised Maxwell model loses, to fourth order") {
  // loss modulus g omega tau/(1 + (omega tau)^2); along each of two directions a cycle takes pi 2 mu loss a^2
  constexpr double pi = 3.14159265358979324, omega = 2, amplitude = 0.05;
  const double loss = 0.8 * omega * 0.5 / (1 + omega * 0.5 * omega * 0.5);
  double error[2];
  for (const int half : {0, 1}) {
    const int steps = 100 << half;
    State state = undeformed();
    double dissipated = 0;
    for (int k = 1; k <= 8 * steps; ++k) {  // the last of eight, when the start is forgotten
      const auto step =
          one.advance(pure_shear(amplitude * std::sin(2 * pi * k / steps)), state, 2 * pi / omega / steps);
      state = step.state;
      if (k > 7 * steps) dissipated += step.dissipated;
    }
    error[half] = dissipated / (2 * 2 * one.mu * loss * pi * amplitude * amplitude) - 1;
  }
  CHECK(std::abs(error[1]) < 1e-3);
  CHECK(error[0] / error[1] == doctest::Approx(16).epsilon(0.05));
}

TEST_CASE("stress and tangent of a point that relaxes are derivatives of its incremental potential") {
  constexpr double dt = 0.05;
  for (const Prony& law : {gel, one, gel.deviatoric()}) {
    const State state = strained(law);
    for (const Mat<2>& F : sample_deformations<2>()) check_incremental_potential(law, state, F, dt);
  }
}

TEST_CASE("the state after a step holds the stress of its end, and a turned point relaxes alike") {
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}}, Q = sample_rotation<2>(2);
  const State before = strained(gel);
  const auto after = gel.advance(F, before, 0.1), turned = gel.advance(Q * F, before, 0.1);
  CHECK(difference(gel.stress(F, after.state, 0), gel.stress(F, before, 0.1)) < 1e-13);
  CHECK(difference(gel.stress(Q * F, turned.state, 0), Q * gel.stress(F, after.state, 0)) < 1e-13);
  CHECK(turned.dissipated == doctest::Approx(after.dissipated).epsilon(1e-12));
}

TEST_CASE("at once a point that relaxes is Hencky's, after a long time Hencky's of the modulus that lasts") {
  const Mat<2> F{{1.3, 0.2, 0.1, 0.9}};
  CHECK(difference(gel.stress(F, undeformed(), 0), hencky(E, nu).stress(F)) < 1e-14);
  const State late = gel.advance(F, undeformed(), 1e6).state;
  const Hencky soft{gel.bulk - 2.0 / 3 * 0.3 * gel.mu, 0.3 * gel.mu};
  CHECK(difference(gel.stress(F, late, 0), soft.stress(F)) <
        1e-5);  // strained all the time, so viscous still
  CHECK(gel.stress_across(F, undeformed(), 0) ==
        doctest::Approx(hencky(E, nu).stress(embedded(F))(2, 2)).epsilon(1e-12));
}

TEST_CASE("eight points at once relax as each does alone") {
  const auto samples = sample_deformations<2>();
  Mat<2, Wide> F;
  for (int lane = 0; lane < Wide::size; ++lane)
    for (std::size_t k = 0; k < F.c.size(); ++k)
      F.c[k].set(lane, samples[static_cast<std::size_t>(lane)].c[k]);
  const auto first = gel.advance(F, Prony::undeformed<2, Wide>(), 0.1).state;
  const auto second = gel.advance(F, first, 0.2);
  for (int lane = 0; lane < Wide::size; ++lane) {
    const Mat<2>& alone = samples[static_cast<std::size_t>(lane)];
    const auto expected = gel.advance(alone, gel.advance(alone, undeformed(), 0.1).state, 0.2);
    for (std::size_t k = 0; k < expected.state.size(); ++k)
      CHECK(second.state[k][lane] == doctest::Approx(expected.state[k]).epsilon(1e-12));
    CHECK(second.dissipated[lane] == doctest::Approx(expected.dissipated).epsilon(1e-10));
  }
}

TEST_CASE(
    "the parts of a point that relaxes make up the law, and its cell keeps little of the bulk modulus") {
  const State state = strained(gel);
  for (const Mat<2>& F : sample_deformations<2>()) {
    const Mat<2> P =
        gel.deviatoric().stress(F, state, 0.1) + gel.volume().derivative(determinant(F)) * cofactor(F);
    CHECK(difference(P, gel.stress(F, state, 0.1)) < 1e-12 * (1 + largest_entry(P)));
  }
  CHECK(gel.deviatoric().bulk == doctest::Approx(2.0 / 3 * 0.3 * gel.mu));
}

TEST_CASE("shares and times that cannot be are refused by name") {
  CHECK_THROWS_WITH_AS(
      prony(E, nu, {0.4}, {}),
      "relaxation_share_1 and relaxation_time_1 belong together: both > 0, or both 0; got 0.4 and 0 s",
      UsageError);
  CHECK_THROWS_AS(prony(E, nu, {0.4}, {1, 2}), UsageError);
  CHECK_THROWS_WITH_AS(prony(E, nu, {}, {}),
                       "what relaxes needs a relaxation_share_1 > 0 and a relaxation_time_1 > 0 s",
                       UsageError);
  CHECK_THROWS_WITH_AS(
      prony(E, nu, {0.5, 0.5}, {1, 2}),
      "the relaxation shares must add up to less than 1: a grain of which nothing lasts is a "
      "fluid; got a sum of 1",
      UsageError);
}

TEST_CASE("plane strain of what relaxes is relaxation in space with a stretch of one across the plane") {
  State plane = undeformed();
  auto space = Prony::undeformed<3, double>();
  const double dt = 0.05;
  for (int k = 0; k < 100; ++k) {
    const double t = 0.1 * k;
    const Mat<2> F{
        {1 + 0.3 * std::sin(t), 0.4 * std::sin(1.7 * t), 0.3 * std::sin(0.6 * t), 1 - 0.2 * std::cos(t)}};
    const Mat<2> P = gel.stress(F, plane, dt);
    const Mat<3> Q = gel.stress(embedded(F), space, dt);
    CHECK(difference(P, Mat<2>{{Q(0, 0), Q(0, 1), Q(1, 0), Q(1, 1)}}) < 1e-12);
    CHECK(gel.stress_across(F, plane, dt) == doctest::Approx(Q(2, 2)).epsilon(1e-10));
    CHECK(gel.stored(F, plane) == doctest::Approx(gel.stored(embedded(F), space)).epsilon(1e-10));
    const auto [plane_after, plane_lost] = gel.advance(F, plane, dt);
    const auto [stress, after] = gel.stress_and_advance(embedded(F), space, dt);
    CHECK(difference(stress, Q) == 0);
    CHECK(plane_lost == doctest::Approx(after.dissipated).epsilon(1e-9));
    plane = plane_after;
    space = after.state;
  }
}

TEST_CASE("stress and tangent of what relaxes in space are derivatives of its incremental potential") {
  auto state = Prony::undeformed<3, double>();
  state = gel.advance(Mat<3>{{1.2, 0.2, 0.1, -0.1, 0.9, 0.3, 0, 0.1, 1.1}}, state, 0.07).state;
  const Mat<3> F{{0.9, -0.2, 0.1, 0.3, 1.2, -0.1, 0.2, 0, 1.05}};
  const double dt = 0.2, step = 1e-5;
  const Mat<3> P = gel.stress(F, state, dt);
  const Mat<9> A = gel.tangent(F, state, dt);
  for (int i = 0; i < 9; ++i) {
    Mat<3> up = F, down = F;
    up.c[i] += step, down.c[i] -= step;
    const double slope = (gel.energy(up, state, dt) - gel.energy(down, state, dt)) / (2 * step);
    CHECK(slope == doctest::Approx(P.c[i]).epsilon(1e-7));
    const Mat<3> change = (1 / (2 * step)) * (gel.stress(up, state, dt) - gel.stress(down, state, dt));
    for (int j = 0; j < 9; ++j) CHECK(std::abs(change.c[j] - A(j, i)) < 1e-7);
  }
}
