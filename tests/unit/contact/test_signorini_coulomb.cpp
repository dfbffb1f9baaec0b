#include <doctest/doctest.h>

#include "softgrain/contact/signorini_coulomb.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

template <int Dim>
Eigen::VectorXd eigen(const Vec<Dim>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.c.data(), Dim);
}

/// Solves one contact and holds the answer against every sentence of the law.
template <int Dim>
void check_law(const Mat<Dim>& W, const Vec<Dim>& q, double mu, double tolerance) {
  const Vec<Dim> p = solve_signorini_coulomb(W, q, mu);
  const Vec<Dim> u = W * p + q;
  Eigen::MatrixXd dense(Dim, Dim);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) dense(i, j) = W(i, j);
  CAPTURE(mu);
  const LawDefects defects = law_defects(problem_of(Dim, dense, eigen(q), mu), eigen(p), eigen(u));
  CHECK(defects.worst() <= tolerance * (norm(q) + dense.norm() * norm(p)));  // round-off of u = W p + q
  CHECK(dot(p, u + q) <= 0);  // dissipation: 1/2 p.(u + q) is the energy that the impulse adds
}

/// Positive definite, all components coupled, with condition numbers up to 1e8.
template <int Dim>
Mat<Dim> random_block(RandomNumbers& random) {
  Mat<Dim> A, W;
  for (double& a : A.c) a = random.uniform(-1, 1);
  const double thin = std::pow(10, random.uniform(-4, 0));
  for (int k = 0; k < Dim; ++k) A(Dim - 1, k) *= thin;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      for (int k = 0; k < Dim; ++k) W(i, j) += A(i, k) * A(j, k);
  return W;
}

const Mat<2> coupled{{2, 0.5, 0.5, 3}};

}  // namespace

TEST_CASE("a contact that opens by itself carries no impulse") {
  CHECK(solve_signorini_coulomb(coupled, Vec<2>{1e-9, -5}, 0.3) == Vec<2>{});
  CHECK(solve_signorini_coulomb(Mat<3>::diagonal({1, 1, 1}), Vec<3>{0, 1, 2}, 0.3) == Vec<3>{});
}

TEST_CASE("a contact without friction is stopped by p_n = -q_n / W_nn, whatever its tangent does") {
  CHECK(solve_signorini_coulomb(coupled, Vec<2>{-1, 7}, 0) == Vec<2>{0.5, 0});
  const Vec<3> p = solve_signorini_coulomb(Mat<3>{{4, 1, 1, 1, 3, 0, 1, 0, 3}}, Vec<3>{-1, 7, 7}, 0);
  CHECK(p == Vec<3>{0.25, 0, 0});
}

TEST_CASE("a contact whose impulse lies in the cone sticks: p = -W^-1 q") {
  const Vec<2> p = solve_signorini_coulomb(coupled, Vec<2>{-1, 0.1}, 0.3);
  CHECK(p[0] == doctest::Approx(3.05 / 5.75).epsilon(1e-14));  // by Cramer's rule, det W = 5.75
  CHECK(p[1] == doctest::Approx(-0.7 / 5.75).epsilon(1e-14));
}

TEST_CASE("a contact beyond the cone slides against u_t, with the coupling of normal and tangent") {
  // the same contact with mu = 0.2 < 0.7/3.05: p_t = -mu p_n, u_n = 2 p_n - 0.5 mu p_n - 1 = 0
  const Vec<2> p = solve_signorini_coulomb(coupled, Vec<2>{-1, 0.1}, 0.2);
  CHECK(p[0] == doctest::Approx(1 / 1.9).epsilon(1e-14));
  CHECK(p[1] == doctest::Approx(-0.2 / 1.9).epsilon(1e-14));
}

TEST_CASE("a sphere slides along its velocity: p_t = -mu p_n q_t / |q_t|") {
  const Vec<3> p = solve_signorini_coulomb(Mat<3>::diagonal({1, 3.5, 3.5}), Vec<3>{-1, 3, 4}, 0.5);
  CHECK(p[0] == doctest::Approx(1).epsilon(1e-14));
  CHECK(p[1] == doctest::Approx(-0.5 * 0.6).epsilon(1e-14));
  CHECK(p[2] == doctest::Approx(-0.5 * 0.8).epsilon(1e-14));
}

TEST_CASE("a contact in space that moves in a plane does what the plane's contact does") {
  for (const double mu : {0.1, 0.2, 0.3}) {
    const Vec<2> plane = solve_signorini_coulomb(coupled, Vec<2>{-1, 0.1}, mu);
    const Mat<3> W{{2, 0, 0.5, 0, 7, 0, 0.5, 0, 3}};  // the plane is (n, t2)
    const Vec<3> space = solve_signorini_coulomb(W, Vec<3>{-1, 0, 0.1}, mu);
    CHECK(space[0] == doctest::Approx(plane[0]).epsilon(1e-13));
    CHECK(space[1] == 0);
    CHECK(space[2] == doctest::Approx(plane[1]).epsilon(1e-13));
  }
}

TEST_CASE("one contact obeys Signorini and Coulomb for any positive definite W, mu and q") {
  RandomNumbers random(3);
  for (int k = 0; k < 20000; ++k) {
    const double mu = k % 5 == 0 ? 0 : std::pow(10, random.uniform(-2, 1));
    check_law<2>(random_block<2>(random), random.vector<2>(1), mu, 1e-11);
    check_law<3>(random_block<3>(random), random.vector<3>(1), mu, 1e-11);
  }
}

TEST_CASE(
    "one contact slides where W is indefinite in its tangent, and no W yields anything but finite impulses") {
  check_law<2>(Mat<2>{{1, 0.2, 0.2, -0.5}}, Vec<2>{-1, 0.3}, 0.4, 1e-14);
  check_law<3>(Mat<3>{{1, 0.2, 0, 0.2, -0.5, 0, 0, 0, 1}}, Vec<3>{-1, 0.3, 0.1}, 0.4, 1e-12);
  RandomNumbers random(4);
  for (int k = 0; k < 20000; ++k) {
    Mat<3> W;
    for (double& w : W.c) w = random.uniform(-1, 1);
    const Vec<3> p = solve_signorini_coulomb(W, random.vector<3>(1), random.uniform(0, 2));
    CHECK(std::isfinite(dot(p, p)));
    const Vec<2> plane =
        solve_signorini_coulomb(Mat<2>{{W(0, 0), W(0, 1), W(1, 0), W(1, 1)}}, random.vector<2>(1), 0.8);
    CHECK(std::isfinite(dot(plane, plane)));
  }
  CHECK(solve_signorini_coulomb(Mat<2>{}, Vec<2>{-1, 1}, 0.5) == Vec<2>{});  // two immovable bodies
}

TEST_CASE("the projection on the Coulomb cone is the nearest of its points") {
  RandomNumbers random(5);
  for (int k = 0; k < 200; ++k) {
    const double mu = random.uniform(0, 2);
    const Vec<3> p = random.vector<3>(1), nearest = project_on_coulomb_cone(p, mu);
    CHECK(std::hypot(nearest[1], nearest[2]) <= mu * nearest[0] * (1 + 1e-14));
    for (int other = 0; other < 50; ++other) {
      const double normal = random.uniform(0, 2), along = random.uniform(0, mu * normal);
      const Vec<2> t = random.unit_vector<2>();
      CHECK(norm(p - nearest) <= norm(p - Vec<3>{normal, along * t[0], along * t[1]}) + 1e-14);
    }
  }
}
