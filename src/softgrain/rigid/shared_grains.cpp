#include <algorithm>
#include <utility>

#include "softgrain/rigid/step.hpp"

// What each rank knows of the grains of others.

namespace softgrain {
namespace {

/// Rows of a grain's particles.
template <class T>
std::span<T> rows_of(const GrainRange& grain, std::vector<T>& rows) {
  return std::span(rows).subspan(grain.begin, grain.end - grain.begin);
}

template <int Dim>
void pass_motion(const GrainRange& grain, RigidParticles<Dim>& particles, Message& message) {
  message(rows_of(grain, particles.position));
  message(rows_of(grain, particles.velocity));
  message(rows_of(grain, particles.spin));
}

/// A block and what is written of its contacts.
template <int Dim>
struct Rows {
  ContactBlock block;
  std::vector<int> body_a, body_b;
  std::vector<double> friction, gap;
  std::vector<Vec<Dim>> normal, impulse;
};

/// visit(rows of contacts, the same of Rows) for each array.
template <int Dim, class Visit>
void for_each_array(RigidContacts<Dim>& contacts, Rows<Dim>& rows, const Visit& visit) {
  visit(contacts.body_a, rows.body_a), visit(contacts.body_b, rows.body_b);
  visit(contacts.friction, rows.friction), visit(contacts.gap, rows.gap);
  visit(contacts.normal, rows.normal), visit(contacts.impulse, rows.impulse);
}

}  // namespace

template <int Dim>
void RigidDynamics<Dim>::share_grains() {
  reference.shared =
      options.precision == Precision::single && options.law.activation == Activation::anticipated;
}

/// The particles of this rank's grains, and those of others with contacts between grains.
template <int Dim>
void RigidDynamics<Dim>::follow_others() {
  Followed& followed = particles.followed;
  followed = {.begin = particles.size(), .end = 0};
  for (int g = 0; g < reference.between_list(); ++g)
    if (reference.shares.mine(g)) {
      followed.begin = std::min(followed.begin, reference.grains[g].begin);
      followed.end = std::max(followed.end, reference.grains[g].end);
    }
  if (followed.end == 0) followed.begin = 0;
  const auto add = [&](int body) {
    if (body < particles.size() && !(followed.begin <= body && body < followed.end))
      followed.others.push_back(body);
  };
  for (int c = contacts.blocks.back().begin(); c < contacts.size(); ++c)
    add(contacts.body_a[c]), add(contacts.body_b[c]);
  std::sort(followed.others.begin(), followed.others.end());
  const auto repeated = std::unique(followed.others.begin(), followed.others.end());
  followed.others.erase(repeated, followed.others.end());
}

template <int Dim>
void RigidDynamics<Dim>::know_all() {
  if (reference.shares.alone()) return;
  shared_for(
      reference.shares, reference.between_list(), [](int) {},
      [&](int g, Message& message) { pass_motion(reference.grains[g], particles, message); });
}

template <int Dim>
void RigidDynamics<Dim>::gather() {
  if (reference.shares.alone()) return;
  collect(
      reference.shares, reference.between_list(), [](int g) { return g; },
      [&](int g, Message& message) {
        pass_motion(reference.grains[g], particles, message);
        message(rows_of(reference.grains[g], reference.position));
      });
  take_own_contacts();
  collect_contacts();
}

/// The first rank gets the contacts inside all grains; its own stay beside them.
template <int Dim>
void RigidDynamics<Dim>::collect_contacts() {
  const int grains = reference.between_list();
  std::vector<Rows<Dim>> rows(grains + 1);
  for (int list = 0; list <= grains; ++list) {
    rows[list].block = contacts.blocks[list];
    for_each_array(contacts, rows[list], [&](auto& from, auto& to) {
      const ContactBlock& block = rows[list].block;
      to.assign(from.begin() + block.begin(), from.begin() + block.end());
    });
  }
  collect(
      reference.shares, grains, [](int g) { return g; },
      [&](int g, Message& message) {
        message(rows[g].block);
        for_each_array(contacts, rows[g], [&](auto&, auto& list) { message.list(list); });
      });
  if (communicator().rank() != 0) return;
  own_contacts_ = std::exchange(contacts, {});
  contacts.cell = own_contacts_->cell;
  contacts.image = own_contacts_->image;
  for (Rows<Dim>& of_list : rows) {
    of_list.block.move_to(contacts.size());
    contacts.blocks.push_back(of_list.block);
    for_each_array(contacts, of_list, [&](auto& to, auto& from) {
      to.insert(to.end(), from.begin(), from.end());
      from = {};
    });
  }
}

template <int Dim>
void RigidDynamics<Dim>::take_own_contacts() {
  if (own_contacts_) contacts = std::move(*std::exchange(own_contacts_, std::nullopt));
}

template void RigidDynamics<2>::share_grains();
template void RigidDynamics<2>::follow_others();
template void RigidDynamics<2>::know_all();
template void RigidDynamics<2>::gather();
template void RigidDynamics<2>::collect_contacts();
template void RigidDynamics<2>::take_own_contacts();
template void RigidDynamics<3>::share_grains();
template void RigidDynamics<3>::follow_others();
template void RigidDynamics<3>::know_all();
template void RigidDynamics<3>::gather();
template void RigidDynamics<3>::collect_contacts();
template void RigidDynamics<3>::take_own_contacts();

}  // namespace softgrain
