#include "softgrain/soft/outline_adhesion.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/carried_impulses.hpp"

namespace softgrain {
namespace {

/// Contacts that a thread takes at once.
constexpr int adhesive_contacts_at_once = 256;

}  // namespace

OutlineAdhesion::OutlineAdhesion(const SoftGrains& grains, std::span<const PairAdhesion> named)
    : kinds_(grains.kinds()), between_(static_cast<std::size_t>(kinds_) * kinds_), at_walls_(kinds_) {
  for (const auto& [kind, other, law] : named) {
    require(law.surface_energy >= 0 && std::isfinite(law.surface_energy),
            "the surface energy must be >= 0 J/m^2, got {}", law.surface_energy);
    require(kind >= 0 && kind < kinds_ && other >= PairAdhesion::wall && other < kinds_,
            "adhesion of kinds {} and {}, but there are {}", kind, other, kinds_);
    if (!law.any()) continue;
    require(law.range > 0 && std::isfinite(law.range), "the range of adhesion must be > 0 m, got {}",
            law.range);
    range_ = std::max(range_, law.range);
    if (other == PairAdhesion::wall)
      at_walls_[kind] = law;
    else
      between_[kind * kinds_ + other] = between_[other * kinds_ + kind] = law;
  }
  if (!any()) return;
  for (int g = 0; g < grains.size(); ++g) {
    const std::span<const Vec<2>> X = grains.topology(g).grid.outline();
    const std::size_t n = X.size();
    for (std::size_t v = 0; v < n; ++v)
      length_.push_back(grains.radius(g) * (norm(X[(v + 1) % n] - X[v]) + norm(X[v] - X[(v + n - 1) % n])) /
                        2);
  }
}

bool OutlineAdhesion::adhere(int kind, int other) const {
  return (other == PairAdhesion::wall ? at_walls_[kind] : between_[kind * kinds_ + other]).any();
}

const Adhesion& OutlineAdhesion::law_of(const SoftGrains& grains, const OutlineContact& contact) const {
  const int kind = grains.kind(grains.grain_of_vertex(contact.vertex));
  if (contact.wall >= 0) return at_walls_[kind];
  return between_[kind * kinds_ + grains.kind(grains.grain_of_vertex(contact.master[0]))];
}

AdhesiveContacts OutlineAdhesion::contacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                           const OutlineState& state, bool at_end,
                                           std::span<double> attraction) const {
  AdhesiveContacts adhesive;
  if (!any()) return adhesive;
  adhesive.attraction = attraction;
  adhesive.contact.resize(contacts.size());
  const int count = static_cast<int>(contacts.size());
  parallel_for((count + adhesive_contacts_at_once - 1) / adhesive_contacts_at_once, [&](int part) {
    const int begin = part * adhesive_contacts_at_once;
    for (int c = begin; c < std::min(count, begin + adhesive_contacts_at_once); ++c) {
      const OutlineContact& contact = contacts[c];
      const Adhesion& law = law_of(grains, contact);
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
