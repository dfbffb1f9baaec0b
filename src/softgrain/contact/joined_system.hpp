#pragma once
#include <span>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/nlgs.hpp"

namespace softgrain {

/// Two systems as one, which may share bodies: the contacts of the first, then those of the second, swept in
/// this order, each by its own sweep if it has one. Keeps references.
template <int Dim, ContactSystem<Dim> First, ContactSystem<Dim> Second>
class JoinedSystem {
 public:
  JoinedSystem(First& first, Second& second) : first_(first), second_(second), split_(first.size()) {}

  int size() const { return split_ + second_.size(); }
  Mat<Dim> delassus_block(int contact) const {
    return contact < split_ ? Mat<Dim>(first_.delassus_block(contact))
                            : Mat<Dim>(second_.delassus_block(contact - split_));
  }
  Vec<Dim> relative_velocity(int contact) const {
    return contact < split_ ? first_.relative_velocity(contact) : second_.relative_velocity(contact - split_);
  }
  void apply_impulse(int contact, const Vec<Dim>& dp) {
    contact < split_ ? first_.apply_impulse(contact, dp) : second_.apply_impulse(contact - split_, dp);
  }
  Violation sweep(std::span<Vec<Dim>> impulse, std::span<const double> friction,
                  const SolverOptions& options) {
    const auto split = static_cast<std::size_t>(split_);
    Violation violation = sweep_once<Dim>(first_, impulse.first(split), friction.first(split), options);
    return violation += sweep_once<Dim>(second_, impulse.subspan(split), friction.subspan(split), options);
  }
  /// Each its own bodies.
  void extrapolate(double b) requires Extrapolates<First> && Extrapolates<Second> {
    first_.extrapolate(b);
    second_.extrapolate(b);
  }

 private:
  First& first_;
  Second& second_;
  int split_;
};

}  // namespace softgrain
