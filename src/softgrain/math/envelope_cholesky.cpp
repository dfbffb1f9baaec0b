#include "softgrain/math/envelope_cholesky.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "softgrain/math/wide.hpp"

namespace softgrain {
namespace {

/// Products of two rows with two others, over n columns.
struct Products {
  double aa = 0, ab = 0, ba = 0, bb = 0;
};

Products products(const double* a0, const double* a1, const double* b0, const double* b1, int n) {
  Lanes aa{}, ab{}, ba{}, bb{};
  int k = 0;
  for (; k + lane_count <= n; k += lane_count) {
    const Lanes x0 = load_lanes(a0 + k), x1 = load_lanes(a1 + k), y0 = load_lanes(b0 + k),
                y1 = load_lanes(b1 + k);
    aa += x0 * y0;
    ab += x0 * y1;
    ba += x1 * y0;
    bb += x1 * y1;
  }
  Products sum{horizontal_sum(aa), horizontal_sum(ab), horizontal_sum(ba), horizontal_sum(bb)};
  for (; k < n; ++k) {
    sum.aa += a0[k] * b0[k];
    sum.ab += a0[k] * b1[k];
    sum.ba += a1[k] * b0[k];
    sum.bb += a1[k] * b1[k];
  }
  return sum;
}

}  // namespace

void EnvelopeCholesky::reset(std::vector<int> first) {
  first_ = std::move(first);
  begin_.resize(first_.size());
  std::ptrdiff_t end = 0;
  for (int i = 0; i < nodes(); ++i) {
    assert(0 <= first_[i] && first_[i] <= i);
    begin_[i] = end;
    end += 2 * width(i);
  }
  value_.assign(static_cast<std::size_t>(end), 0);
}

void EnvelopeCholesky::add(int i, int j, const Mat<2>& block) {
  assert(first_[i] <= j && j <= i);
  for (int d = 0; d < 2; ++d)
    for (int e = 0; e < 2; ++e) row(i, d)[2 * j + e] += block(d, e);
}

/// Row by row: L_ij = (A_ij - sum_{k<j} L_ik L_jk^T) L_jj^-T.
bool EnvelopeCholesky::factor() {
  for (int i = 0; i < nodes(); ++i) {
    double *a0 = row(i, 0), *a1 = row(i, 1);
    for (int j = first_[i]; j <= i; ++j) {
      const double *b0 = row(j, 0), *b1 = row(j, 1);
      const int from = 2 * std::max(first_[i], first_[j]), column = 2 * j;
      const Products p = products(a0 + from, a1 + from, b0 + from, b1 + from, column - from);
      a0[column] -= p.aa;
      a0[column + 1] -= p.ab;
      a1[column] -= p.ba;
      a1[column + 1] -= p.bb;
      if (j == i) break;
      const double r11 = b0[column], l21 = b1[column], r22 = b1[column + 1];
      a0[column] *= r11;
      a1[column] *= r11;
      a0[column + 1] = (a0[column + 1] - a0[column] * l21) * r22;
      a1[column + 1] = (a1[column + 1] - a1[column] * l21) * r22;
    }
    const double l11 = std::sqrt(a0[2 * i]), l21 = a1[2 * i] / l11,
                 l22 = std::sqrt(a1[2 * i + 1] - l21 * l21);
    if (!(l11 > 0 && l22 > 0)) return false;
    a0[2 * i] = 1 / l11;
    a1[2 * i] = l21;
    a1[2 * i + 1] = 1 / l22;
  }
  return true;
}

void EnvelopeCholesky::solve(std::span<Vec<2>> x) const {
  double* y = x[0].c.data();
  for (int i = 0; i < nodes(); ++i) {  // L y = x
    const double *l0 = row(i, 0), *l1 = row(i, 1);
    double s0 = y[2 * i], s1 = y[2 * i + 1];
    for (int k = 2 * first_[i]; k < 2 * i; ++k) {
      s0 -= l0[k] * y[k];
      s1 -= l1[k] * y[k];
    }
    y[2 * i] = s0 * l0[2 * i];
    y[2 * i + 1] = (s1 - l1[2 * i] * y[2 * i]) * l1[2 * i + 1];
  }
  for (int i = nodes() - 1; i >= 0; --i) {  // L^T x = y
    const double *l0 = row(i, 0), *l1 = row(i, 1);
    const double x1 = y[2 * i + 1] * l1[2 * i + 1], x0 = (y[2 * i] - l1[2 * i] * x1) * l0[2 * i];
    y[2 * i] = x0;
    y[2 * i + 1] = x1;
    for (int k = 2 * first_[i]; k < 2 * i; ++k) y[k] -= l0[k] * x0 + l1[k] * x1;
  }
}

/// Columns of the inverse for four nodes at once, each from its first node on: what is above it follows by
/// symmetry.
std::vector<double> EnvelopeCholesky::inverse_on(std::span<const int> some) const {
  const int count = static_cast<int>(some.size()), stride = 2 * count;
  std::vector<double> inverse(static_cast<std::size_t>(stride) * stride);
  std::vector<Wide> y(2 * static_cast<std::size_t>(nodes()));
  for (int begin = 0; begin < count; begin += Wide::size / 2) {
    const int end = std::min(begin + Wide::size / 2, count), least = some[begin];
    std::fill(y.begin() + 2 * least, y.end(), Wide{});
    for (int s = begin; s < end; ++s)
      for (int d = 0; d < 2; ++d) y[2 * some[s] + d].set(2 * (s - begin) + d, 1);
    for (int i = least; i < nodes(); ++i) {
      const double *l0 = row(i, 0), *l1 = row(i, 1);
      Wide s0 = y[2 * i], s1 = y[2 * i + 1];
      for (int k = 2 * std::max(first_[i], least); k < 2 * i; ++k) {
        const Wide v = y[k];
        s0 -= Wide(l0[k]) * v;
        s1 -= Wide(l1[k]) * v;
      }
      s0 *= Wide(l0[2 * i]);
      y[2 * i] = s0;
      y[2 * i + 1] = (s1 - Wide(l1[2 * i]) * s0) * Wide(l1[2 * i + 1]);
    }
    for (int i = nodes() - 1; i >= least; --i) {
      const double *l0 = row(i, 0), *l1 = row(i, 1);
      const Wide x1 = y[2 * i + 1] * Wide(l1[2 * i + 1]);
      const Wide x0 = (y[2 * i] - Wide(l1[2 * i]) * x1) * Wide(l0[2 * i]);
      y[2 * i] = x0;
      y[2 * i + 1] = x1;
      for (int k = 2 * std::max(first_[i], least); k < 2 * i; ++k)
        y[k] -= Wide(l0[k]) * x0 + Wide(l1[k]) * x1;
    }
    for (int s = begin; s < count; ++s)
      for (int d = 0; d < 2; ++d)
        for (int column = 2 * begin; column < 2 * end; ++column) {
          const double entry = y[2 * some[s] + d][column - 2 * begin];
          inverse[static_cast<std::size_t>(2 * s + d) * stride + column] = entry;
          inverse[static_cast<std::size_t>(column) * stride + 2 * s + d] = entry;
        }
  }
  return inverse;
}

}  // namespace softgrain
