#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "softgrain/core/shared_loop.hpp"

namespace softgrain {

/// Groups in a row, or a ring of an even number, each of which shares data with the groups beside it alone:
/// all even groups may be worked on at once, then all odd ones. Each rank has groups that lie one after the
/// other, and after each half tells its neighbours what its first and last group share with theirs: one
/// message per neighbour and half. The order of the work is that of one process, so the bits are too.
class SharedRow {
 public:
  /// All groups are on this rank.
  SharedRow() = default;
  /// weight: of each group, >= 0.
  SharedRow(std::span<const double> weight, bool ring);

  /// Two groups side by side, one on this rank, one on another.
  struct Seam {
    int left = 0, right = 0, rank = 0;  ///< rank: the other one
  };

  bool alone() const { return shares_.alone(); }
  bool mine(int group) const { return shares_.mine(group); }
  const Shares& shares() const { return shares_; }
  std::span<const Seam> seams() const { return seams_; }

  /// For each seam the items of 0 .. items - 1 that both of its groups have, where for_each(group, visit)
  /// visits those of a group, with repeats.
  template <class ForEach>
  std::vector<std::vector<int>> items_at_seams(std::size_t items, const ForEach& for_each) const {
    std::vector<std::vector<int>> of_seams;
    std::vector<int> seen(items, -1);
    int mark = 0;
    for (const Seam& seam : seams_) {
      std::vector<int>& both = of_seams.emplace_back();
      for_each(seam.left, [&](int i) { seen[i] = mark; });
      for_each(seam.right, [&](int i) {
        if (seen[i] == mark) both.push_back(i), seen[i] = mark + 1;
      });
      mark += 2;
    }
    return of_seams;
  }

  /// shared(s, message) names the data that both groups of seam s share, in the same order on both ranks.
  using Shared = std::function<void(std::size_t seam, Message& message)>;
  /// work(group) for the even groups of 0 .. groups - 1, then for the odd ones, on this rank's threads; it
  /// throws nothing.
  template <class Work>
  void alternate(int groups, const Work& work, const Shared& shared) {
    if (alone()) return parallel_alternate(groups, work);
    for (const int first : {0, 1}) {
      const double begin = process_seconds();
      const auto [own, end] = shares_.own();
      const int from = own + (own % 2 == first ? 0 : 1);
      parallel_for((std::min(end, groups) - from + 1) / 2, [&](int k) { work(from + 2 * k); });
      communicator().account.cpu_shared += process_seconds() - begin;
      swap(first, shared);
    }
  }

  /// All ranks get what result(group, message) names of each of the groups 0 .. groups - 1.
  void tell(int groups, const std::function<void(int group, Message& message)>& result) const;

 private:
  void swap(int worked, const Shared& shared);

  Shares shares_;
  std::vector<Seam> seams_;
  std::vector<std::vector<std::byte>> memory_;  // of each seam
};

}  // namespace softgrain
