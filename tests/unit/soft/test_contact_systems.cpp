#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <vector>

#include "softgrain/contact/assemble.hpp"
#include "softgrain/contact/delassus_system.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/elastic_contacts.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/lumped_contacts.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double dt = 0.1;

/// Two coarse disks that overlap each other and a floor.
struct Scenery {
  Scenery()
      : grains({test::placed(test::disk(2), 1, {0, 0}), test::placed(test::disk(3), 1.1, {2.05, 0})},
               make_law(MaterialLaw::neo_hookean, 100, 0.3), 3) {
    test::shake(grains, 0.02);
    grains.gather_outline(outline.position);
    outline.start = outline.position;
    test::RandomNumbers random(4);
    for (Vec<2>& x : outline.start) x += random.vector<2>(0.01);
    outline.walls = {test::floor_at(-1)};
    outline.walls[0].velocity = {0.3, 0.2};
    outline.dt = dt;
    contacts = OutlineNeighbours().detect(grains, outline);
    for (int v = 0; v < grains.outline_size(); ++v) vectors.push_back(random.vector<2>(0.01));
  }
  SoftGrains grains;
  OutlineState outline;
  std::vector<OutlineContact> contacts;
  std::vector<Vec<2>> vectors;  // increments or velocities of the outline
};

/// H: the columns are contacts' local axes, the rows outline coordinates; its transpose takes velocities of
/// the outlines to those of the contacts.
Eigen::MatrixXd contact_map(const Scenery& s) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2 * s.grains.outline_size(), 2 * s.contacts.size());
  for (std::size_t c = 0; c < s.contacts.size(); ++c) {
    const OutlineContact& contact = s.contacts[c];
    const std::array<Vec<2>, 2> axis{contact.normal, Vec<2>{-contact.normal[1], contact.normal[0]}};
    for (int k = 0; k < 2; ++k)
      for (int d = 0; d < 2; ++d) {
        H(2 * contact.vertex + d, 2 * c + k) += axis[k][d];
        if (contact.wall >= 0) {  // x_1 + xi (x_2 - x_0)/2
          H(2 * contact.master[2] + d, 2 * c + k) += contact.share / 2 * axis[k][d];
          H(2 * contact.master[0] + d, 2 * c + k) -= contact.share / 2 * axis[k][d];
          continue;
        }
        for (std::size_t m = 0; m < 4; ++m)
          H(2 * contact.master[m] + d, 2 * c + k) -= contact.weights()[m] * axis[k][d];
      }
  }
  return H;
}

/// W by columns: the answer of all contacts to a unit impulse at each.
template <class System>
Eigen::MatrixXd delassus_by_impulses(System& system) {
  const int n = system.size();
  Eigen::MatrixXd W(2 * n, 2 * n);
  for (int c = 0; c < n; ++c)
    for (int k = 0; k < 2; ++k) {
      std::vector<Vec<2>> before;
      for (int b = 0; b < n; ++b) before.push_back(system.relative_velocity(b));
      Vec<2> unit;
      unit[k] = 1;
      system.apply_impulse(c, unit);
      for (int b = 0; b < n; ++b)
        for (int d = 0; d < 2; ++d) W(2 * b + d, 2 * c + k) = system.relative_velocity(b)[d] - before[b][d];
      system.apply_impulse(c, -unit);
    }
  return W;
}

template <class System>
void check_delassus(System& system, const Eigen::MatrixXd& W, double tolerance = 1e-12) {
  const Eigen::MatrixXd measured = delassus_by_impulses(system);
  const double scale = W.cwiseAbs().maxCoeff();
  CHECK((measured - W).cwiseAbs().maxCoeff() < tolerance * scale);
  for (int c = 0; c < system.size(); ++c) {
    const Mat<2> block = system.delassus_block(c);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) CHECK(std::abs(block(i, j) - W(2 * c + i, 2 * c + j)) < tolerance * scale);
  }
}

}  // namespace

TEST_CASE("the Delassus matrix of elastic grains is H^T A^-1 H / dt^2 of the whole grains") {
  const Scenery s;
  REQUIRE(s.contacts.size() >= 4);
  std::vector<OutlineCompliance> compliance;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(2 * s.grains.outline_size(), 2 * s.grains.outline_size());
  for (const GrainBatch& batch : s.grains.batches) {
    const ReferenceGrid& grid = batch.topology->grid;
    const int nodes = grid.nodes();
    BatchedCholesky A(batch.topology->pattern);
    A.clear();
    add_stiffness(s.grains, batch, A);
    for (int i = 0; i < nodes; ++i) {
      const Wide inertia = s.grains.node_mass(batch, i) * Wide(1 / (dt * dt));
      A.add(i, i, {inertia, 0.0, 0.0, inertia});
    }
    REQUIRE(A.factor() == 0);
    compliance.emplace_back(Wide::size * 4 * grid.outline_nodes() * grid.outline_nodes());
    A.kept_inverse(compliance.back());
    // the dense A = M/dt^2 + K of the batch's only grain, K by differences of the force
    Eigen::MatrixXd dense(2 * nodes, 2 * nodes);
    GrainBatch moved = batch;
    constexpr double step = 1e-5;
    for (int j = 0; j < 2 * nodes; ++j) {
      std::array<WideVectors, 2> force;
      for (const int side : {0, 1}) {
        moved.position[j / 2][j % 2] = batch.position[j / 2][j % 2] + Wide(side == 0 ? step : -step);
        internal_force(s.grains, moved, force[side]);
      }
      moved.position = batch.position;
      for (int i = 0; i < 2 * nodes; ++i)
        dense(i, j) = (force[0][i / 2][i % 2] - force[1][i / 2][i % 2])[0] / (2 * step);
      dense(j, j) += s.grains.node_mass(batch, j / 2)[0] / (dt * dt);
    }
    const int first = 2 * s.grains.outline_begin(batch.grain[0]), width = 2 * grid.outline_nodes();
    C.block(first, first, width, width) = dense.inverse().bottomRightCorner(width, width);
  }
  ElasticScratch scratch;
  ElasticContacts system(s.grains, s.contacts, compliance, s.vectors, dt, scratch);
  const Eigen::MatrixXd H = contact_map(s), W = H.transpose() * C * H / (dt * dt);
  const Eigen::MatrixXd measured = delassus_by_impulses(system);
  CHECK((measured - W).cwiseAbs().maxCoeff() < 1e-6 * W.cwiseAbs().maxCoeff());  // differences of the force
  // symmetric to the round-off of columns in single precision
  check_delassus(system, (measured + measured.transpose()) / 2, 1e-7);

  // u = (gap or slip + H^T du)/dt
  Eigen::VectorXd du(2 * s.grains.outline_size());
  for (int v = 0; v < s.grains.outline_size(); ++v)
    for (int d = 0; d < 2; ++d) du(2 * v + d) = s.vectors[v][d];
  const Eigen::VectorXd path = H.transpose() * du;
  for (int c = 0; c < system.size(); ++c) {
    CHECK(system.relative_velocity(c)[0] == doctest::Approx((s.contacts[c].gap + path(2 * c)) / dt));
    CHECK(system.relative_velocity(c)[1] == doctest::Approx((s.contacts[c].slip + path(2 * c + 1)) / dt));
  }
}

TEST_CASE("a sweep of elastic contacts has the same bits on any number of threads, and solves W p + q") {
  std::vector<GrainPlacement> placed;  // so many that threads share them
  const auto shape = test::disk(2);
  for (int g = 0; g < 240; ++g)
    placed.push_back(test::placed(shape, 1, {1.97 * (g % 20), 1.97 * (g / 20)}, {}, 0.3 * g));
  const SoftGrains grains(placed, make_law(MaterialLaw::neo_hookean, 100, 0.3), 3);
  OutlineState outline;
  grains.gather_outline(outline.position);
  outline.start = outline.position;
  outline.dt = dt;
  const std::vector<OutlineContact> contacts = OutlineNeighbours().detect(grains, outline);
  REQUIRE(contacts.size() > 1000);
  std::vector<OutlineCompliance> compliance;
  for (const GrainBatch& batch : grains.batches) {
    BatchedCholesky A(batch.topology->pattern);
    A.clear();
    add_stiffness(grains, batch, A);
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide inertia = grains.node_mass(batch, i) * Wide(1 / (dt * dt));
      A.add(i, i, {inertia, 0.0, 0.0, inertia});
    }
    REQUIRE(A.factor() == 0);
    const int nodes = batch.topology->grid.outline_nodes();
    compliance.emplace_back(Wide::size * 4 * nodes * nodes);
    A.kept_inverse(compliance.back());
  }
  test::RandomNumbers random(12);
  std::vector<Vec<2>> increment;
  for (int v = 0; v < grains.outline_size(); ++v) increment.push_back(random.vector<2>(0.05));
  const std::vector<double> friction(contacts.size(), 0.0);
  ElasticScratch scratch;
  const auto solve = [&](int thread_count, int sweeps) {
    set_threads(thread_count);
    ElasticContacts system(grains, contacts, compliance, increment, dt, scratch);
    std::vector<Vec<2>> p(contacts.size(), Vec<2>{0.01, 0});
    system.apply_impulses(p);
    solve_nlgs<2>(system, std::span(p), friction,
                  {.max_sweeps = sweeps, .tolerance = 1e-6, .velocity_scale = 0.1});
    std::vector<Vec<2>> u;
    for (int c = 0; c < system.size(); ++c) u.push_back(system.relative_velocity(c));
    return std::pair(p, u);
  };
  const int before = threads();
  const auto on_one = solve(1, 30);
  for (const int count : {2, 3}) CHECK(solve(count, 30) == on_one);
  const auto [p, u] = solve(2, 3000);
  set_threads(before);

  // the same problem with W in full, swept in the order of the list
  ElasticContacts system(grains, contacts, compliance, increment, dt, scratch);
  const ContactProblem problem = contact_problem_of<2>(system, friction);
  std::vector<Vec<2>> q;
  for (std::size_t c = 0; c < contacts.size(); ++c) q.push_back({problem.q[2 * c], problem.q[2 * c + 1]});
  DelassusSystem<2> in_full(problem.W, q);
  std::vector<Vec<2>> p_full(contacts.size());
  const SolverReport report = solve_nlgs<2>(in_full, std::span(p_full), friction,
                                            {.max_sweeps = 3000, .tolerance = 1e-6, .velocity_scale = 0.1});
  CHECK(report.converged);
  int carrying = 0;
  double worst = 0;
  for (int c = 0; c < system.size(); ++c) {
    carrying += p[c][0] > 0;
    worst = std::max(worst, norm(u[c] - in_full.relative_velocity(c)));
  }
  CHECK(carrying > 200);
  CHECK(worst < 1e-4);
}

TEST_CASE("the Delassus matrix of lumped outlines is H^T M^-1 H") {
  Scenery s;
  std::vector<double> inverse_mass;
  test::RandomNumbers random(9);
  for (int v = 0; v < s.grains.outline_size(); ++v) inverse_mass.push_back(random.uniform(1, 3));
  LumpedContacts::Scratch scratch;
  LumpedBodies none;
  LumpedContacts system(s.contacts, s.outline, s.vectors, inverse_mass, none, scratch);
  const Eigen::MatrixXd H = contact_map(s);
  Eigen::VectorXd M(2 * s.grains.outline_size());
  for (int v = 0; v < s.grains.outline_size(); ++v) M(2 * v) = M(2 * v + 1) = inverse_mass[v];
  const Eigen::MatrixXd W = H.transpose() * M.asDiagonal() * H;
  // a contact's own block leaves out nothing
  check_delassus(system, W);
}

TEST_CASE("lumped contacts start from the gap that they were found with, and follow the velocities") {
  Scenery s;
  const std::vector<double> inverse_mass(s.grains.outline_size(), 1);
  LumpedContacts::Scratch scratch;
  LumpedBodies none;
  const LumpedContacts system(s.contacts, s.outline, s.vectors, inverse_mass, none, scratch);
  for (int c = 0; c < system.size(); ++c)
    CHECK(system.relative_velocity(c)[0] == doctest::Approx(s.contacts[c].gap / dt));
  test::RandomNumbers random(6);
  Eigen::VectorXd change(2 * s.grains.outline_size());
  const std::vector<Vec<2>> before = s.vectors;
  for (int v = 0; v < s.grains.outline_size(); ++v) {
    s.vectors[v] += random.vector<2>(1);
    for (int d = 0; d < 2; ++d) change(2 * v + d) = s.vectors[v][d] - before[v][d];
  }
  const Eigen::VectorXd u = contact_map(s).transpose() * change;
  for (int c = 0; c < system.size(); ++c)
    CHECK(system.relative_velocity(c)[0] == doctest::Approx(s.contacts[c].gap / dt + u(2 * c)));
  // against the wall, the tangential velocity is that of the place less the wall's
  for (int c = 0; c < system.size(); ++c) {
    const OutlineContact& contact = s.contacts[c];
    if (contact.wall < 0) continue;
    const double along =
        s.vectors[contact.vertex][0] +
        contact.share / 2 * (s.vectors[contact.master[2]][0] - s.vectors[contact.master[0]][0]);
    CHECK(system.relative_velocity(c)[1] == doctest::Approx(-(along - 0.3)));
  }
}

TEST_CASE("contact forces are the impulses over dt, and equal and opposite between grains") {
  const Scenery s;
  test::RandomNumbers random(2);
  std::vector<Vec<2>> impulse;
  Eigen::VectorXd p(2 * s.contacts.size());
  for (std::size_t c = 0; c < s.contacts.size(); ++c) {
    impulse.push_back(random.vector<2>(1));
    for (int d = 0; d < 2; ++d) p(2 * c + d) = impulse[c][d];
  }
  const auto force = contact_forces(s.grains, s.contacts, impulse, dt);
  const Eigen::VectorXd expected = contact_map(s) * p / dt;
  for (int v = 0; v < s.grains.outline_size(); ++v)
    for (int d = 0; d < 2; ++d) CHECK(std::abs(force[v][d] - expected(2 * v + d)) < 1e-13);
}
