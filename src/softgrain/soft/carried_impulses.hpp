#pragma once
#include <span>
#include <vector>

namespace softgrain {

/// For each contact what carry(old contact, its impulse, contact) makes of the impulse of the old contact
/// with the same slave and the same wall or master grain, if that pushed; else 0. Both lists are sorted by
/// slave_of(contact), a number; grain_of(contact) is the master's.
template <class Contact, class Impulse, class Slave, class Grain, class Carry>
std::vector<Impulse> carry_impulses(std::span<const Contact> old, std::span<const Impulse> old_impulse,
                                    std::span<const Contact> contacts, const Slave& slave_of,
                                    const Grain& grain_of, const Carry& carry) {
  std::vector<Impulse> impulse(contacts.size());
  const auto same = [&](const Contact& a, const Contact& b) {
    if (a.wall >= 0 || b.wall >= 0) return a.wall == b.wall;
    return grain_of(a) == grain_of(b);
  };
  std::size_t first = 0;  // old contact of the same slave
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    while (first < old.size() && slave_of(old[first]) < slave_of(contacts[c])) ++first;
    for (std::size_t k = first; k < old.size() && slave_of(old[k]) == slave_of(contacts[c]); ++k)
      if (old_impulse[k][0] > 0 && same(old[k], contacts[c]))
        impulse[c] = carry(old[k], old_impulse[k], contacts[c]);
  }
  return impulse;
}

}  // namespace softgrain
