#include "softgrain/contact/adhesion.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/contact/adhesive_contacts.hpp"
#include "softgrain/contact/delassus_system.hpp"
#include "softgrain/contact/fixed_point.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

constexpr Adhesion glue{.surface_energy = 0.05, .range = 2e-6};

/// Integral of the traction from a gap to another [J/m^2], by the midpoint rule.
double work_of_traction(double from, double to) {
  constexpr int parts = 20000;
  double sum = 0;
  for (int k = 0; k < parts; ++k) sum += glue.traction(from + (to - from) * (k + 0.5) / parts);
  return sum * (to - from) / parts;
}

}  // namespace

TEST_CASE("the surface energy is what it takes to part the surfaces, wherever they begin") {
  CHECK(work_of_traction(0, glue.range) == doctest::Approx(glue.surface_energy).epsilon(1e-6));
  CHECK(glue.energy(0) == -glue.surface_energy);
  CHECK(glue.energy(3 * glue.range) == 0);
  CHECK(glue.traction(0) == glue.strength());
  CHECK(glue.traction(1.5 * glue.range) == 0);
  for (const double from : {-1e-7, 0.0, 3e-7, 1.2e-6})
    CHECK(work_of_traction(from, 2 * glue.range) == doctest::Approx(-glue.energy(from)).epsilon(1e-4));
}

TEST_CASE("the mean traction of a motion does the work of the traction along it, both ways") {
  for (const double from : {-2e-7, 0.0, 1e-9, 6e-7, 1.9e-6, 2.5e-6})
    for (const double to : {-3e-7, 0.0, 2e-7, 6e-7 + 1e-12, 1.7e-6, 2e-6, 3.1e-6}) {
      CAPTURE(from);
      CAPTURE(to);
      CHECK(glue.mean_traction(from, to) * (to - from) ==
            doctest::Approx(work_of_traction(from, to)).epsilon(1e-4).scale(1e-6));
    }
}

TEST_CASE("contacts that adhere obey the laws of Signorini, Coulomb and adhesion") {
  constexpr int contacts = 8;
  const double dt = 1e-6;
  for (const bool at_end : {false, true})
    for (const bool ahead : {false, true})
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        const ContactProblem problem = random_problem(2, contacts, 0.3, seed);
        std::vector<Vec<2>> q;
        for (std::size_t k = 0; k < problem.q.size(); k += 2) q.push_back({problem.q[k], problem.q[k + 1]});
        AdhesiveContacts adhesion;
        std::vector<double> attraction(contacts);
        adhesion.attraction = attraction;
        for (int c = 0; c < contacts; ++c)  // soft enough for a unique solution; two contacts do not adhere
          adhesion.contact.push_back({.law = glue,
                                      .pull = c % 4 == 3 ? 0 : 0.02 / glue.strength(),
                                      .gap = 4e-7 * c,
                                      .dt = dt,
                                      .at_end = at_end});
        DelassusSystem<2> system(problem.W, q);
        std::vector<Vec<2>> p(contacts);
        PushedBodies none;
        const SolverOptions tight{
            .max_sweeps = 50000, .tolerance = 1e-13, .velocity_scale = 1, .extrapolated = ahead};
        CHECK(solve_adhesive<2>(system, adhesion, none, std::span(p), problem.friction, tight).converged);

        Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(problem.q.data(), 2 * contacts);
        for (const MatrixEntry& entry : problem.W) {  // u = q + W (p_n - a, p_t)
          const auto b = static_cast<std::size_t>(entry.column / 2);
          u[entry.row] +=
              entry.value * (p[b][entry.column % 2] - (entry.column % 2 == 0 ? attraction[b] : 0));
        }
        for (int c = 0; c < contacts; ++c) {
          CAPTURE(c);
          const double gap = dt * u[2 * c], pull = adhesion.contact[c].pull;
          CHECK(gap > -1e-17);
          CHECK(std::min(p[c][0], gap / dt) < 1e-10);
          CHECK(std::abs(p[c][1]) <= 0.3 * p[c][0] + 1e-12);
          if (std::abs(p[c][1]) < 0.3 * p[c][0] - 1e-9) CHECK(std::abs(u[2 * c + 1]) < 1e-10);
          const double traction =
              at_end ? glue.traction(gap) : glue.mean_traction(adhesion.contact[c].gap, gap);
          CHECK(attraction[c] == doctest::Approx(pull * traction).epsilon(1e-9).scale(1e-12));
        }
      }
}

TEST_CASE(
    "a fixed point near the border of stability is found in some steps, where plain iteration needs "
    "hundreds") {
  Eigen::MatrixXd M(4, 4);  // symmetric, eigenvalues up to 0.99
  const double rate[4] = {0.99, 0.95, 0.5, 0.1};
  const Eigen::MatrixXd Q =
      (Eigen::MatrixXd(4, 4) << 1, 1, 1, 1, 1, -1, 1, -1, 1, 1, -1, -1, 1, -1, -1, 1).finished() / 2;
  M = Q.lazyProduct(Eigen::Map<const Eigen::VectorXd>(rate, 4).asDiagonal().toDenseMatrix())
          .eval()
          .lazyProduct(Q.transpose());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(4, 1, 2);
  const Eigen::VectorXd solution = (Eigen::MatrixXd::Identity(4, 4) - M).inverse() * b;
  Eigen::VectorXd a = Eigen::VectorXd::Zero(4);
  FixedPoint fixed_point;
  for (int k = 0; k < 8; ++k) {
    const Eigen::VectorXd r = M.lazyProduct(a) + b - a;
    fixed_point.improve({a.data(), 4}, {r.data(), 4});
  }
  CHECK((a - solution).norm() < 1e-9 * solution.norm());
}
