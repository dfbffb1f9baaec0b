#include "softgrain/soft/contact_work.hpp"

#include "softgrain/contact/tangents.hpp"
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

template <int Dim>
void add_contact_work(Contacts<Dim> contacts, Impulses<Dim> impulse, const OutlineStateOf<Dim>& state,
                      WorkBudget& work, std::type_identity_t<std::span<Vec<Dim>>> wall_impulse) {
  const auto of_range = [&](int begin, int end) {
    WorkOfContacts sum;
    for (int c = begin; c < end; ++c) {
      if (impulse[c] == Vec<Dim>{}) continue;
      const Vec<Dim> u = (1 / state.dt) * relative_displacement(contacts[c], state);
      sum.all -= dot(impulse_vector(contacts[c], impulse[c]), u);
      if (impulse[c][1] == 0 && impulse[c][Dim - 1] == 0) continue;
      const auto t = tangents(contacts[c].normal);
      for (int k = 1; k < Dim; ++k)
        sum.friction -= impulse[c][k] * dot(t[static_cast<std::size_t>(k - 1)], u);
    }
    return sum;
  };
  const auto sum = parallel_sum<WorkOfContacts>(static_cast<int>(contacts.size()), of_range);
  work.contacts += sum.all;
  work.friction += sum.friction;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const int wall = contacts[c].wall;
    if (impulse[c] == Vec<Dim>{} || (wall < 0 && !state.cell.any())) continue;
    const Vec<Dim> P = impulse_vector(contacts[c], impulse[c]);
    work.walls += dot(P, contacts[c].image_motion) / state.dt;
    if (wall < 0) continue;
    wall_impulse[wall] -= P;
    work.walls += dot(P, state.walls[wall].velocity);
  }
}

template void add_contact_work(Contacts<2>, Impulses<2>, const OutlineStateOf<2>&, WorkBudget&,
                               std::span<Vec<2>>);
template void add_contact_work(Contacts<3>, Impulses<3>, const OutlineStateOf<3>&, WorkBudget&,
                               std::span<Vec<3>>);

}  // namespace softgrain
