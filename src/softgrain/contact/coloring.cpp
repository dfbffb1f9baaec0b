#include "softgrain/contact/coloring.hpp"

#include <bit>
#include <cassert>
#include <cstdint>

namespace softgrain {

std::vector<int> color_contacts(std::span<const int> body_a, std::span<const int> body_b, int particles) {
  std::vector<std::uint64_t> used(particles, 0);  // bit k: the particle has a contact of colour k
  std::vector<int> color(body_a.size());
  for (std::size_t c = 0; c < color.size(); ++c) {
    std::uint64_t taken = 0;
    for (const int body : {body_a[c], body_b[c]})
      if (body < particles) taken |= used[body];
    color[c] = std::countr_one(taken);
    assert(color[c] < 64);
    for (const int body : {body_a[c], body_b[c]})
      if (body < particles) used[body] |= std::uint64_t{1} << color[c];
  }
  return color;
}

}  // namespace softgrain
