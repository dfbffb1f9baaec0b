#include <algorithm>
#include <numeric>

#include "softgrain/contact/coloring.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/math/lanes.hpp"
#include "softgrain/rigid/neighbours.hpp"

namespace softgrain {
namespace {

struct BodyPair {
  int a, b;
  auto operator<=>(const BodyPair&) const = default;
};

/// Particles begin .. end - 1 with gap < skin at the reference positions, but not if `skipped(i, j)`.
template <int Dim, class Skipped>
std::vector<BodyPair> close_pairs(const RigidParticles<Dim>& particles,
                                  const std::vector<Vec<Dim>>& reference, double skin,
                                  const GrainRange& range, const Skipped& skipped) {
  const auto x = std::span(reference).subspan(range.begin, range.end - range.begin);
  const double* radius = particles.radius.data() + range.begin;
  std::vector<BodyPair> pairs;
  if (x.size() < 2) return pairs;
  const CellGrid<Dim> grid(x, 2 * *std::max_element(radius, radius + x.size()) + skin);
  grid.for_each_close_pair([&](int i, int j) {
    const Vec<Dim> d = x[j] - x[i];
    const double touch = radius[i] + radius[j] + skin;
    if (dot(d, d) < touch * touch && !skipped(range.begin + i, range.begin + j))
      pairs.push_back({range.begin + i, range.begin + j});
  });
  return pairs;
}

/// Pairs of different grains, then of particles and walls.
template <int Dim>
std::vector<BodyPair> pairs_between(const RigidParticles<Dim>& particles,
                                    const NeighbourReference<Dim>& reference) {
  const auto& grain = particles.grain;
  std::vector<BodyPair> pairs;
  if (reference.grains.size() > 1)
    pairs = close_pairs(particles, reference.between, reference.skin, {0, particles.size()},
                        [&](int i, int j) { return grain[i] == grain[j]; });
  for (std::size_t w = 0; w < particles.walls.size(); ++w) {
    for (int i = 0; i < particles.size(); ++i) {
      const double height = dot(reference.between[i] - reference.wall_point[w], particles.walls[w].normal);
      if (height < particles.radius[i] + reference.skin)
        pairs.push_back({i, particles.wall_body(static_cast<int>(w))});
    }
  }
  return pairs;
}

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
  Sequence frictionless, frictional;
};

/// Pairs among the particles of `range`, and walls n, n + 1, ...
ListedBlock listed(const std::vector<BodyPair>& pairs, const FrictionRule& rule, const GrainRange& range,
                   int n) {
  std::vector<int> a, b, order(pairs.size());
  for (const BodyPair& pair : pairs) a.push_back(pair.a - range.begin), b.push_back(pair.b - range.begin);
  const std::vector<int> color = color_contacts(a, b, range.end - range.begin);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int c, int d) { return color[c] < color[d]; });
  std::vector<BodyPair> smooth, rough;
  for (const int c : order) (rule(pairs[c].a, pairs[c].b) > 0 ? rough : smooth).push_back(pairs[c]);
  return {in_fours(smooth, n), in_fours(rough, n)};
}

template <int Dim>
void append(const Sequence& sequence, const RigidParticles<Dim>& particles, const FrictionRule& rule,
            RigidContacts<Dim>& contacts, ContactBatch& batch) {
  batch.begin = contacts.size();
  batch.fours_end = batch.begin + sequence.in_fours;
  for (const BodyPair& pair : sequence.pairs) {
    const double inverse_a = particles.inverse_mass[pair.a], inverse_b = particles.inverse_mass[pair.b];
    contacts.body_a.push_back(pair.a);
    contacts.body_b.push_back(pair.b);
    contacts.inverse_mass_a.push_back(inverse_a);
    contacts.inverse_mass_b.push_back(inverse_b);
    contacts.inverse_delassus.push_back(1 / (inverse_a + inverse_b));
    contacts.friction.push_back(rule(pair.a, pair.b));
  }
  batch.end = contacts.size();
}

/// The contacts of a list that was not made again, with their impulses.
template <int Dim>
ContactBlock take_over(const RigidContacts<Dim>& old, ContactBlock block, RigidContacts<Dim>& contacts) {
  const int shift = contacts.size() - block.begin();
  const auto append_rows = [&](auto array) {
    const auto& from = old.*array;
    (contacts.*array)
        .insert((contacts.*array).end(), from.begin() + block.begin(), from.begin() + block.end());
  };
  using Contacts = RigidContacts<Dim>;
  append_rows(&Contacts::body_a), append_rows(&Contacts::body_b);
  append_rows(&Contacts::inverse_mass_a), append_rows(&Contacts::inverse_mass_b);
  append_rows(&Contacts::inverse_delassus), append_rows(&Contacts::friction);
  append_rows(&Contacts::impulse);
  for (ContactBatch* batch : {&block.frictionless, &block.frictional})
    batch->begin += shift, batch->fours_end += shift, batch->end += shift;
  return block;
}

/// Old contacts that carry an impulse, by their body a.
template <int Dim>
class CarriedImpulses {
 public:
  CarriedImpulses(const RigidContacts<Dim>& old, int bodies) : old_(old), begin_(bodies + 1, 0) {
    for (int c = 0; c < old.size(); ++c)
      if (old.impulse[c][0] > 0) ++begin_[old.body_a[c] + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    contact_.resize(begin_.back());
    std::vector<int> next = begin_;
    for (int c = 0; c < old.size(); ++c)
      if (old.impulse[c][0] > 0) contact_[next[old.body_a[c]]++] = c;
  }

  /// Of the old contact of the same bodies, or 0.
  Vec<Dim> between(int a, int b) const {
    for (int k = begin_[a]; k < begin_[a + 1]; ++k)
      if (old_.body_b[contact_[k]] == b) return old_.impulse[contact_[k]];
    return {};
  }

 private:
  const RigidContacts<Dim>& old_;
  std::vector<int> begin_, contact_;
};

}  // namespace

template <int Dim>
RigidContacts<Dim> candidate_contacts(const RigidParticles<Dim>& particles,
                                      const NeighbourReference<Dim>& reference, const FrictionRule& friction,
                                      const RigidContacts<Dim>& old) {
  const int n = particles.size(), grains = reference.between_list();
  std::vector<const ContactBlock*> kept(grains + 1, nullptr);
  for (const ContactBlock& block : old.blocks)
    if (block.made == reference.made[block.list]) kept[block.list] = &block;
  std::vector<ListedBlock> made(grains + 1);
  parallel_for(grains + 1, [&](int k) {
    const int list = k == 0 ? grains : k - 1;  // the longest first
    if (kept[list] != nullptr) return;
    if (list == grains) {
      made[list] = listed(pairs_between(particles, reference), friction, {0, n}, n);
      return;
    }
    const GrainRange& grain = reference.grains[list];
    const auto inside =
        close_pairs(particles, reference.position, reference.skin, grain, [](int, int) { return false; });
    made[list] = listed(inside, friction, grain, n);
  });

  RigidContacts<Dim> contacts;
  const CarriedImpulses<Dim> carried(old, n);
  for (int list = 0; list <= grains; ++list) {
    ContactBlock block;
    block.list = list;
    block.made = reference.made[list];
    if (kept[list] != nullptr) {
      block = take_over(old, *kept[list], contacts);
    } else {
      append(made[list].frictionless, particles, friction, contacts, block.frictionless);
      append(made[list].frictional, particles, friction, contacts, block.frictional);
      for (int c = block.begin(); c < block.end(); ++c)
        contacts.impulse.push_back(carried.between(contacts.body_a[c], contacts.body_b[c]));
    }
    if (block.end() > block.begin() || list == grains) contacts.blocks.push_back(block);
  }
  contacts.normal.resize(contacts.size());
  contacts.gap.resize(contacts.size());
  return contacts;
}

template RigidContacts<2> candidate_contacts<2>(const RigidParticles<2>&, const NeighbourReference<2>&,
                                                const FrictionRule&, const RigidContacts<2>&);
template RigidContacts<3> candidate_contacts<3>(const RigidParticles<3>&, const NeighbourReference<3>&,
                                                const FrictionRule&, const RigidContacts<3>&);

}  // namespace softgrain
