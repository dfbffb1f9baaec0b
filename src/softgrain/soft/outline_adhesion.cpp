#include "softgrain/soft/outline_adhesion.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/carried_impulses.hpp"

namespace softgrain {

OutlineAdhesion::OutlineAdhesion(const SoftGrains& grains, std::span<const PairAdhesion> named)
    : range_(longest_range(named)), law_(adhesion_by_kinds(grains.kinds(), named)) {
  if (!any()) return;
  for (int g = 0; g < grains.size(); ++g) {
    const std::span<const Vec<2>> X = grains.topology(g).grid.outline();
    const std::size_t n = X.size();
    for (std::size_t v = 0; v < n; ++v)
      length_.push_back(grains.radius(g) * (norm(X[(v + 1) % n] - X[v]) + norm(X[v] - X[(v + n - 1) % n])) /
                        2);
  }
}

AdhesiveContacts OutlineAdhesion::contacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                           const OutlineState& state, bool at_end,
                                           std::span<double> attraction) const {
  AdhesiveContacts adhesive;
  if (!any()) return adhesive;
  adhesive.attraction = attraction;
  adhesive.contact.resize(contacts.size());
  parallel_ranges(static_cast<int>(contacts.size()), [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      const OutlineContact& contact = contacts[c];
      const Adhesion& law = value_of(law_, grains, contact);
      if (!law.any()) continue;
      adhesive.contact[c] = {.law = law,
                             .pull = length_of(contact) * state.dt,
                             .gap = contact.gap - dot(contact.normal, relative_displacement(contact, state)),
                             .dt = state.dt,
                             .at_end = at_end};
    }
  });
  return adhesive;
}

double energy_at_start(const AdhesiveContacts& contacts) {
  double sum = 0;
  for (const AdhesiveContact& contact : contacts.contact)
    if (contact.pull > 0) sum += contact.pull / contact.dt * contact.law.energy(contact.gap);
  return sum;
}

std::vector<Vec<2>> felt_impulses(std::span<const Vec<2>> impulse, std::span<const double> attraction) {
  std::vector<Vec<2>> felt(impulse.begin(), impulse.end());
  for (std::size_t c = 0; c < attraction.size(); ++c) felt[c][0] -= attraction[c];
  return felt;
}

std::vector<double> carried_attraction(const SoftGrains& grains, std::span<const OutlineContact> old,
                                       std::span<const double> old_attraction,
                                       std::span<const OutlineContact> contacts) {
  std::vector<Vec<1>> before;
  for (const double a : old_attraction) before.push_back({a});
  const std::vector<Vec<1>> carried = carry_impulses(
      old, std::span<const Vec<1>>(before), contacts, [](const OutlineContact& c) { return c.vertex; },
      [&](const OutlineContact& c) { return grains.grain_of_vertex(c.master[0]); },
      [](const OutlineContact&, const Vec<1>& a, const OutlineContact&) { return a; });
  std::vector<double> attraction;
  for (const Vec<1>& a : carried) attraction.push_back(a[0]);
  return attraction;
}

}  // namespace softgrain
