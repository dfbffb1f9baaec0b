#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/io/format/fclib.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

FclibFile read(const std::string& name) {
  return read_fclib(std::filesystem::path(SOFTGRAIN_TEST_DATA) / "contact" / (name + ".hdf5"));
}

/// Natural-map residual over |q|, written from Siconos' definition: p - P(p - (u + mu |u_t| n)) contact by
/// contact.
double siconos_error(const ContactProblem& problem, const Eigen::VectorXd& p, const Eigen::VectorXd& u) {
  const int dimension = problem.dimension;
  double sum = 0;
  for (int c = 0; c < problem.contacts(); ++c) {
    const double mu = problem.friction[static_cast<std::size_t>(c)];
    const Eigen::VectorXd p_c = p.segment(dimension * c, dimension),
                          u_c = u.segment(dimension * c, dimension);
    Eigen::VectorXd z = p_c - u_c;
    z[0] -= mu * u_c.tail(dimension - 1).norm();
    const double normal = z[0], tangential = z.tail(dimension - 1).norm();
    if (mu * tangential <= -normal) {
      z.setZero();
    } else if (tangential > mu * normal) {
      z[0] = (mu * tangential + normal) / (mu * mu + 1);
      z.tail(dimension - 1) *= mu * z[0] / tangential;
    }
    sum += (p_c - z).squaredNorm();
  }
  return std::sqrt(sum) / vector_of(problem.q).norm();
}

struct Problem {
  const char* name;
  int dimension, contacts;
  double tolerance;
};

constexpr Problem problems[] = {
    {"FrictionContactProblem00071", 2, 89, 1e-12},
    {"FrictionContactProblem00237", 2, 376, 1e-12},
    {"fc2d_granularflowonwall_02020_00213", 2, 2020, 1e-5},  // W is indefinite
    {"local_problem_test", 3, 48, 1e-8},
    {"LMGC_100_PR_PerioBox-i00361-60-03000", 3, 60, 1e-8},
    {"Box_Stacks-i0122-82-5", 3, 82, 1e-8},
};

}  // namespace

TEST_CASE("Nesterov's method, the default, solves every stored problem to the accuracy asked for") {
  for (const Problem& expected : problems) {
    CAPTURE(expected.name);
    const ContactProblem problem = read(expected.name).problem;
    REQUIRE(problem.dimension == expected.dimension);
    REQUIRE(problem.contacts() == expected.contacts);
    const ContactSolution solution = solve_contact_problem(problem, {.tolerance = expected.tolerance});
    CHECK(solution.converged);
    const Eigen::VectorXd p = vector_of(solution.impulse);
    const Eigen::VectorXd Wp = dense_W(problem) * p, q = vector_of(problem.q), u = Wp + q;
    CHECK((u - vector_of(solution.velocity)).norm() <= 1e-13 * (Wp.norm() + q.norm()));
    CHECK(siconos_error(problem, p, u) <= expected.tolerance);
    CHECK(solution.residual == doctest::Approx(siconos_error(problem, p, u)).epsilon(1e-2));
    CHECK(solution.energy == doctest::Approx(p.dot(Wp) / 2 + q.dot(p)).epsilon(1e-9));
  }
}

TEST_CASE("NLGS and Nesterov find the same velocities and energy where both reach 1e-12") {
  for (const char* name : {"FrictionContactProblem00071", "FrictionContactProblem00237",
                           "LMGC_100_PR_PerioBox-i00361-60-03000", "Box_Stacks-i0122-82-5"}) {
    CAPTURE(name);
    const ContactProblem problem = read(name).problem;
    const ContactSolution a =
        solve_contact_problem(problem, {.method = ContactMethod::nlgs, .tolerance = 1e-12});
    const ContactSolution b =
        solve_contact_problem(problem, {.method = ContactMethod::nesterov, .tolerance = 1e-12});
    CHECK(a.converged);
    CHECK(b.converged);
    CHECK((vector_of(a.velocity) - vector_of(b.velocity)).norm() < 1e-9 * vector_of(problem.q).norm());
    CHECK(a.energy == doctest::Approx(b.energy).epsilon(1e-9));
  }
}

TEST_CASE("what converges does not depend on the unit of impulse, nor in how many sweeps") {
  for (const char* name : {"FrictionContactProblem00071", "LMGC_100_PR_PerioBox-i00361-60-03000"})
    for (const ContactMethod method : {ContactMethod::nesterov, ContactMethod::nlgs}) {
      CAPTURE(name);
      const ContactProblem problem = read(name).problem;
      const ContactSolution solution = solve_contact_problem(problem, {.method = method});
      for (const double unit : {1e-9, 1e9}) {  // impulses in 1e9 and 1e-9 N s
        ContactProblem scaled = problem;
        for (MatrixEntry& entry : scaled.W) entry.value *= unit;
        const ContactSolution other = solve_contact_problem(scaled, {.method = method});
        CHECK(other.converged);
        CHECK(other.sweeps == solution.sweeps);
        CHECK((vector_of(other.velocity) - vector_of(solution.velocity)).norm() <
              1e-7 * vector_of(problem.q).norm());
        CHECK(unit * vector_of(other.impulse).norm() == doctest::Approx(vector_of(solution.impulse).norm()));
      }
    }
}

TEST_CASE("the default tries the other method before it gives up: friction coefficients of 5 to 100") {
  for (const double mu : {5.0, 10.0, 100.0}) {
    CAPTURE(mu);
    ContactProblem problem = read("FrictionContactProblem00071").problem;
    problem.friction.assign(problem.friction.size(), mu);
    const ContactSolution solution = solve_contact_problem(problem, {});
    CHECK(solution.converged);
    CHECK(solution.method == ContactMethod::nlgs);
    const Eigen::VectorXd p = vector_of(solution.impulse);
    CHECK(siconos_error(problem, p, dense_W(problem) * p + vector_of(problem.q)) < 1.1e-8);
  }
  const ContactSolution hopeless =
      solve_contact_problem(read("FrictionContactProblem00071").problem, {.tolerance = 0, .max_sweeps = 30});
  CHECK_FALSE(hopeless.converged);
  CHECK(hopeless.sweeps == 30);
}

TEST_CASE("NLGS needs no more sweeps than Siconos' NSGS does") {
  struct Rival {
    const char* name;
    double tolerance;
    int sweeps;
  };
  for (const Rival& rival :
       {Rival{"FrictionContactProblem00071", 1e-8, 66}, Rival{"FrictionContactProblem00071", 1e-5, 35},
        Rival{"FrictionContactProblem00237", 1e-8, 343}, Rival{"FrictionContactProblem00237", 1e-5, 183},
        Rival{"fc2d_granularflowonwall_02020_00213", 1e-5, 806}}) {
    CAPTURE(rival.name);
    const ContactProblem problem = read(rival.name).problem;
    const ContactSolution solution = solve_contact_problem(
        problem, {.method = ContactMethod::nlgs, .tolerance = 0, .max_sweeps = rival.sweeps + 9});
    CHECK(siconos_error(problem, vector_of(solution.impulse), vector_of(solution.velocity)) <=
          rival.tolerance);  // we look every 10 sweeps only
  }
}

TEST_CASE("the velocities are those that the files store as their solution") {
  // The stored impulses are all zero. The velocities come from ADMM at 1e-16 and from NSGS at 1e-8.
  struct Stored {
    const char* name;
    double accuracy;
  };
  for (const Stored& stored : {Stored{"Box_Stacks-i0122-82-5", 1e-11}, Stored{"local_problem_test", 2e-5}}) {
    CAPTURE(stored.name);
    const FclibFile file = read(stored.name);
    REQUIRE(file.stored_velocity.size() == file.problem.q.size());
    const ContactSolution solution = solve_contact_problem(file.problem, {.tolerance = 1e-12});
    const Eigen::VectorXd difference = vector_of(solution.velocity) - vector_of(file.stored_velocity);
    CHECK(difference.norm() <= stored.accuracy * vector_of(file.problem.q).norm());
  }
}
