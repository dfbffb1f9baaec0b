#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include "softgrain/core/error.hpp"

namespace softgrain {

/// A value for the contacts of every pair of kinds of grains, the same in both orders, and of each kind with
/// walls.
template <class T>
class ByKinds {
 public:
  static constexpr int wall = -1;  ///< in the place of the other kind

  ByKinds() = default;
  ByKinds(int kinds, const T& between_grains, const T& at_walls)
      : kinds_(kinds),
        between_(static_cast<std::size_t>(kinds) * kinds, between_grains),
        at_walls_(kinds, at_walls) {}

  /// Gives one pair another value. Raises UsageError for kinds that are not there; what: "friction".
  void set(int kind, int other, const T& value, std::string_view what) {
    require(kind >= 0 && kind < kinds_ && other >= wall && other < kinds_,
            "{} of kinds {} and {}, but there are {}", what, kind, other, kinds_);
    if (other == wall)
      at_walls_[kind] = value;
    else
      between_[kind * kinds_ + other] = between_[other * kinds_ + kind] = value;
  }
  const T& of(int kind, int other) const {
    return other == wall ? at_walls_[kind] : between_[kind * kinds_ + other];
  }
  int kinds() const { return kinds_; }
  bool operator==(const ByKinds&) const = default;

 private:
  int kinds_ = 0;
  std::vector<T> between_, at_walls_;
};

}  // namespace softgrain
