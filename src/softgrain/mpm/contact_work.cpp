#include "softgrain/mpm/contact_work.hpp"

namespace softgrain {

void add_contact_work(std::span<const OutlineContact> contacts, std::span<const Vec<2>> impulse,
                      const OutlineState& state, WorkBudget& work, std::span<Vec<2>> wall_impulse) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vec<2> P = impulse_vector(contacts[c], impulse[c]);
    work.contacts -= dot(P, relative_displacement(contacts[c], state)) / state.dt;
    const int wall = contacts[c].wall;
    if (wall < 0) continue;
    wall_impulse[wall] -= P;
    work.walls += dot(P, state.walls[wall].velocity);
  }
}

}  // namespace softgrain
