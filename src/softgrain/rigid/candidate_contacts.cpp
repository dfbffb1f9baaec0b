#include <algorithm>
#include <numeric>

#include "softgrain/contact/coloring.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/math/lanes.hpp"
#include "softgrain/rigid/close_pairs.hpp"
#include "softgrain/rigid/neighbours.hpp"

namespace softgrain {
namespace {

/// Contacts of one kind in the order of the sweep.
struct Sequence {
  std::vector<BodyPair> pairs;
  int in_fours = 0;  ///< from the start, each four share no particle
};

/// Takes, again and again, the first four of `waiting` that share none of the particles 0 .. n - 1; the rest
/// comes last. Sorted by colour, almost all find three others near by.
Sequence in_fours(const std::vector<BodyPair>& waiting, int n) {
  constexpr std::size_t looks = 64;
  Sequence sequence;
  std::vector<char> taken(waiting.size(), 0);
  for (std::size_t first = 0;;) {
    while (first < waiting.size() && taken[first] != 0) ++first;
    std::array<std::size_t, lane_count> four;
    int count = 0;
    const auto shares = [&](std::size_t k) {
      for (int m = 0; m < count; ++m) {
        const BodyPair &p = waiting[four[m]], &q = waiting[k];
        if (p.a == q.a || p.a == q.b || p.b == q.a || (p.b == q.b && p.b < n)) return true;
      }
      return false;
    };
    for (std::size_t k = first; k < std::min(first + looks, waiting.size()) && count < lane_count; ++k)
      if (taken[k] == 0 && !shares(k)) four[count++] = k;
    if (count < lane_count) break;
    for (const std::size_t k : four) taken[k] = 1, sequence.pairs.push_back(waiting[k]);
  }
  sequence.in_fours = static_cast<int>(sequence.pairs.size());
  for (std::size_t k = 0; k < waiting.size(); ++k)
    if (taken[k] == 0) sequence.pairs.push_back(waiting[k]);
  return sequence;
}

/// A block as it will be swept.
struct ListedBlock {
  Sequence frictionless, frictional, pressed, crossing;
};

/// Pairs among the particles of `range`, and walls n, n + 1, ...
template <int Dim>
ListedBlock listed(std::vector<BodyPair> pairs, const FrictionRule& rule, const GrainRange& range,
                   const RigidParticles<Dim>& particles) {
  const int n = particles.size();
  const auto take_out = [&](const auto& is_alone) {
    const auto alone = std::stable_partition(pairs.begin(), pairs.end(),
                                             [&](const BodyPair& pair) { return !is_alone(pair); });
    Sequence taken{.pairs = {alone, pairs.end()}};
    pairs.erase(alone, pairs.end());
    return taken;
  };
  Sequence pressed = take_out([&](const BodyPair& pair) { return particles.press_share(pair.b) != 0; });
  Sequence crossing = take_out([](const BodyPair& pair) { return pair.crosses(); });
  std::vector<int> a, b, order(pairs.size());
  for (const BodyPair& pair : pairs) a.push_back(pair.a - range.begin), b.push_back(pair.b - range.begin);
  const std::vector<int> color = color_contacts(a, b, range.end - range.begin);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int c, int d) { return color[c] < color[d]; });
  std::vector<BodyPair> smooth, rough;
  for (const int c : order) (rule(pairs[c].a, pairs[c].b) > 0 ? rough : smooth).push_back(pairs[c]);
  return {in_fours(smooth, n), in_fours(rough, n), std::move(pressed), std::move(crossing)};
}

/// Rows `batch` of the arrays of pairs and masses.
template <int Dim>
void write(const Sequence& sequence, const RigidParticles<Dim>& particles, const FrictionRule& rule,
           const ContactBatch& batch, RigidContacts<Dim>& contacts) {
  for (int c = batch.begin; c < batch.end; ++c) {
    const auto& [a, b, image] = sequence.pairs[c - batch.begin];
    const double inverse_a = particles.inverse_mass[a], inverse_b = particles.inverse_mass[b];
    contacts.body_a[c] = a;
    contacts.body_b[c] = b;
    contacts.inverse_mass_a[c] = inverse_a;
    contacts.inverse_mass_b[c] = inverse_b;
    contacts.inverse_delassus[c] = 1 / (inverse_a + inverse_b);
    contacts.friction[c] = rule(a, b);
  }
}

template <int Dim>
std::vector<typename PeriodicCell<Dim>::Image> images_of(const Sequence& crossing) {
  std::vector<typename PeriodicCell<Dim>::Image> images;
  for (const BodyPair& pair : crossing.pairs) {
    images.emplace_back();
    std::copy_n(pair.image.begin(), Dim, images.back().begin());
  }
  return images;
}

/// The rows of a list that was not made again, with their impulses.
template <int Dim>
void copy(const RigidContacts<Dim>& old, const ContactBlock& from, int to, RigidContacts<Dim>& contacts) {
  const auto copy_rows = [&](auto array) {
    const auto& rows = old.*array;
    std::copy(rows.begin() + from.begin(), rows.begin() + from.end(), (contacts.*array).begin() + to);
  };
  using Contacts = RigidContacts<Dim>;
  copy_rows(&Contacts::body_a), copy_rows(&Contacts::body_b);
  copy_rows(&Contacts::inverse_mass_a), copy_rows(&Contacts::inverse_mass_b);
  copy_rows(&Contacts::inverse_delassus), copy_rows(&Contacts::friction);
  copy_rows(&Contacts::impulse);
}

/// The block of a list, whose contacts start at 0.
ContactBlock block_of(const ListedBlock& listed) {
  const auto batch_of = [](const Sequence& sequence, int first) {
    return ContactBatch{first, first + sequence.in_fours, first + static_cast<int>(sequence.pairs.size())};
  };
  ContactBlock block;
  block.frictionless = batch_of(listed.frictionless, 0);
  block.frictional = batch_of(listed.frictional, block.frictionless.end);
  block.pressed = batch_of(listed.pressed, block.frictional.end);
  block.crossing = batch_of(listed.crossing, block.pressed.end);
  return block;
}

/// Contacts of an old block that carry an impulse, by their body a, one of `bodies`.
template <int Dim>
class CarriedImpulses {
 public:
  CarriedImpulses(const RigidContacts<Dim>& old, const ContactBlock& block, const GrainRange& bodies)
      : old_(old), first_(bodies.begin), begin_(bodies.end - bodies.begin + 1, 0) {
    for (int c = block.begin(); c < block.end(); ++c)
      if (old.impulse[c][0] > 0) ++begin_[old.body_a[c] - first_ + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    contact_.resize(begin_.back());
    std::vector<int> next = begin_;
    for (int c = block.begin(); c < block.end(); ++c)
      if (old.impulse[c][0] > 0) contact_[next[old.body_a[c] - first_]++] = c;
  }

  /// Of the old contact of the same bodies, or 0.
  Vec<Dim> between(int a, int b) const {
    for (int k = begin_[a - first_]; k < begin_[a - first_ + 1]; ++k)
      if (old_.body_b[contact_[k]] == b) return old_.impulse[contact_[k]];
    return {};
  }

 private:
  const RigidContacts<Dim>& old_;
  int first_;
  std::vector<int> begin_, contact_;
};

/// The pairs of a list, found anew.
template <int Dim>
ListedBlock make_list(const RigidParticles<Dim>& particles, const NeighbourReference<Dim>& reference,
                      const FrictionRule& friction, int list) {
  if (list == reference.between_list())
    return listed(pairs_between(particles, reference), friction, {0, particles.size()}, particles);
  const GrainRange& grain = reference.grains[list];
  return listed(pairs_inside(particles, reference, grain), friction, grain, particles);
}

}  // namespace

template <int Dim>
RigidContacts<Dim> candidate_contacts(const RigidParticles<Dim>& particles,
                                      const NeighbourReference<Dim>& reference, const FrictionRule& friction,
                                      const RigidContacts<Dim>& old, RigidContacts<Dim> contacts) {
  const int grains = reference.between_list();
  std::vector<const ContactBlock*> before(grains + 1, nullptr);
  for (const ContactBlock& block : old.blocks) before[block.list] = &block;
  const auto is_kept = [&](int list) {
    return before[list] != nullptr && before[list]->made == reference.made[list];
  };
  std::vector<ListedBlock> made(grains + 1);
  contacts.blocks.assign(grains + 1, {});
  const auto make = [&](int list) {
    ContactBlock& block = contacts.blocks[list];
    if (is_kept(list)) {
      block = *before[list];
      return;
    }
    made[list] = make_list(particles, reference, friction, list);
    block = block_of(made[list]);
    block.any = block.end() > block.begin();
    block.rough = block.frictional.end > block.frictional.begin;
  };
  make(grains);  // on all threads by itself
  shared_for(reference.shares, grains, make, [&](int list, Message& message) {
    message(contacts.blocks[list].any), message(contacts.blocks[list].rough);
  });
  int size = 0;
  for (int list = 0; list <= grains; ++list) {
    ContactBlock& block = contacts.blocks[list];
    block.move_to(size);
    block.list = list;
    block.made = reference.made[list];
    size = block.end();
  }
  if (reference.shares.alone())
    std::erase_if(contacts.blocks, [&](const auto& block) { return !block.any && block.list != grains; });
  contacts.resize(size);
  contacts.cell = particles.cell;
  contacts.image = is_kept(grains) ? old.image : images_of<Dim>(made[grains].crossing);
  parallel_for(static_cast<int>(contacts.blocks.size()), [&](int k) {
    const ContactBlock& block = contacts.blocks[k];
    if (block.end() == block.begin()) return;  // another rank may have some
    if (is_kept(block.list)) return copy(old, *before[block.list], block.begin(), contacts);
    write(made[block.list].frictionless, particles, friction, block.frictionless, contacts);
    write(made[block.list].frictional, particles, friction, block.frictional, contacts);
    write(made[block.list].pressed, particles, friction, block.pressed, contacts);
    write(made[block.list].crossing, particles, friction, block.crossing, contacts);
    const GrainRange bodies =
        block.list == grains ? GrainRange{0, particles.size()} : reference.grains[block.list];
    const CarriedImpulses<Dim> carried(old, before[block.list] ? *before[block.list] : ContactBlock{},
                                       bodies);
    for (int c = block.begin(); c < block.end(); ++c)
      contacts.impulse[c] = carried.between(contacts.body_a[c], contacts.body_b[c]);
  });
  return contacts;
}

template RigidContacts<2> candidate_contacts<2>(const RigidParticles<2>&, const NeighbourReference<2>&,
                                                const FrictionRule&, const RigidContacts<2>&,
                                                RigidContacts<2>);
template RigidContacts<3> candidate_contacts<3>(const RigidParticles<3>&, const NeighbourReference<3>&,
                                                const FrictionRule&, const RigidContacts<3>&,
                                                RigidContacts<3>);

}  // namespace softgrain
