#include "softgrain/contact/coloring.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace softgrain {
namespace {

constexpr int bits = 64;  // of a word

/// The most contacts that a particle has.
int most_contacts(std::span<const int> body_a, std::span<const int> body_b, int particles) {
  std::vector<int> count(particles, 0);
  for (const auto& bodies : {body_a, body_b})
    for (const int body : bodies)
      if (body < particles) ++count[body];
  return particles > 0 ? *std::max_element(count.begin(), count.end()) : 0;
}

}  // namespace

std::vector<int> color_contacts(std::span<const int> body_a, std::span<const int> body_b, int particles) {
  // the contacts of two particles need fewer colours than both have contacts
  const std::size_t words = 2 * most_contacts(body_a, body_b, particles) / bits + 1;
  std::vector<std::uint64_t> used(words * particles, 0);  // bit k: the particle has a contact of colour k
  std::vector<int> color(body_a.size());
  for (std::size_t c = 0; c < color.size(); ++c) {
    for (std::size_t word = 0; word < words; ++word) {
      std::uint64_t taken = 0;
      for (const int body : {body_a[c], body_b[c]})
        if (body < particles) taken |= used[words * body + word];
      if (taken == ~std::uint64_t{0}) continue;
      const int free = std::countr_one(taken);
      color[c] = static_cast<int>(word) * bits + free;
      for (const int body : {body_a[c], body_b[c]})
        if (body < particles) used[words * body + word] |= std::uint64_t{1} << free;
      break;
    }
  }
  return color;
}

}  // namespace softgrain
