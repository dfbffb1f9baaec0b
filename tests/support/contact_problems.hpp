#pragma once
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/contact/contact_problem.hpp"
#include "support/random_numbers.hpp"

namespace softgrain::test {

inline ContactProblem problem_of(int dimension, const Eigen::MatrixXd& W, const Eigen::VectorXd& q,
                                 double mu) {
  ContactProblem problem{.dimension = dimension, .W = {}, .q = {q.begin(), q.end()}, .friction = {}};
  problem.friction.assign(static_cast<std::size_t>(q.size() / dimension), mu);
  for (int i = 0; i < W.rows(); ++i)
    for (int j = 0; j < W.cols(); ++j)
      if (W(i, j) != 0) problem.W.push_back({i, j, W(i, j)});
  return problem;
}

// Products of matrices are lazy: Eigen's own depend on the number of threads in their last bits.

/// A random positive definite W, so that a solution exists, all components coupled; q approaches in half of
/// the contacts.
inline ContactProblem random_problem(int dimension, int contacts, double mu, std::uint64_t seed) {
  RandomNumbers random(seed);
  const int size = dimension * contacts;
  const auto any = [&](double) { return random.uniform(-1, 1); };
  const Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size + dimension).unaryExpr(any);
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(size).unaryExpr(any);
  return problem_of(dimension, A.lazyProduct(A.transpose()), q, mu);
}

/// n disks of mass m, one upon the other, fall together with speed v on a floor: every contact (normal only)
/// of disk k with what is below; W is tridiagonal and the lowest contact stops them all, p_k = (n - k) m v.
inline ContactProblem falling_column(int n, double m, double v) {
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(2 * n);
  q[0] = -v;
  for (int k = 0; k < n; ++k) {
    W(2 * k, 2 * k) = (k == 0 ? 1 : 2) / m;
    if (k > 0) W(2 * k, 2 * k - 2) = W(2 * k - 2, 2 * k) = -1 / m;
    W(2 * k + 1, 2 * k + 1) = 3 * W(2 * k, 2 * k);
  }
  return problem_of(2, W, q, 0);
}

/// Disks of unequal mass on a hexagonal lattice, per_side x per_side, squeezed: all move to the middle, and a
/// little at random. W = H M^-1 H^T with rotations. Hyperstatic: u is unique, p is not.
inline ContactProblem squeezed_packing(int per_side, double mu, std::uint64_t seed) {
  RandomNumbers random(seed);
  const int disks = per_side * per_side;
  std::vector<Eigen::Vector2d> x;
  for (int i = 0; i < disks; ++i)
    x.emplace_back(2 * (i % per_side) + i / per_side % 2, std::sqrt(3.0) * (i / per_side));
  Eigen::VectorXd inverse_mass(3 * disks), v = Eigen::VectorXd::Zero(3 * disks);  // (v_x, v_y, spin)
  for (int i = 0; i < disks; ++i) {
    const double inverse = random.uniform(0.5, 2);
    inverse_mass.segment<3>(3 * i) << inverse, inverse, 2 * inverse;
    v.segment<2>(3 * i) = -0.1 * (x[i] - Eigen::Vector2d::Constant(per_side));
    for (int k = 0; k < 3; ++k) v[3 * i + k] += random.uniform(-0.1, 0.1);
  }
  std::vector<Eigen::RowVectorXd> rows;
  for (int a = 0; a < disks; ++a)
    for (int b = a + 1; b < disks; ++b) {
      if ((x[b] - x[a]).norm() > 2.01) continue;
      const Eigen::Vector2d n = (x[b] - x[a]).normalized(), t(-n.y(), n.x());
      for (const Eigen::Vector2d& direction : {n, t}) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(3 * disks);
        row.segment<2>(3 * a) = -direction;
        row.segment<2>(3 * b) = direction;
        if (direction == t) row[3 * a + 2] = row[3 * b + 2] = -1;  // spins are speeds of the surface
        rows.push_back(row);
      }
    }
  Eigen::MatrixXd H(rows.size(), 3 * disks);
  for (std::size_t k = 0; k < rows.size(); ++k) H.row(static_cast<Eigen::Index>(k)) = rows[k];
  return problem_of(2, (H * inverse_mass.asDiagonal()).eval().lazyProduct(H.transpose()), H * v, mu);
}

inline Eigen::VectorXd vector_of(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

inline Eigen::MatrixXd dense_W(const ContactProblem& problem) {
  const auto size = static_cast<Eigen::Index>(problem.q.size());
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(size, size);
  for (const MatrixEntry& entry : problem.W) W(entry.row, entry.column) += entry.value;
  return W;
}

/// How far p and u are from each sentence of the law, in velocities [m/s].
struct LawDefects {
  double penetration = 0, pull = 0;  ///< u_n < 0, p_n < 0
  double both = 0;                   ///< open and pushing: min(u_n, W_nn p_n)
  double cone = 0;                   ///< |p_t| beyond mu p_n
  double direction = 0;              ///< sliding, but not against u_t with mu p_n

  double worst() const { return std::max({penetration, pull, both, cone, direction}); }
};

inline LawDefects law_defects(const ContactProblem& problem, const Eigen::VectorXd& p,
                              const Eigen::VectorXd& u) {
  const Eigen::MatrixXd W = dense_W(problem);
  const int dimension = problem.dimension;
  LawDefects worst;
  for (int c = 0; c < problem.contacts(); ++c) {
    const int n = dimension * c;
    const double mu = problem.friction[static_cast<std::size_t>(c)], W_nn = W(n, n);
    const auto p_t = p.segment(n + 1, dimension - 1), u_t = u.segment(n + 1, dimension - 1);
    worst.penetration = std::max(worst.penetration, -u[n]);
    worst.pull = std::max(worst.pull, -W_nn * p[n]);
    worst.both = std::max(worst.both, std::min(u[n], W_nn * p[n]));
    worst.cone = std::max(worst.cone, W_nn * (p_t.norm() - mu * p[n]));
    // u_t = -s p_t, s >= 0, and s = 0 inside the cone: |u_t| p_t = -mu p_n u_t
    const double slip = (u_t.norm() * p_t + mu * p[n] * u_t).norm();
    if (slip > 0) worst.direction = std::max(worst.direction, slip / (u_t.norm() / W_nn + mu * p[n]));
  }
  return worst;
}

}  // namespace softgrain::test
