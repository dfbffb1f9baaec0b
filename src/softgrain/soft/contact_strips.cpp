#include "softgrain/soft/contact_strips.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgrain/contact/contact_levels.hpp"

namespace softgrain {
namespace {

/// Contacts of a strip, about: enough that a thread has something to do.
constexpr int contacts_per_strip = 64;

/// Of one or more levels, at least.
constexpr int contacts_per_level = 256;

}  // namespace

void ContactStrips::sort(std::span<const OutlineContact> contacts, const OutlineState& outline) {
  const int n = static_cast<int>(contacts.size());
  const bool ring = outline.cell.repeats[0];  // the last strip is then next to the first
  const Mat<2> to_share = inverse(outline.cell.edges);
  const auto along = [&](const Vec<2>& x) { return ring ? (to_share * x)[0] : x[0]; };
  double low = 0, high = 0, reach = 0;  // of a contact's vertices from its slave
  for (int c = 0; c < n; ++c) {
    const double x = along(outline.position[contacts[c].vertex]), image = ring ? along(contacts[c].image) : 0;
    low = c == 0 ? x : std::min(low, x);
    high = c == 0 ? x : std::max(high, x);
    const auto reach_to = [&](int vertex, double shift) {
      if (vertex != contacts[c].vertex)
        reach = std::max(reach, std::abs(along(outline.position[vertex]) + shift - x));
    };
    contacts[c].for_each_vertex([&](int vertex, double) { reach_to(vertex, image); });
  }
  if (ring) low = 0, high = 1;
  // vertices of strip s lie in (s width - reach, (s + 1) width + reach)
  const double length = high - low, most = reach > 0 ? length / (2.01 * reach) : n;
  const bool divisible = length > 0 && std::isfinite(length);
  const int wanted = n / contacts_per_strip;
  int strips = divisible ? std::max(1, static_cast<int>(std::min<double>(wanted, most))) : 1;
  if (ring && strips > 1) strips -= strips % 2;
  strip_.resize(n);
  begin.assign(strips + 1, 0);
  for (int c = 0; c < n; ++c) {
    double share = (along(outline.position[contacts[c].vertex]) - low) / length;
    if (ring) share -= std::floor(share);
    strip_[c] = strips == 1 ? 0 : std::min(strips - 1, static_cast<int>(strips * share));
    ++begin[strip_[c] + 1];
  }
  for (int s = 0; s < strips; ++s) begin[s + 1] += begin[s];
  order.resize(n);
  place.resize(n);
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int c = 0; c < n; ++c) order[place[c] = next[strip_[c]]++] = c;
}

void ContactStrips::sort(std::span<const SurfaceContact> contacts) {
  const auto n = static_cast<int>(contacts.size());
  int grains = 0;
  for (const SurfaceContact& c : contacts) grains = std::max({grains, c.grain + 1, c.facing + 1});
  std::vector<int> next(grains + 1), by_grain(n), grain(n), facing(n);
  for (const SurfaceContact& c : contacts) ++next[c.grain + 1];
  for (int g = 0; g < grains; ++g) next[g + 1] += next[g];
  for (int c = 0; c < n; ++c) {
    const int k = next[contacts[c].grain]++;
    by_grain[k] = c, grain[k] = contacts[c].grain, facing[k] = contacts[c].facing;
  }
  ContactLevels levels = contact_levels(grain, facing, grains, contacts_per_level);
  begin = std::move(levels.begin);
  order = std::move(levels.contact);
  place.resize(n);
  for (int k = 0; k < n; ++k) place[order[k] = by_grain[order[k]]] = k;
}

}  // namespace softgrain
