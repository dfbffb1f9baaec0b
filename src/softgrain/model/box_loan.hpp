#pragma once
#include <utility>

#include "softgrain/geometry/box.hpp"

namespace softgrain {

/// Lends a box to the engine of a model while it lives, so that its walls stand in one place.
class BoxLoan {
 public:
  BoxLoan(Box<2>& owner, Box<2>& borrower) : owner_(owner), borrower_(borrower) {
    std::swap(owner_, borrower_);
  }
  ~BoxLoan() { std::swap(owner_, borrower_); }
  BoxLoan(const BoxLoan&) = delete;
  BoxLoan& operator=(const BoxLoan&) = delete;

 private:
  Box<2>&owner_, &borrower_;
};

}  // namespace softgrain
