#include "softgrain/math/block_cholesky.hpp"

#include <algorithm>

namespace softgrain {
namespace {

template <class Entry>
using Block = std::array<Entry, 4>;

/// C -= A B^T for 2 x 2 blocks, C by its numbers: these stay in registers, arrays do not.
template <class Entry>
inline void subtract_product(Entry& a, Entry& b, Entry& c, Entry& d, const Block<Entry>& A,
                             const Block<Entry>& B) {
  a = minus_product(minus_product(a, A[0], B[0]), A[1], B[1]);
  b = minus_product(minus_product(b, A[0], B[2]), A[1], B[3]);
  c = minus_product(minus_product(c, A[2], B[0]), A[3], B[1]);
  d = minus_product(minus_product(d, A[2], B[2]), A[3], B[3]);
}

/// Two right-hand sides at once.
template <class Entry>
struct Two {
  Entry first{}, second{};
};
template <class Entry>
inline Two<Entry> operator*(const Two<Entry>& a, const Entry& s) {
  return {a.first * s, a.second * s};
}
template <class Entry>
inline Two<Entry> operator+(const Two<Entry>& a, const Two<Entry>& b) {
  return {a.first + b.first, a.second + b.second};
}
template <class Entry>
inline Two<Entry> minus_product(const Two<Entry>& c, const Entry& a, const Two<Entry>& b) {
  return {minus_product(c.first, a, b.first), minus_product(c.second, a, b.second)};
}

}  // namespace

BatchedCholesky::BatchedCholesky(const BlockPattern& pattern) : pattern_(pattern), place_(pattern.nodes()) {}

template <class Entry>
void BatchedCholesky::clear(std::size_t blocks) {
  if (!std::holds_alternative<Store<Entry>>(store_)) store_ = Store<Entry>{};
  Store<Entry>& store = std::get<Store<Entry>>(store_);
  store.value.assign(blocks, {});
  store.scratch.resize(2 * pattern_.nodes());
}

void BatchedCholesky::clear(Precision precision) {
  const auto blocks = static_cast<std::size_t>(pattern_.blocks());
  precision == Precision::single ? clear<Narrow>(blocks) : clear<Wide>(blocks);
}

void BatchedCholesky::add(int node_i, int node_j, const Block<Wide>& block) {
  const bool flip = pattern_.transposed(node_i, node_j);
  add_block(pattern_.block(node_i, node_j),
            flip ? Block<Wide>{block[0], block[2], block[1], block[3]} : block);
}

void BatchedCholesky::add_block(int block, const Block<Wide>& value) {
  std::visit(
      [&]<class Entry>(Store<Entry>& store) {
        for (int k = 0; k < 4; ++k) store.value[block][k] += Entry(value[k]);
      },
      store_);
}

unsigned BatchedCholesky::factor() {
  return std::visit([&](auto& store) { return factor(store); }, store_);
}

/// How many of the blocks L_kj from left_[l] on, at most four, are in columns j, j + 1, ... that have entries
/// in the same rows from k on. Where column j has an entry in row j + 1, its rows below are rows of j + 1.
int BatchedCholesky::alike_columns(int l) const {
  const std::vector<int>&begin = pattern_.column_begin_, &row = pattern_.row_, &left = pattern_.left_;
  const int last = static_cast<int>(left.size()) - 1;
  int alike = 1;
  for (; alike < 4 && l < last; ++alike, ++l) {
    const int j = pattern_.column_of_[left[l]], next = pattern_.column_of_[left[l + 1]];
    if (next != j + 1 || row[begin[j] + 1] != next) break;
    if (begin[j + 1] - left[l] != begin[next + 1] - left[l + 1]) break;
  }
  return alike;
}

/// A_ik -= sum_j L_ij L_kj^T over `Count` columns j with entries in the same rows; first: their blocks L_kj.
/// With `Pair`, also A_i(k+1), whose blocks are `offset` behind those of A_ik.
template <int Count, bool Pair, class Entry>
void BatchedCholesky::subtract_columns(Block<Entry>* value, const int* first, int offset) const {
  std::array<const Block<Entry>*, Count> L;
  std::array<Block<Entry>, Count> L_k, L_next;
  for (int q = 0; q < Count; ++q) {
    L[q] = value + first[q];
    L_k[q] = L[q][0];
    if (Pair) L_next[q] = L[q][1];
  }
  const int* row = &pattern_.row_[first[0]];
  const int rows = pattern_.column_begin_[pattern_.column_of_[first[0]] + 1] - first[0];
  for (int i = 0; i < rows; ++i) {
    Block<Entry>* at = value + place_[row[i]];
    Entry a = at[0][0], b = at[0][1], c = at[0][2], d = at[0][3];
    if (!Pair || i == 0) {
#pragma GCC unroll 4
      for (int q = 0; q < Count; ++q) subtract_product(a, b, c, d, L[q][i], L_k[q]);
    } else {
      Entry e = at[offset][0], f = at[offset][1], g = at[offset][2], h = at[offset][3];
#pragma GCC unroll 4
      for (int q = 0; q < Count; ++q) {
        subtract_product(a, b, c, d, L[q][i], L_k[q]);
        subtract_product(e, f, g, h, L[q][i], L_next[q]);
      }
      at[offset] = {e, f, g, h};
    }
    at[0] = {a, b, c, d};
  }
}

template <bool Pair, class Entry>
void BatchedCholesky::subtract_columns(Block<Entry>* value, const int* first, int count, int offset) const {
  if (count == 4)
    subtract_columns<4, Pair>(value, first, offset);
  else if (count >= 2)
    subtract_columns<2, Pair>(value, first, offset);
  else
    subtract_columns<1, Pair>(value, first, offset);
}

/// A_ik -= sum_j L_ij L_kj^T. With `pair`, also A_i(k+1) of the columns j that reach row k + 1; with
/// `second`, k was such a k + 1, and only what was left out is to be done.
template <class Entry>
void BatchedCholesky::subtract_left(Block<Entry>* value, int k, bool pair, bool second) const {
  const std::vector<int>&begin = pattern_.column_begin_, &row = pattern_.row_, &left = pattern_.left_;
  const int last = pattern_.left_begin_[k + 1];
  const auto column = [&](int l) { return pattern_.column_of_[left[l]]; };
  const auto done = [&](int l) { return second && column(l) < k - 1 && row[left[l] - 1] == k - 1; };
  for (int l = pattern_.left_begin_[k]; l < last;) {
    if (done(l)) {
      ++l;
      continue;
    }
    int alike = std::min(alike_columns(l), last - l);
    for (int m = 1; m < alike; ++m)
      if (done(l + m)) alike = m;
    if (alike == 3) alike = 2;
    const bool reaches = left[l] + 1 < begin[column(l) + 1] && row[left[l] + 1] == k + 1;
    if (pair && reaches)
      subtract_columns<true>(value, &left[l], alike, begin[k + 1] - begin[k] - 1);
    else
      subtract_columns<false>(value, &left[l], alike, 0);
    l += alike;
  }
}

/// Left-looking by columns, two at once where the second has entries in the rows of the first. A diagonal
/// block holds {1/l11, -, l21, 1/l22} of its 2 x 2 factor.
template <class Entry>
unsigned BatchedCholesky::factor(Store<Entry>& store) {
  const std::vector<int>&begin = pattern_.column_begin_, &row = pattern_.row_;
  std::vector<Block<Entry>>& value = store.value;
  const Entry one(Wide(1.0));
  unsigned failed = 0;
  bool second = false;
  for (int k = 0; k < pattern_.nodes(); ++k) {
    const int below = begin[k + 1] - begin[k] - 1;
    for (int s = begin[k]; s < begin[k + 1]; ++s) place_[row[s]] = s;
    const bool pair =
        !second && below > 0 && row[begin[k] + 1] == k + 1 && begin[k + 2] - begin[k + 1] == below;
    subtract_left(value.data(), k, pair, second);
    second = pair;
    Block<Entry>& diagonal = value[begin[k]];
    const Entry l11 = sqrt(diagonal[0]), r11 = one / l11, l21 = diagonal[2] * r11;
    const Entry l22 = sqrt(diagonal[3] - l21 * l21), r22 = one / l22;
    for (int lane = 0; lane < Wide::size; ++lane)
      if (!(l11[lane] > 0 && l22[lane] > 0)) failed |= 1u << lane;
    diagonal = {r11, Entry{}, l21, r22};
    // L_ik = A_ik L_kk^-T
    for (int s = begin[k] + 1; s < begin[k + 1]; ++s) {
      Block<Entry>& A = value[s];
      const Entry a = A[0] * r11, c = A[2] * r11;
      A = {a, (A[1] - a * l21) * r22, c, (A[3] - c * l21) * r22};
    }
  }
  return failed;
}

/// y <- L^-1 y from elimination place `first` on.
template <class Entry, class Right>
void BatchedCholesky::forward(const Store<Entry>& store, Right* y, int first) const {
  const std::vector<int>&begin = pattern_.column_begin_, &row = pattern_.row_;
  for (int k = first; k < pattern_.nodes(); ++k) {
    const Block<Entry>& diagonal = store.value[begin[k]];
    const Right y0 = y[2 * k] * diagonal[0], y1 = minus_product(y[2 * k + 1], diagonal[2], y0) * diagonal[3];
    y[2 * k] = y0, y[2 * k + 1] = y1;
    for (int s = begin[k] + 1; s < begin[k + 1]; ++s) {
      const Block<Entry>& L = store.value[s];
      Right* z = y + 2 * row[s];
      z[0] = minus_product(minus_product(z[0], L[0], y0), L[1], y1);
      z[1] = minus_product(minus_product(z[1], L[2], y0), L[3], y1);
    }
  }
}

/// y <- L^-T y down to elimination place `first`.
template <class Entry, class Right>
void BatchedCholesky::backward(const Store<Entry>& store, Right* y, int first) const {
  const std::vector<int>&begin = pattern_.column_begin_, &row = pattern_.row_;
  for (int k = pattern_.nodes() - 1; k >= first; --k) {
    Right y0 = y[2 * k], y1 = y[2 * k + 1], more_0{}, more_1{};  // two sums each: one alone is waited for
    for (int s = begin[k] + 1; s < begin[k + 1]; ++s) {
      const Block<Entry>& L = store.value[s];
      const Right z0 = y[2 * row[s]], z1 = y[2 * row[s] + 1];
      y0 = minus_product(y0, L[0], z0);
      y1 = minus_product(y1, L[1], z0);
      more_0 = minus_product(more_0, L[2], z1);
      more_1 = minus_product(more_1, L[3], z1);
    }
    const Block<Entry>& diagonal = store.value[begin[k]];
    y1 = (y1 + more_1) * diagonal[3];
    y[2 * k + 1] = y1;
    y[2 * k] = minus_product(y0 + more_0, diagonal[2], y1) * diagonal[0];
  }
}

void BatchedCholesky::solve(std::span<Wide> x) const {
  const std::vector<Wide> h(2 * pattern_.kept_);
  std::vector<Wide> y(x.size()), kept(h);
  begin_solve(x, y, kept);
  finish_solve(y, h, x);
}

void BatchedCholesky::begin_solve(std::span<const Wide> x, std::span<Wide> y, std::span<Wide> kept) const {
  std::visit(
      [&]<class Entry>(Store<Entry>& store) {
        Entry* z = store.scratch.data();
        for (int i = 0; i < pattern_.nodes(); ++i)
          for (int d = 0; d < 2; ++d) z[2 * pattern_.order_[i] + d] = Entry(x[2 * i + d]);
        forward(store, z, 0);
        for (int k = 0; k < 2 * pattern_.nodes(); ++k) y[k] = Wide(z[k]);
        const int first = pattern_.nodes() - pattern_.kept_;
        backward(store, z, first);
        for (int k = 0; k < 2 * pattern_.kept_; ++k) kept[k] = Wide(z[2 * first + k]);
      },
      store_);
}

void BatchedCholesky::finish_solve(std::span<const Wide> y, std::span<const Wide> h,
                                   std::span<Wide> x) const {
  std::visit(
      [&]<class Entry>(Store<Entry>& store) {
        const int first = pattern_.nodes() - pattern_.kept_;
        Entry* z = store.scratch.data();
        for (int k = 0; k < 2 * pattern_.kept_; ++k) z[2 * first + k] = Entry(h[k]);
        forward(store, z, first);
        for (int k = 0; k < 2 * first; ++k) z[k] = Entry(y[k]);
        for (int k = 2 * first; k < 2 * pattern_.nodes(); ++k) z[k] += Entry(y[k]);
        backward(store, z, 0);
        for (int i = 0; i < pattern_.nodes(); ++i)
          for (int d = 0; d < 2; ++d) x[2 * i + d] = Wide(z[2 * pattern_.order_[i] + d]);
      },
      store_);
}

/// Two columns of the identity after two; only the end of the factor takes part, and rows above the columns
/// follow by symmetry.
void BatchedCholesky::kept_inverse(std::span<double> inverse) const {
  const int kept = pattern_.kept_, width = 2 * kept, first = pattern_.nodes() - kept;
  const std::size_t matrix = static_cast<std::size_t>(width) * width;
  std::visit(
      [&]<class Entry>(Store<Entry>& store) {
        std::vector<Two<Entry>> y(2 * pattern_.nodes());
        for (int node = 0; node < kept; ++node) {
          std::fill(y.begin() + 2 * (first + node), y.end(), Two<Entry>{});
          y[2 * (first + node)].first = y[2 * (first + node) + 1].second = Entry(Wide(1.0));
          forward(store, y.data(), first + node);
          backward(store, y.data(), first + node);
          for (int lane = 0; lane < Wide::size; ++lane) {
            double* of_lane = inverse.data() + lane * matrix;
            for (int k = 2 * node; k < width; ++k) {
              const Two<Entry>& x = y[2 * first + k];
              of_lane[k * width + 2 * node] = of_lane[2 * node * width + k] = x.first[lane];
              of_lane[k * width + 2 * node + 1] = of_lane[(2 * node + 1) * width + k] = x.second[lane];
            }
          }
        }
      },
      store_);
}

}  // namespace softgrain
