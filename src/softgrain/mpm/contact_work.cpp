#include "softgrain/mpm/contact_work.hpp"

namespace softgrain {

void add_contact_work(std::span<const OutlineContact> contacts, std::span<const Vec<2>> impulse,
                      const OutlineState& state, WorkBudget& work, std::span<Vec<2>> wall_impulse) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (impulse[c][0] == 0) continue;
    const Vec<2> P = impulse_vector(contacts[c], impulse[c]);
    const Vec<2> u = (1 / state.dt) * relative_displacement(contacts[c], state);
    work.contacts -= dot(P, u);
    work.friction -= impulse[c][1] * dot(perpendicular(contacts[c].normal), u);
    const int wall = contacts[c].wall;
    if (wall < 0) continue;
    wall_impulse[wall] -= P;
    work.walls += dot(P, state.walls[wall].velocity);
  }
}

}  // namespace softgrain
