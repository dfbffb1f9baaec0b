#include <doctest/doctest.h>

#include <array>
#include <limits>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/contact/residual.hpp"

using namespace softgrain;

TEST_CASE("the natural map of one contact is what pencil and paper give") {
  const std::array<double, 1> mu{0.5};
  const auto residual = [&](Vec<2> p, Vec<2> u) {
    const std::array<Vec<2>, 1> impulse{p}, velocity{u};
    return natural_map_residual<2>(std::span<const Vec<2>>(impulse), std::span<const Vec<2>>(velocity), mu);
  };
  CHECK(residual({0, 0}, {2, 7}) == 0);                                    // open
  CHECK(residual({3, 1}, {0, 0}) == 0);                                    // sticks
  CHECK(residual({2, -1}, {0, 4}) == doctest::Approx(0));                  // slides
  CHECK(residual({0, 0}, {-2, 0}) == doctest::Approx(2));                  // penetrates: p - P(2, 0)
  CHECK(residual({3, 0}, {1, 0}) == doctest::Approx(1));                   // pushes while open: p - (2, 0)
  CHECK(residual({2, 1}, {0, 4}) == doctest::Approx(0.8 * std::sqrt(5)));  // slides forward: p - P(0, -3)
}

TEST_CASE("NaN in one contact is not lost in the report") {
  Violation violation;
  violation.add(Vec<1>{1}, 1);
  violation.add(Vec<1>{std::numeric_limits<double>::quiet_NaN()}, 1);
  violation.add(Vec<1>{2}, 1);
  const SolverReport report = report_of(violation, 1, 1, {});
  CHECK(!std::isfinite(report.residual_mean));
  CHECK(!report.converged);
}

TEST_CASE("contacts without impulse and without violation do not dilute the mean") {
  Violation violation;
  violation.add(Vec<1>{2}, 1);
  for (int c = 0; c < 99; ++c) violation.add(Vec<1>{}, 0);
  violation.add(Vec<1>{}, 1);
  const SolverReport report = report_of(violation, 1, 1, {});
  CHECK(report.residual_mean == doctest::Approx(std::sqrt(2)));
  CHECK(report.residual_max == doctest::Approx(2));
}

TEST_CASE("one disk on a floor loses its kinetic energy, m v^2 / 2, to the contact") {
  const double m = 2, v = 3;
  ContactProblem problem{
      .dimension = 2, .W = {{0, 0, 1 / m}, {1, 1, 3 / m}}, .q = {-v, 0}, .friction = {0.3}};
  const ContactSolution solution = solve_contact_problem(problem, {});
  CHECK(solution.energy == doctest::Approx(-m * v * v / 2).epsilon(1e-7));
  CHECK(solution.impulse[0] == doctest::Approx(m * v).epsilon(1e-7));
}

TEST_CASE("a problem that cannot be solved comes back as its best iterate, not converged") {
  // W_nn = 0: no impulse can stop the approach
  ContactProblem problem{.dimension = 2, .W = {}, .q = {-1, 0}, .friction = {0.3}};
  for (const ContactMethod method : {ContactMethod::nesterov, ContactMethod::nlgs}) {
    const ContactSolution solution = solve_contact_problem(problem, {.method = method});
    CHECK(!solution.converged);
    CHECK(solution.residual == doctest::Approx(1));
    CHECK(solution.sweeps < 100000);  // gives up early
  }
}

TEST_CASE("no contact at all is a solved problem") {
  const ContactSolution solution =
      solve_contact_problem({.dimension = 3, .W = {}, .q = {}, .friction = {}}, {});
  CHECK(solution.converged);
  CHECK(solution.sweeps == 0);
  CHECK(solution.energy == 0);
}
