#include "softgrain/rigid/contact_state.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

template <int Dim>
std::pair<std::int64_t, std::int64_t> pair_of(const RigidContacts<Dim>& contacts, int c) {
  return {contacts.body_a[c], contacts.body_b[c]};
}

}  // namespace

template <int Dim>
void visit_impulses(RigidContacts<Dim>& contacts, StateVisitor& visit,
                    const std::function<bool(std::int64_t, std::int64_t)>& is_mine) {
  std::vector<std::int64_t> pairs;
  std::vector<Vec<Dim>> impulse;
  for (int c = 0; c < contacts.size(); ++c) {
    if (contacts.impulse[c] == Vec<Dim>{}) continue;
    pairs.insert(pairs.end(), {contacts.body_a[c], contacts.body_b[c]});
    impulse.push_back(contacts.impulse[c]);
  }
  visit.list({"contact_pair", "", Owner::contact, Role::start, "primaries, or a wall counted on from them"},
             pairs, 2);
  visit.list({"contact_impulse", "N s/m", Owner::contact, Role::start, "(p_n, p_t)"}, impulse);
  if (!visit.reads()) return;
  if (pairs.size() != 2 * impulse.size())
    throw IoError("the snapshot's arrays of contacts have different lengths");
  std::vector<int> sorted(contacts.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  const auto by_pair = [&](int c) { return pair_of(contacts, c); };
  std::sort(sorted.begin(), sorted.end(), [&](int a, int b) { return by_pair(a) < by_pair(b); });
  std::fill(contacts.impulse.begin(), contacts.impulse.end(), Vec<Dim>{});
  for (std::size_t k = 0; k < impulse.size(); ++k) {
    const std::pair wanted(pairs[2 * k], pairs[2 * k + 1]);
    if (!is_mine(wanted.first, wanted.second)) continue;
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), wanted,
                                        [&](int c, const auto& pair) { return by_pair(c) < pair; });
    if (found == sorted.end() || by_pair(*found) != wanted)
      throw IoError(
          fmt::format("the snapshot's array 'contact_pair' holds {} and {}, which do not touch here",
                      wanted.first, wanted.second));
    contacts.impulse[*found] = impulse[k];
  }
}

template void visit_impulses<2>(RigidContacts<2>&, StateVisitor&,
                                const std::function<bool(std::int64_t, std::int64_t)>&);
template void visit_impulses<3>(RigidContacts<3>&, StateVisitor&,
                                const std::function<bool(std::int64_t, std::int64_t)>&);

}  // namespace softgrain
