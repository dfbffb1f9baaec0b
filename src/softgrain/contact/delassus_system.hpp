#pragma once
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/extrapolate.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// One scalar entry of a sparse matrix.
struct MatrixEntry {
  int row = 0, column = 0;
  double value = 0;
};

/// A ContactSystem with the Delassus matrix W in full: u = W p + q. Rows of Dim x Dim blocks; a dense W is
/// the case of full rows. The velocity of a contact is summed anew from its row, so that no round-off piles
/// up over the sweeps.
template <int Dim>
class DelassusSystem {
 public:
  /// W [1/kg] by scalar entries, row = Dim contact + component, all inside Dim q.size(); entries at one place
  /// add up in the order given. q [m/s] holds one vector per contact. Starts from p = 0.
  DelassusSystem(std::span<const MatrixEntry> entries, std::span<const Vec<Dim>> free_velocity);

  int size() const { return static_cast<int>(free_velocity_.size()); }
  const Mat<Dim>& delassus_block(int contact) const { return diagonal_[contact]; }
  /// u_c = q_c + sum_b W_cb p_b [m/s]; per block: reads one block, one index, one impulse.
  Vec<Dim> relative_velocity(int contact) const {
    Vec<Dim> u = free_velocity_[contact];
    for (std::size_t k = row_start_[contact]; k < row_start_[contact + 1]; ++k)
      u += blocks_[k].W * impulse_[blocks_[k].column];
    return u;
  }
  void apply_impulse(int contact, const Vec<Dim>& dp) { impulse_[contact] += dp; }
  /// u <- u + b (u - u'), u' the velocities when this was last called.
  void extrapolate(double b) {
    before_.resize(impulse_.size());
    for (std::size_t c = 0; c < impulse_.size(); ++c) softgrain::extrapolate(impulse_[c], before_[c], b);
  }

  std::span<const Vec<Dim>> free_velocity() const { return free_velocity_; }  ///< q [m/s]

 private:
  struct Block {
    Mat<Dim> W;
    int column;
  };
  std::vector<std::size_t> row_start_;
  std::vector<Block> blocks_;
  std::vector<Mat<Dim>> diagonal_;
  std::vector<Vec<Dim>> free_velocity_, impulse_, before_;
};

template <int Dim>
DelassusSystem<Dim>::DelassusSystem(std::span<const MatrixEntry> entries,
                                    std::span<const Vec<Dim>> free_velocity)
    : row_start_(free_velocity.size() + 1),
      diagonal_(free_velocity.size()),
      free_velocity_(free_velocity.begin(), free_velocity.end()),
      impulse_(free_velocity.size()) {
  std::vector<MatrixEntry> sorted(entries.begin(), entries.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const MatrixEntry& a, const MatrixEntry& b) {
    return std::pair(a.row / Dim, a.column / Dim) < std::pair(b.row / Dim, b.column / Dim);
  });
  int last_row = -1;
  for (const MatrixEntry& entry : sorted) {
    const int row = entry.row / Dim, column = entry.column / Dim;
    assert(row >= 0 && row < size() && column >= 0 && column < size());
    if (row != last_row || column != blocks_.back().column) blocks_.push_back({{}, column});
    last_row = row;
    blocks_.back().W(entry.row % Dim, entry.column % Dim) += entry.value;
    row_start_[row + 1] = blocks_.size();
    if (row == column) diagonal_[row] = blocks_.back().W;
  }
  for (std::size_t row = 1; row < row_start_.size(); ++row)  // rows without entries
    row_start_[row] = std::max(row_start_[row], row_start_[row - 1]);
}

}  // namespace softgrain
