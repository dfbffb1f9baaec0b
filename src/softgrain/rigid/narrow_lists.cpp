#include <algorithm>
#include <type_traits>

#include "softgrain/contact/tangents.hpp"
#include "softgrain/rigid/narrow_impulses.hpp"

namespace softgrain {
namespace {

using Integers = int __attribute__((vector_size(32)));

}  // namespace

/// Each Eight takes the contacts that follow until one shares a particle with those before.
template <int Dim>
template <class AnyEight>
void NarrowSweepsOf<Dim>::fill(const RigidContacts<Dim>& contacts, const ContactBatch& listed, int begin,
                               int idle, Batch<AnyEight>& batch) const {
  batch = {};
  for (int c = listed.begin; c < listed.end;) {
    AnyEight next{};
    int count = 0;
    const auto shares = [&](int a, int b, double inverse_b) {
      for (int k = 0; k < count; ++k)
        if (a == next.a[k] || a == next.b[k] || b == next.a[k] || (b == next.b[k] && inverse_b > 0))
          return true;
      return false;
    };
    const int first = c;
    for (; c < listed.end && count < eight; ++c, ++count) {
      const int a = contacts.body_a[c], b = contacts.body_b[c];
      if (shares(a, b, contacts.inverse_mass_b[c])) break;
      next.a[count] = a;
      next.b[count] = b;
      next.inverse_a[count] = static_cast<float>(contacts.inverse_mass_a[c]);
      next.inverse_b[count] = static_cast<float>(contacts.inverse_mass_b[c]);
      next.gain[count] = relaxation_ * static_cast<float>(contacts.inverse_delassus[c]);
      if constexpr (std::is_same_v<AnyEight, FrictionalEight>)
        next.friction[count] = static_cast<float>(contacts.friction[c]);
    }
    std::fill(next.a + count, next.a + eight, idle);
    std::fill(next.b + count, next.b + eight, idle);
    batch.eights.push_back(next);
    batch.places.push_back({first - begin, count});
  }
}

/// What changes from step to step; then v += M^-1 H p.
template <int Dim>
template <class AnyEight>
void NarrowSweepsOf<Dim>::load(const RigidContacts<Dim>& contacts, std::span<const double> offset,
                               const ContactBlock& listed, Batch<AnyEight>& batch) {
  for (std::size_t k = 0; k < batch.eights.size(); ++k) {
    AnyEight& next = batch.eights[k];
    const int c = listed.begin() + batch.places[k].begin, count = batch.places[k].count;
    Vector p;
    if (c + eight <= listed.end()) {  // beyond it another thread may be at work
      const auto mine = Integers{0, 1, 2, 3, 4, 5, 6, 7} < count;
      next.n = load_narrow(&contacts.normal[c]);
      p = load_narrow(&contacts.impulse[c]);
      next.offset = Narrow(load_wide(&offset[c])).lanes;
      for (int m = 0; m < Dim; ++m) p[m] = mine ? p[m] : Floats{};
    } else {
      for (int lane = 0; lane < count; ++lane) {
        for (int m = 0; m < Dim; ++m) {
          next.n[m][lane] = static_cast<float>(contacts.normal[c + lane][m]);
          p[m][lane] = static_cast<float>(contacts.impulse[c + lane][m]);
        }
        next.offset[lane] = static_cast<float>(offset[c + lane]);
      }
    }
    next.p_n = next.p_n_before = p[0];
    Bodies bodies(velocity_.data(), next);
    if constexpr (std::is_same_v<AnyEight, FrictionalEight>) {
      for (int m = 1; m < Dim; ++m) next.p_t[m - 1] = next.p_t_before[m - 1] = p[m];
      load_tangents(next);
      bodies.apply(impulse_of(next, next.p_n, next.p_t));
      turn(next, gather_columns(spin_.data(), next.a), gather_columns(spin_.data(), next.b), next.p_t);
    } else {
      bodies.apply(impulse_of(next, next.p_n));
    }
  }
}

/// Of tangents(n), lane by lane; in the plane they are not kept.
template <int Dim>
void NarrowSweepsOf<Dim>::load_tangents([[maybe_unused]] FrictionalEight& c) {
  if constexpr (Dim == 3)
    for (int lane = 0; lane < eight; ++lane) {
      const auto t = tangents(Vec<3>{c.n[0][lane], c.n[1][lane], c.n[2][lane]});
      for (std::size_t which = 0; which < 2; ++which)
        for (int k = 0; k < 3; ++k) c.t[which][k][lane] = static_cast<float>(t[which][k]);
    }
}

template <int Dim>
void NarrowSweepsOf<Dim>::take_contacts(const RigidContacts<Dim>& contacts, const ContactBlock& listed,
                                        std::span<const double> offset) {
  Block& block = blocks_[listed.list];
  const int begin = listed.begin(), idle = bodies_ + listed.list;
  if (block.made != listed.made) {
    fill(contacts, listed.frictionless, begin, idle, block.frictionless);
    fill(contacts, listed.frictional, begin, idle, block.frictional);
    block.made = listed.made;
    if (listed.list != listed_.back()) take_range(contacts, listed, block);
  }
  velocity_[idle] = {};
  spin_[idle] = {};
  load(contacts, offset, listed, block.frictionless);
  load(contacts, offset, listed, block.frictional);
}

template <int Dim>
void NarrowSweepsOf<Dim>::read_impulses(const ContactBlock& listed, std::span<Vec<Dim>> impulse) const {
  const Block& block = blocks_[listed.list];
  const auto read = [&](const auto& batch, const auto& impulse_of) {
    for (std::size_t e = 0; e < batch.eights.size(); ++e)
      for (int lane = 0, c = listed.begin() + batch.places[e].begin; lane < batch.places[e].count;
           ++lane, ++c)
        impulse[c] = impulse_of(batch.eights[e], lane);
  };
  read(block.frictionless, [](const Eight& e, int lane) { return Vec<Dim>{e.p_n[lane]}; });
  read(block.frictional, [](const FrictionalEight& e, int lane) {
    Vec<Dim> p{e.p_n[lane]};
    for (int k = 1; k < Dim; ++k) p[k] = e.p_t[k - 1][lane];
    return p;
  });
}

template void NarrowSweepsOf<2>::take_contacts(const RigidContacts<2>&, const ContactBlock&,
                                               std::span<const double>);
template void NarrowSweepsOf<3>::take_contacts(const RigidContacts<3>&, const ContactBlock&,
                                               std::span<const double>);
template void NarrowSweepsOf<2>::read_impulses(const ContactBlock&, std::span<Vec<2>>) const;
template void NarrowSweepsOf<3>::read_impulses(const ContactBlock&, std::span<Vec<3>>) const;

}  // namespace softgrain
