#pragma once
#include <utility>

#include "softgrain/geometry/box.hpp"

namespace softgrain {

/// Lends a box to the engine of a model while it lives, so that its walls stand in one place.
template <int Dim>
class BoxLoan {
 public:
  BoxLoan(Box<Dim>& owner, Box<Dim>& borrower) : owner_(owner), borrower_(borrower) {
    std::swap(owner_, borrower_);
  }
  ~BoxLoan() { std::swap(owner_, borrower_); }
  BoxLoan(const BoxLoan&) = delete;
  BoxLoan& operator=(const BoxLoan&) = delete;

 private:
  Box<Dim>&owner_, &borrower_;
};

}  // namespace softgrain
