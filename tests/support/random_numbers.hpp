#pragma once
#include <cstdint>

#include "softgrain/math/random.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain::test {

/// Random numbers one after the other, the same in every run.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : seed_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * random_uniform(seed_, 7, index_++); }

  /// Each component in [-size, size).
  template <int N>
  Vec<N> vector(double size) {
    Vec<N> v;
    for (int k = 0; k < N; ++k) v[k] = uniform(-size, size);
    return v;
  }

  template <int N>
  Vec<N> unit_vector() {
    const Vec<N> v = vector<N>(1);
    const double length = norm(v);
    return length > 0.1 && length < 1 ? (1 / length) * v : unit_vector<N>();
  }

 private:
  std::uint64_t seed_, index_ = 0;
};

}  // namespace softgrain::test
