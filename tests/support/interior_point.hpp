#pragma once
#include <Eigen/Dense>

#include <algorithm>

namespace softgrain::test {

/// The frictionless problem 0 <= u = W p + q _|_ p >= 0, W positive semidefinite, by Mehrotra's predictor and
/// corrector with a dense factorisation: shares nothing with the solvers under test. Returns p, to about
/// 1e-13 of the largest.
inline Eigen::VectorXd solve_by_interior_point(const Eigen::MatrixXd& W, const Eigen::VectorXd& q) {
  using Vector = Eigen::VectorXd;
  Eigen::setNbThreads(1);  // threads cost more than they bring at this size
  const Eigen::Index n = q.size();
  const double scale = W.diagonal().maxCoeff();
  Vector p = Vector::Constant(n, std::max(1e-3, q.cwiseAbs().maxCoeff() / scale));
  Vector u = (W * p + q).cwiseMax(q.cwiseAbs().maxCoeff());
  // Largest step in (0, 1] that keeps x + step dx > 0.
  const auto longest = [](const Vector& x, const Vector& dx) {
    double step = 1;
    for (Eigen::Index k = 0; k < x.size(); ++k)
      if (dx[k] < 0) step = std::min(step, -x[k] / dx[k]);
    return step;
  };
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vector defect = u - W * p - q;
    const double gap = p.dot(u) / static_cast<double>(n);
    if (gap < 1e-28 && defect.norm() < 1e-14 * q.norm()) break;
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(
        W + Eigen::MatrixXd((u.array() / p.array()).matrix().asDiagonal()));
    // u dp + p du = target - p u,  du = W dp - defect
    Vector dp, du;
    const auto direction = [&](const Vector& target) {
      dp = factors.solve(defect - u + (target.array() / p.array()).matrix());
      du = W * dp - defect;
    };
    direction(Vector::Zero(n));
    const double predicted = (p + longest(p, dp) * dp).dot(u + longest(u, du) * du) / static_cast<double>(n);
    const double centring = std::pow(predicted / gap, 3) * gap;
    direction((centring - dp.array() * du.array()).matrix());
    const double step = std::min(1.0, 0.995 * std::min(longest(p, dp), longest(u, du)));
    p += step * dp;
    u += step * du;
  }
  return p;
}

}  // namespace softgrain::test
