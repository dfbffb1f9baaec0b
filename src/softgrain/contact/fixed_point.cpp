#include "softgrain/contact/fixed_point.hpp"

#include <cmath>
#include <cstddef>

namespace softgrain {
namespace {

/// Changes that are kept, and how much r may grow.
constexpr std::size_t longest_memory = 8;
constexpr double most_growth = 2;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// a += factor b
void add(std::span<double> a, double factor, std::span<const double> b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

}  // namespace

void FixedPoint::improve(std::span<double> a, std::span<const double> r) {
  if (!r_.empty() && dot(r, r) > most_growth * most_growth * dot(r_, r_)) q_.clear(), s_.clear(), r_.clear();
  if (!r_.empty()) {
    if (q_.size() == longest_memory) q_.erase(q_.begin()), s_.erase(s_.begin());
    std::vector<double> q(r.begin(), r.end()), s(a.begin(), a.end());
    add(q, -1, r_);
    add(s, -1, a_);
    const double whole = std::sqrt(dot(q, q));
    for (std::size_t j = 0; j < q_.size(); ++j) {
      const double along = dot(q_[j], q);
      add(q, -along, q_[j]);
      add(s, -along, s_[j]);
    }
    const double size = std::sqrt(dot(q, q));
    constexpr double independent = 1e-6;
    if (size > independent * whole) {
      for (double& x : q) x /= size;
      for (double& x : s) x /= size;
      q_.push_back(std::move(q));
      s_.push_back(std::move(s));
    }
  }
  a_.assign(a.begin(), a.end());
  r_.assign(r.begin(), r.end());
  add(a, 1, r);
  for (std::size_t j = 0; j < q_.size(); ++j) {
    const double along = dot(q_[j], r);
    add(a, -along, q_[j]);
    add(a, -along, s_[j]);
  }
}

}  // namespace softgrain
