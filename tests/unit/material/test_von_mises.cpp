#include <doctest/doctest.h>

#include "samples.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/material/von_mises.hpp"

using namespace softgrain;
using namespace softgrain::test;

static_assert(HistoryLaw<VonMises, 2> && HistoryLaw<VonMises, 3>);
static_assert(!ElasticLaw<VonMises, 2> && !HistoryLaw<Hencky, 2>);

namespace {

using State = VonMises::State<double>;

const VonMises law = von_mises(E, nu, 0.05, 0.3);

/// A point that has flowed along two different axes, in plane strain: F_p^-1 is not symmetric.
State flowed() {
  const State once = law.advance(Mat<2>{{1.25, 0.3, -0.1, 0.9}}, State{});
  return law.advance(Mat<2>{{0.9, -0.2, 0.4, 1.3}}, once);
}

/// Shear at constant volume: stretches exp(x), exp(-x), 1.
Mat<2> pure_shear(double x) { return Mat<2>::diagonal({std::exp(x), std::exp(-x)}); }

/// tau = P F^T [Pa].
Mat<2> kirchhoff(const VonMises& l, const Mat<2>& F, const State& state) {
  return l.stress(F, state) * transpose(F);
}

template <int Dim>
void check_derivatives() {
  int flowing = 0;
  for (const Mat<Dim>& F : sample_deformations<Dim>()) {
    const State state = flowed();
    flowing += law.advance(F, state).plastic_strain > state.plastic_strain ? 1 : 0;
    const auto energy = [&](const Mat<Dim>& G) { return law.energy(G, state); };
    const auto stress = [&](const Mat<Dim>& G) { return law.stress(G, state); };
    const Mat<Dim* Dim> A = law.tangent(F, state);
    CHECK(difference(law.stress(F, state), gradient(energy, F)) < 1e-9);
    CHECK(difference(A, gradient_of_stress(stress, F)) < 1e-8);
    CHECK(difference(A, transpose(A)) < 1e-13 * largest_entry(A));
  }
  CHECK(flowing > 3);
}

}  // namespace

TEST_CASE("below yield, and under any pressure, a von Mises point is a Hencky point") {
  const Hencky elastic = hencky(E, nu);
  for (const Mat<2>& F : {pure_shear(0.01), Mat<2>{{1.01, 0.02, -0.01, 1.01}}}) {
    CHECK(difference(law.stress(F, State{}), elastic.stress(F)) < 1e-15);
    CHECK(difference(law.tangent(F, State{}), elastic.tangent(F)) < 1e-14);
    CHECK(law.energy(F, State{}) == doctest::Approx(elastic.energy(F)).epsilon(1e-13));
    CHECK(law.advance(F, State{}).plastic_strain == 0);
  }
  const Mat<3> pressed = Mat<3>::diagonal({0.5, 0.5, 0.5});
  CHECK(law.advance(pressed, State{}).plastic_strain == 0);
  CHECK(difference(law.stress(pressed, State{}), elastic.stress(pressed)) < 1e-14);
}

TEST_CASE("a von Mises point yields in shear at the yield stress over root three") {
  const VonMises perfect = von_mises(E, nu, 0.05, 0);
  for (const double x : {0.05, 0.2, 0.7}) {
    const Mat<2> tau = kirchhoff(perfect, pure_shear(x), State{});
    CHECK(tau(0, 0) == doctest::Approx(0.05 / std::sqrt(3.0)).epsilon(1e-13));
    CHECK(tau(1, 1) == doctest::Approx(-0.05 / std::sqrt(3.0)).epsilon(1e-13));
  }
}

TEST_CASE("with hardening the shear stress rises by the tangent modulus") {
  // d tau/dx = 2 mu H / (3 mu + H) beyond yield at x_y = yield / (2 root(3) mu).
  const double mu = 2 / 2.6, H = 0.3, at_yield = 0.05 / std::sqrt(3.0);
  const double x = 0.3, beyond = x - at_yield / (2 * mu);
  const State after = law.advance(pure_shear(x), State{});
  CHECK(kirchhoff(law, pure_shear(x), State{})(0, 0) ==
        doctest::Approx(at_yield + 2 * mu * H / (3 * mu + H) * beyond).epsilon(1e-13));
  CHECK(after.plastic_strain ==
        doctest::Approx(2 * std::sqrt(3.0) * mu / (3 * mu + H) * beyond).epsilon(1e-13));
}

TEST_CASE("stress and tangent of a point that has flowed are derivatives of its incremental potential") {
  check_derivatives<2>();
  check_derivatives<3>();
}

TEST_CASE("flow keeps the volume, and the state after a step holds the stress of its end") {
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}};
  const State before = flowed(), after = law.advance(F, before);
  CHECK(determinant(after.inverse_plastic) == doctest::Approx(1).epsilon(1e-14));
  CHECK(after.plastic_strain > before.plastic_strain);
  CHECK(difference(law.stress(F, after), law.stress(F, before)) < 1e-14);
  CHECK(law.advance(F, after).plastic_strain == doctest::Approx(after.plastic_strain).epsilon(1e-14));
}

TEST_CASE("unloading is elastic and leaves a permanent strain") {
  const double mu = 2 / 2.6, x = 0.3;
  const State after = law.advance(pure_shear(x), State{});
  const double loaded = kirchhoff(law, pure_shear(x), after)(0, 0), back = loaded / (2 * mu);
  CHECK(std::abs(kirchhoff(law, pure_shear(x - back), after)(0, 0)) < 1e-14);
  CHECK(kirchhoff(law, pure_shear(x - back / 2), after)(0, 0) == doctest::Approx(loaded / 2).epsilon(1e-12));
}

TEST_CASE("a cycle of shear dissipates the yield stress times the plastic strain, and never gives work") {
  const VonMises perfect = von_mises(E, nu, 0.05, 0);
  State state;
  double work = 0;
  constexpr int steps = 4000;
  const auto strain = [](int k) { return 0.2 * std::sin(2 * 3.14159265358979324 * k / steps); };
  for (int k = 0; k < steps; ++k) {
    const Mat<2> start = pure_shear(strain(k)), end = pure_shear(strain(k + 1));
    const State next = perfect.advance(end, state);
    work += contract(0.5 * (perfect.stress(start, state) + perfect.stress(end, next)), end - start);
    state = next;
  }
  // At F = 1 the elastic part is F_p^-1: what is still stored there.
  const double left = hencky(E, nu).energy(state.inverse_plastic);
  CHECK(state.plastic_strain > 0.8);
  CHECK(work - left == doctest::Approx(0.05 * state.plastic_strain).epsilon(1e-4));
}

TEST_CASE("a rotated point flows alike and has the rotated stress") {
  const State state = flowed();
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}}, Q = sample_rotation<2>(2);
  CHECK(law.energy(Q * F, state) == doctest::Approx(law.energy(F, state)).epsilon(1e-13));
  CHECK(difference(law.stress(Q * F, state), Q * law.stress(F, state)) < 1e-14);
}

TEST_CASE("eight plastic points at once flow as each does alone") {
  const auto samples = sample_deformations<2>();
  Mat<2, Wide> F;
  for (int lane = 0; lane < Wide::size; ++lane)
    for (std::size_t k = 0; k < F.c.size(); ++k)
      F.c[k].set(lane, samples[static_cast<std::size_t>(lane)].c[k]);
  const auto state = law.advance(F, VonMises::State<Wide>{});
  const Mat<2, Wide> P = law.stress(F, state);
  for (int lane = 0; lane < Wide::size; ++lane) {
    const Mat<2>& alone = samples[static_cast<std::size_t>(lane)];
    const State expected = law.advance(alone, State{});
    CHECK(state.plastic_strain[lane] == doctest::Approx(expected.plastic_strain).epsilon(1e-13));
    CHECK(P(0, 1)[lane] == doctest::Approx(law.stress(alone, expected)(0, 1)).epsilon(1e-12));
  }
}

TEST_CASE("plastic parameters out of range are refused by name") {
  CHECK_THROWS_WITH_AS(von_mises(E, nu, 0, 0), "the yield stress must be > 0 Pa, got 0", UsageError);
  CHECK_THROWS_WITH_AS(von_mises(E, nu, 1, -1), "the hardening modulus must be >= 0 Pa, got -1", UsageError);
  CHECK_THROWS_AS(von_mises(E, 0.5, 1, 0), UsageError);
}
