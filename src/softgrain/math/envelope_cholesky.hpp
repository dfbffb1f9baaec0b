#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A symmetric positive definite matrix of 2 x 2 blocks, one row of blocks for each node, and its Cholesky
/// factor A = L L^T. Each row is kept from its first entry to the diagonal, where the factor fills it. For
/// nodes in the order of a lattice, whose rows are as long as the lattice is wide, and whose pattern changes
/// from step to step: there is nothing to be found out before entries are summed up. BatchedCholesky is for
/// many matrices of one pattern.
class EnvelopeCholesky {
 public:
  /// All entries zero. first: (nodes) the first node with an entry in the row of each, at most itself.
  void reset(std::vector<int> first);
  int nodes() const { return static_cast<int>(first_.size()); }
  /// A_ij += block, for nodes j <= i of the envelope; of a block of the diagonal its lower triangle counts.
  void add(int i, int j, const Mat<2>& block);

  /// L from A, in place. False if A is not positive definite; the factor is void then.
  bool factor();
  /// x <- A^-1 x.
  void solve(std::span<Vec<2>> x) const;
  /// (A^-1)_ss on some nodes, in rising order: row-major, 2 some.size() numbers in a row.
  std::vector<double> inverse_on(std::span<const int> some) const;

 private:
  /// Row 2 i + d, such that row(i, d)[k] is its entry in column k >= 2 first_[i].
  double* row(int i, int d) { return value_.data() + begin_[i] + d * width(i) - 2 * first_[i]; }
  const double* row(int i, int d) const { return value_.data() + begin_[i] + d * width(i) - 2 * first_[i]; }
  std::ptrdiff_t width(int i) const { return 2 * (i - first_[i]) + 2; }

  std::vector<int> first_;
  std::vector<std::ptrdiff_t> begin_;  // (nodes) of the two rows of each in value_
  std::vector<double> value_;          // of the factor's diagonal the reciprocals
};

}  // namespace softgrain
