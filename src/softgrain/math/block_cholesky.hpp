#pragma once
#include <array>
#include <span>
#include <variant>
#include <vector>

#include "softgrain/math/narrow.hpp"

namespace softgrain {

/// Where a symmetric matrix of 2 x 2 blocks on a graph of nodes, and its Cholesky factor, have entries. Made
/// once for a shape of grain and shared by all grains of that shape.
///
/// Elimination takes the first nodes by minimum degree; the last `kept` nodes are eliminated last and in
/// their order, so that the end of the factor is the Schur complement on them: the outline of a grain, where
/// contacts act.
class BlockPattern {
 public:
  /// edges: pairs of nodes with an entry off the diagonal, in any order, repeats allowed.
  BlockPattern(int nodes, std::span<const std::array<int, 2>> edges, int kept);

  int nodes() const { return static_cast<int>(order_.size()); }
  int kept() const { return kept_; }
  int blocks() const { return static_cast<int>(row_.size()); }
  /// Place of a node in the elimination.
  int order(int node) const { return order_[node]; }
  /// Block of the lower triangle that holds (i, j) or its transpose. The entry must exist.
  int block(int node_i, int node_j) const;
  /// True if (i, j) is stored as (j, i)^T.
  bool transposed(int node_i, int node_j) const { return order_[node_i] < order_[node_j]; }

 private:
  friend class BatchedCholesky;
  int kept_;
  std::vector<int> order_;  // of each node
  std::vector<int> column_begin_,
      row_;  // factor by columns, diagonal first, rows rising, in elimination order
  std::vector<int> left_begin_, left_;  // for each row k: the blocks L_kj with j < k
  std::vector<int> column_of_;          // of each block
};

/// Cholesky factors A = L L^T of eight matrices of one pattern at once, one in each lane. Own code because no
/// library factors batches in lanes: 2.7 times faster than CHOLMOD one by one (docs/decisions/0009). In
/// single precision a factor takes half the memory and about half the time, and solutions have a relative
/// error of about 1e-7 times the condition of A: for methods that correct them.
class BatchedCholesky {
 public:
  /// Keeps a reference to the pattern.
  explicit BatchedCholesky(const BlockPattern& pattern);

  /// Sets all entries to zero, before the matrix is summed up with `add`, and the precision from now on.
  void clear(Precision precision = Precision::full);
  /// A_ij += block (row-major 2 x 2); for i != j only one of (i, j) and (j, i) may be added.
  void add(int node_i, int node_j, const std::array<Wide, 4>& block);
  /// The same by block number, for inner loops; the block must be in the orientation that is stored.
  void add_block(int block, const std::array<Wide, 4>& value);

  /// L from A, in place. Returns the lanes whose matrix is not positive definite: bit l of the result; their
  /// factor is void.
  unsigned factor();
  /// x <- A^-1 x; x: (2 nodes) in the order of the nodes.
  void solve(std::span<Wide> x) const;
  /// The first half of a solve: y = L^-1 x (2 nodes, in elimination order), and the solution on the kept
  /// nodes, (A^-1 x)_b (2 kept).
  void begin_solve(std::span<const Wide> x, std::span<Wide> y, std::span<Wide> kept) const;
  /// The second half, with more on the kept nodes that is known only now: A^-1 (x + h), h: (2 kept). The
  /// solution goes to x, in the order of the nodes.
  void finish_solve(std::span<const Wide> y, std::span<const Wide> h, std::span<Wide> x) const;
  /// Compliance of the kept nodes, (A^-1)_bb: lane after lane, (2 kept)^2 row-major.
  void kept_inverse(std::span<double> inverse) const;

 private:
  /// The numbers, eight in each Entry.
  template <class Entry>
  struct Store {
    std::vector<std::array<Entry, 4>> value;  // by block; diagonal: 1/l11, -, l21, 1/l22, see factor()
    std::vector<Entry> scratch;               // (2 nodes) in elimination order
  };

  template <class Entry>
  void clear(std::size_t blocks);
  template <class Entry>
  unsigned factor(Store<Entry>& store);
  int alike_columns(int l) const;
  template <class Entry>
  void subtract_left(std::array<Entry, 4>* value, int k, bool pair, bool second) const;
  template <int Count, bool Pair, class Entry>
  void subtract_columns(std::array<Entry, 4>* value, const int* first, int offset) const;
  template <bool Pair, class Entry>
  void subtract_columns(std::array<Entry, 4>* value, const int* first, int count, int offset) const;
  template <class Entry, class Right>
  void forward(const Store<Entry>& store, Right* y, int first) const;
  template <class Entry, class Right>
  void backward(const Store<Entry>& store, Right* y, int first) const;

  const BlockPattern& pattern_;
  mutable std::variant<Store<Wide>, Store<Narrow>> store_;
  std::vector<int> place_;  // scratch: block of each row in the present column
};

}  // namespace softgrain
