#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/contact_of.hpp"

namespace softgrain {

/// Contacts in upright strips (slabs in space), or strips along the second lattice vector of a periodic cell,
/// so wide that contacts of two strips that are not neighbours share no vertex: all even strips may be worked
/// on at once, then all odd ones, with the same bits on any number of threads.
struct ContactStrips {
  /// At the end of the step. Keeps the memory of an earlier call.
  template <int Dim>
  void sort(Contacts<Dim> contacts, const OutlineStateOf<Dim>& outline);

  int count() const { return static_cast<int>(begin.size()) - 1; }

  std::vector<int> order;     ///< (contacts) strip by strip, as in the list within each
  std::vector<int> place;     ///< (contacts) of each contact in `order`
  std::vector<int> begin{0};  ///< (strips + 1) where in `order` each begins

 private:
  std::vector<int> strip_;
};

}  // namespace softgrain
