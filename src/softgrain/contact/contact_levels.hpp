#pragma once
#include <span>
#include <vector>

namespace softgrain {

/// Contacts in groups of which every second one may be swept at once: no contact of group k shares a body
/// with one of group k + 2, k + 4, ... So the order of a sweep, even groups and then odd ones, depends on the
/// list of contacts alone, and threads may share each half.
struct ContactLevels {
  std::vector<int> contact;  ///< (contacts) group after group, in the order of the list inside each
  std::vector<int> begin;    ///< (groups + 1) where each group starts in `contact`

  int groups() const { return static_cast<int>(begin.size()) - 1; }
};

/// Bodies are numbered by their distance, in contacts, from the first one: bodies in contact are then at most
/// one level apart, and a contact belongs to the lower of its two levels. Consecutive levels are joined until
/// a group has at least `least` contacts, too few of which are not worth a thread's while.
///
/// body_a, body_b: (contacts) in 0 .. bodies - 1; body_b < 0 is a wall, which contacts share freely.
ContactLevels contact_levels(std::span<const int> body_a, std::span<const int> body_b, int bodies, int least);

}  // namespace softgrain
