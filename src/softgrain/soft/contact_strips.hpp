#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/contact_of.hpp"

namespace softgrain {

/// Contacts in strips, such that contacts of two strips that are not neighbours share no vertex: all even
/// strips may be worked on at once, then all odd ones, with the same bits on any number of threads.
struct ContactStrips {
  /// In the plane upright strips, or strips along the second lattice vector of a periodic cell, so wide that
  /// no contact reaches across one at the end of the step. Keeps the memory of an earlier call.
  void sort(std::span<const OutlineContact> contacts, const OutlineState& outline);
  /// In space by levels of the graph of contacts (ContactLevels), and in each by the grains whose points they
  /// are: they follow from the list of contacts alone, and stay with it.
  void sort(std::span<const SurfaceContact> contacts);

  int count() const { return static_cast<int>(begin.size()) - 1; }

  std::vector<int> order;  ///< (contacts) strip by strip, as in the list within each; in space within a grain
  std::vector<int> place;  ///< (contacts) of each contact in `order`
  std::vector<int> begin{0};  ///< (strips + 1) where in `order` each begins

 private:
  std::vector<int> strip_;
};

}  // namespace softgrain
