#include "softgrain/soft/contact_work.hpp"

#include "softgrain/core/parallel.hpp"

namespace softgrain {
namespace {

struct WorkOfContacts {
  double all = 0, friction = 0;
  WorkOfContacts& operator+=(const WorkOfContacts& more) {
    all += more.all;
    friction += more.friction;
    return *this;
  }
};

}  // namespace

void add_contact_work(std::span<const OutlineContact> contacts, std::span<const Vec<2>> impulse,
                      const OutlineState& state, WorkBudget& work, std::span<Vec<2>> wall_impulse) {
  const auto of_range = [&](int begin, int end) {
    WorkOfContacts sum;
    for (int c = begin; c < end; ++c) {
      if (impulse[c][0] == 0) continue;
      const Vec<2> u = (1 / state.dt) * relative_displacement(contacts[c], state);
      sum.all -= dot(impulse_vector(contacts[c], impulse[c]), u);
      sum.friction -= impulse[c][1] * dot(perpendicular(contacts[c].normal), u);
    }
    return sum;
  };
  const auto sum = parallel_sum<WorkOfContacts>(static_cast<int>(contacts.size()), of_range);
  work.contacts += sum.all;
  work.friction += sum.friction;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const int wall = contacts[c].wall;
    if (impulse[c][0] == 0 || (wall < 0 && !state.cell.any())) continue;
    const Vec<2> P = impulse_vector(contacts[c], impulse[c]);
    work.walls += dot(P, contacts[c].image_motion) / state.dt;
    if (wall < 0) continue;
    wall_impulse[wall] -= P;
    work.walls += dot(P, state.walls[wall].velocity);
  }
}

}  // namespace softgrain
