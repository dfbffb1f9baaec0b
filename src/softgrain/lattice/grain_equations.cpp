#include "softgrain/lattice/grain_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "softgrain/lattice/with_elastic.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {
namespace {

/// Smallest mass of a node over that of a point for it to be an unknown: of others points feel nothing.
constexpr double least_share = 1e-13;

/// The nodes of a point that are unknowns, and F^T dN_i [1/m] of each.
struct PointNodes {
  int count = 0;
  std::array<int, 9> unknown{};
  std::array<Vec<2>, 9> gradient{};
};

Vec<2> pulled_back(const Mat<2>& F, const Vec<2>& dN) {
  return {F(0, 0) * dN[0] + F(1, 0) * dN[1], F(0, 1) * dN[0] + F(1, 1) * dN[1]};
}

bool has_weight(double N, const Vec<2>& dN) { return N > 0 || !(dN == Vec<2>{}); }

/// g . A . h, that is sum_JL g[J] A(aJ, bL) h[L].
Mat<2> contracted(const Vec<2>& g, const Mat<4>& A, const Vec<2>& h) {
  Mat<2> block;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int J = 0; J < 2; ++J)
        for (int L = 0; L < 2; ++L) block(a, b) += g[J] * A(2 * a + J, 2 * b + L) * h[L];
  return block;
}

/// K of one point: V F^T dN_i . A . F^T dN_j for each pair of its nodes, in the rows that the matrix keeps.
void add_stiffness(const PointNodes& near, const Mat<4>& A, EnvelopeCholesky& matrix) {
  for (int a = 0; a < near.count; ++a)
    for (int b = 0; b <= a; ++b) {
      const bool in_order = near.unknown[b] <= near.unknown[a];
      const int i = in_order ? a : b, j = in_order ? b : a;
      matrix.add(near.unknown[i], near.unknown[j], contracted(near.gradient[i], A, near.gradient[j]));
    }
}

}  // namespace

void GrainEquations::number(const Lattice& lattice, int grain, std::span<const Stencil> stencil) {
  grain_ = grain;
  first_node_ = lattice.first_node(grain);
  const int columns = lattice.columns(grain), rows = lattice.rows(grain);
  double largest = 0;
  for (int i = first_node_; i < first_node_ + columns * rows; ++i)
    largest = std::max(largest, lattice.mass[i]);
  node_.clear();
  unknown_.assign(static_cast<std::size_t>(columns) * rows, -1);
  const bool across = columns <= rows;
  for (int k = 0; k < columns * rows; ++k) {
    const int i = across ? k : (k % rows) * columns + k / rows;
    if (!(lattice.mass[first_node_ + i] > least_share * largest)) continue;
    unknown_[i] = static_cast<int>(node_.size());
    node_.push_back(first_node_ + i);
  }
  first_.resize(node_.size());
  for (int i = 0; i < static_cast<int>(first_.size()); ++i) first_[i] = i;
  for (const Stencil& of_point : stencil) {
    int least = static_cast<int>(node_.size());
    const auto visit = [&](auto&& use) {
      of_point.for_each_node([&](int column, int row, double N, const Vec<2>& dN) {
        if (!has_weight(N, dN)) return;
        const int i = unknown(lattice.node(grain, column, row));
        if (i >= 0) use(i);
      });
    };
    visit([&](int i) { least = std::min(least, i); });
    visit([&](int i) { first_[i] = std::min(first_[i], least); });
  }
}

bool GrainEquations::factor(const Lattice& lattice, const PointGrain& grain, std::span<const Stencil> stencil,
                            std::span<const Mat<2>> F, const AnyLaw& law, double dt) {
  matrix_.reset(first_);
  for (int i = 0; i < static_cast<int>(node_.size()); ++i) {
    const double inertia = lattice.mass[node_[i]] / (dt * dt);
    matrix_.add(i, i, Mat<2>::diagonal({inertia, inertia}));
  }
  with_elastic(law, [&](const auto& material) {
    for (int p = 0; p < grain.points(); ++p) {
      PointNodes near;
      stencil[p].for_each_node([&](int column, int row, double N, const Vec<2>& dN) {
        if (!has_weight(N, dN)) return;
        const int i = unknown(lattice.node(grain_, column, row));
        if (i < 0) return;
        near.unknown[near.count] = i;
        near.gradient[near.count++] = pulled_back(grain.F[p], dN);
      });
      add_stiffness(near, grain.volume[p] * material.tangent(F[p]), matrix_);
    }
  });
  return matrix_.factor();
}

std::vector<double> GrainEquations::compliance(std::span<const int> some, double dt) const {
  std::vector<double> entries = matrix_.inverse_on(some);
  for (double& entry : entries) entry *= 1 / (dt * dt);
  return entries;
}

bool strained(const Lattice& lattice, int grain, const PointGrain& points, std::span<const Stencil> stencil,
              double dt, std::vector<Mat<2>>& F) {
  F.resize(points.F.size());
  for (int p = 0; p < points.points(); ++p) {
    Mat<2> L;  // sum_i v_i (x) dN_i
    stencil[p].for_each_node([&](int column, int row, double, const Vec<2>& dN) {
      const Vec<2>& v = lattice.velocity[lattice.node(grain, column, row)];
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) L(a, b) += v[a] * dN[b];
    });
    F[p] = points.F[p] + dt * (L * points.F[p]);
    if (!admissible(F[p]) || !std::isfinite(determinant(F[p]))) return false;
  }
  return true;
}

void add_internal_force(const Lattice& lattice, int grain, const PointGrain& points,
                        std::span<const Stencil> stencil, std::span<const Mat<2>> F, const AnyLaw& law,
                        std::span<Vec<2>> force) {
  with_elastic(law, [&](const auto& material) {
    for (int p = 0; p < points.points(); ++p) {
      const Mat<2> stress = points.volume[p] * (material.stress(F[p]) * transpose(points.F[p]));
      stencil[p].for_each_node([&](int column, int row, double, const Vec<2>& dN) {
        force[lattice.node(grain, column, row)] -= stress * dN;
      });
    }
  });
}

double internal_work(const PointGrain& points, std::span<const Mat<2>> F, const AnyLaw& law) {
  double sum = 0;
  with_elastic(law, [&](const auto& material) {
    for (int p = 0; p < points.points(); ++p)
      sum += points.volume[p] * contract(material.stress(F[p]), F[p] - points.F[p]);
  });
  return sum;
}

}  // namespace softgrain
