#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "softgrain/contact/law.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

/// A contact with W = diag(W_nn, W_tt, ...), its impulse and its velocity.
template <int Dim>
struct Problem {
  Vec<Dim> p, u;
  double W_nn, W_tt, mu;

  explicit Problem(test::RandomNumbers& random) : u(random.vector<Dim>(1)) {
    mu = random.uniform(0, 1) < 0.2 ? 0 : random.uniform(0, 1.5);
    p = project_on_coulomb_cone(random.vector<Dim>(1), mu);
    W_nn = random.uniform(0.1, 10);
    W_tt = random.uniform(0.1, 10);
  }
  Vec<Dim> solved(double omega) const {
    return solve_uncoupled<Dim, double>(p, u, omega / W_nn, omega / W_tt, mu);
  }
};

template <int Dim>
double slip_length(const Vec<Dim>& a) {
  double square = 0;
  for (int k = 1; k < Dim; ++k) square += a[k] * a[k];
  return std::sqrt(square);
}

/// The laws themselves, for the velocity that the new impulse leaves.
template <int Dim>
void check_laws(const Problem<Dim>& problem) {
  const Vec<Dim> p = problem.solved(1);
  Vec<Dim> u = problem.u;
  u[0] += problem.W_nn * (p[0] - problem.p[0]);
  for (int k = 1; k < Dim; ++k) u[k] += problem.W_tt * (p[k] - problem.p[k]);
  constexpr double round_off = 1e-13;
  CHECK(p[0] >= 0);
  CHECK(u[0] >= -round_off);
  CHECK(std::abs(u[0] * p[0]) < round_off);
  const double most = problem.mu * p[0], carried = slip_length(p);
  CHECK(carried <= most + round_off);
  if (carried < most - round_off)
    CHECK(slip_length(u) < round_off);  // it sticks
  else
    for (int k = 1; k < Dim; ++k)  // it slides against its impulse
      CHECK(p[k] * slip_length(u) == doctest::Approx(-carried * u[k]).epsilon(1e-9));
}

template <class T>
T lanes_from(const double* numbers) {
  T lanes{};
  if constexpr (std::is_same_v<T, Wide>)
    for (int k = 0; k < Wide::size; ++k) lanes.set(k, numbers[k]);
  else
    for (int k = 0; k < lanes_of<T>; ++k) lanes[k] = static_cast<float>(numbers[k]);
  return lanes;
}

/// Eight contacts in lanes of T, beside each of them alone; numbers that a float holds.
template <class T>
void check_lanes(double most_apart) {
  double p_n[8], p_t[8], u_n[8], u_t[8], gain_n[8], gain_t[8], mu[8];
  test::RandomNumbers random(5);
  for (int k = 0; k < 8; ++k) {
    for (double* number : {&u_n[k], &u_t[k], &p_t[k]}) *number = static_cast<float>(random.uniform(-1, 1));
    for (double* number : {&p_n[k], &gain_n[k], &gain_t[k], &mu[k]})
      *number = static_cast<float>(random.uniform(0, 1));
  }
  const auto of = [](const double* numbers) { return lanes_from<T>(numbers); };
  const Vec<2, T> p{of(p_n), of(p_t)}, u{of(u_n), of(u_t)};
  const Vec<2, T> solved = solve_uncoupled(p, u, of(gain_n), of(gain_t), of(mu));
  LaneViolation<T> in_lanes;
  LaneViolation<double> alone;
  in_lanes.add(solved - p, solved[0]);
  for (int k = 0; k < lanes_of<T>; ++k) {
    const Vec<2> one{p_n[k], p_t[k]};
    const Vec<2> expected = solve_uncoupled<2, double>(one, {u_n[k], u_t[k]}, gain_n[k], gain_t[k], mu[k]);
    CHECK(std::abs(lane_of(solved[0], k) - expected[0]) <= most_apart);
    CHECK(std::abs(lane_of(solved[1], k) - expected[1]) <= most_apart);
    alone.add(expected - one, expected[0]);
  }
  const Violation a = in_lanes.total(1), b = alone.total(1);
  CHECK(a.contacts == b.contacts);
  CHECK(std::abs(a.sum_of_squares - b.sum_of_squares) <= 8 * most_apart);
  CHECK(std::abs(a.max_square - b.max_square) <= 8 * most_apart);
}

}  // namespace

TEST_CASE("the impulse of a contact without coupling obeys Signorini's and Coulomb's laws") {
  test::RandomNumbers random(3);
  for (int k = 0; k < 500; ++k) {
    check_laws(Problem<2>(random));
    check_laws(Problem<3>(random));
  }
}

TEST_CASE("each lane of the law has the bits of a contact alone") {
  check_lanes<Lanes>(0);
  check_lanes<Wide>(0);
  check_lanes<Narrow::Floats>(1e-6);  // in single precision
}

TEST_CASE("a turn with relaxation ends inside the cone, and omega times as far where nothing stops it") {
  test::RandomNumbers random(4);
  for (int k = 0; k < 200; ++k) {
    const Problem<3> problem(random);
    const Vec<3> p = problem.solved(1.4);
    CHECK(p[0] >= 0);
    CHECK(slip_length(p) <= problem.mu * p[0] * (1 + 1e-14));
    const Vec<3> by_solution = relaxed_impulse(problem.p, problem.solved(1), problem.mu, 1.4);
    CHECK(slip_length(by_solution) <= problem.mu * by_solution[0] * (1 + 1e-14));
  }
  CHECK(normal_impulse(2.0, 1.0, 1.4 / 4) == doctest::Approx(2 - 1.4 / 4));
  CHECK(relaxed_impulse(Vec<2>{2, 0}, Vec<2>{1, 0}, 0, 0.5) == Vec<2>{1.5, 0});
}

TEST_CASE("the violation of a turn is the jump without relaxation, and NaN is not lost in any lane") {
  LaneViolation<Lanes> lanes;
  lanes.add(Vec<2, Lanes>{Lanes{3, 0, 0, 0}, Lanes{4, 0, 0, 0}}, Lanes{1, 1, 0, 0});
  const Violation violation = lanes.total(2);
  CHECK(violation.sum_of_squares == 25.0 / 4);
  CHECK(violation.max_square == 25.0 / 4);
  CHECK(violation.contacts == 2);  // the second carries impulse, the others neither
  lanes.add(Vec<1, Lanes>{Lanes{0, std::numeric_limits<double>::quiet_NaN(), 0, 0}}, Lanes{});
  CHECK(std::isnan(lanes.total(2).sum_of_squares));
  CHECK(std::isnan(normal_impulse(1.0, std::numeric_limits<double>::quiet_NaN(), 1.0)));
}
