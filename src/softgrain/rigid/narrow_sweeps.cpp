#include "softgrain/rigid/narrow_sweeps.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/rigid/narrow_rows.hpp"

namespace softgrain {
namespace {

using Integers = int __attribute__((vector_size(32)));

/// p <- p + b (p - p'), and p' becomes the p of now. Returns the change.
[[gnu::always_inline]] inline Narrow::Floats go_ahead(Narrow::Floats& p, Narrow::Floats& before, float b) {
  const Narrow::Floats last = p;
  p += b * (p - before);
  before = last;
  return p - last;
}

}  // namespace

/// Velocities of the bodies a and b of eight contacts, and the impulses that change them.
struct NarrowSweeps::Bodies {
  Bodies(Velocity* velocity, const Eight& contact)
      : rows(velocity), of(contact), a(gather_columns(rows, of.a)), b(gather_columns(rows, of.b)) {}

  /// v_a -= P/m_a, v_b += P/m_b.
  void apply(Floats P_x, Floats P_y) {
    a.x -= of.inverse_a * P_x, a.y -= of.inverse_a * P_y;
    b.x += of.inverse_b * P_x, b.y += of.inverse_b * P_y;
    scatter_columns(a, rows, of.a);
    scatter_columns(b, rows, of.b);
  }

  Velocity* rows;
  const Eight& of;
  FloatColumns a, b;
};

void NarrowSweeps::turn(const Eight& c, Floats s_a, Floats s_b, Floats p_t) {
  scatter(s_a - inertia_ratio_ * c.inverse_a * p_t, spin_.data(), c.a);
  scatter(s_b - inertia_ratio_ * c.inverse_b * p_t, spin_.data(), c.b);
}

/// Starts from y = p + b (p - p'), p' the impulse before. Per contact: reads 40 B of contact and 16 B of
/// velocities, writes 8 B and 16 B.
template <bool Ahead, bool Measured>
void NarrowSweeps::relax(Eight& c, float b, LaneViolation<Floats>& violation) {
  if constexpr (Ahead) go_ahead(c.p_n, c.p_n_before, b);
  Bodies bodies(velocity_.data(), c);
  // u_n = n . (v_b - v_a) + q_n
  const Floats u_n = c.n_x * (bodies.b.x - bodies.a.x) + c.n_y * (bodies.b.y - bodies.a.y) + c.offset;
  const Floats p_n = normal_impulse(c.p_n, u_n, c.gain);
  const Floats dp = p_n - c.p_n;
  c.p_n = p_n;
  bodies.apply(dp * c.n_x, dp * c.n_y);
  if constexpr (Measured) violation.add(Vec<1, Floats>{dp * (c.inverse_a + c.inverse_b)}, p_n);
}

template <bool Ahead, bool Measured>
void NarrowSweeps::relax(FrictionalEight& c, float b, LaneViolation<Floats>& violation) {
  if constexpr (Ahead) go_ahead(c.p_n, c.p_n_before, b), go_ahead(c.p_t, c.p_t_before, b);
  Bodies bodies(velocity_.data(), c);
  const float kappa = inertia_ratio_;
  const Floats s_a = gather(spin_.data(), c.a), s_b = gather(spin_.data(), c.b);
  const Floats du_x = bodies.b.x - bodies.a.x, du_y = bodies.b.y - bodies.a.y;
  // u_n = n . (v_b - v_a) + q_n;  u_t = t . (v_b - v_a) - (s_a + s_b),  t = (-n_y, n_x)
  const Floats u_n = c.n_x * du_x + c.n_y * du_y + c.offset;
  const Floats u_t = c.n_x * du_y - c.n_y * du_x - (s_a + s_b);
  const Vec<2, Floats> p{c.p_n, c.p_t};
  const Vec<2, Floats> solved = solve_uncoupled(p, {u_n, u_t}, c.gain, c.gain / (1 + kappa), c.friction);
  const Floats dp_n = solved[0] - p[0], dp_t = solved[1] - p[1];
  c.p_n = solved[0];
  c.p_t = solved[1];
  bodies.apply(dp_n * c.n_x - dp_t * c.n_y, dp_n * c.n_y + dp_t * c.n_x);
  turn(c, s_a, s_b, dp_t);
  if constexpr (Measured) {
    const Floats W_nn = c.inverse_a + c.inverse_b;
    violation.add(Vec<2, Floats>{W_nn * dp_n, (1 + kappa) * W_nn * dp_t}, solved[0]);
  }
}

template <bool Ahead, bool Measured>
Violation NarrowSweeps::sweep_contacts(Block& block, float b) {
  LaneViolation<Floats> violation;
  for (Eight& contact : block.frictionless.eights) relax<Ahead, Measured>(contact, b, violation);
  for (FrictionalEight& contact : block.frictional.eights) relax<Ahead, Measured>(contact, b, violation);
  return Measured ? violation.total(relaxation_) : Violation{};
}

/// The velocities that the block's own contacts have changed in its last turn, by gain_ = H (p_k - p_k-1) in
/// units of M, go ahead with its impulses.
Violation NarrowSweeps::sweep_block(int k, double ahead, bool measured) {
  Block& block = blocks_[listed_[k]];
  const auto b = static_cast<float>(ahead);
  const auto begin = [b](auto& now, auto& start, const auto& end) {
    const auto last = now;
    if (b > 0) now += b * (end - start);
    start = last;
  };
  const bool turns = !block.frictional.eights.empty();
  block.turn = sweeps_;
  for (int i = block.bodies.begin; i < block.bodies.end; ++i) {
    begin(velocity_[i].x, start_[i].x, end_[i].x), begin(velocity_[i].y, start_[i].y, end_[i].y);
    if (turns) begin(spin_[i], spin_start_[i], spin_end_[i]);
  }
  const Violation violation =
      measured ? sweep_contacts<true, true>(block, b) : sweep_contacts<true, false>(block, b);
  std::copy_n(&velocity_[block.bodies.begin], block.bodies.end - block.bodies.begin,
              &end_[block.bodies.begin]);
  if (turns)
    std::copy_n(&spin_[block.bodies.begin], block.bodies.end - block.bodies.begin,
                &spin_end_[block.bodies.begin]);
  return violation;
}

void NarrowSweeps::go_ahead_between(double ahead) {
  if (listed_.empty()) return;
  const auto b = static_cast<float>(ahead);
  Block& between = blocks_[listed_.back()];
  for (Eight& c : between.frictionless.eights) {
    const Floats dp = go_ahead(c.p_n, c.p_n_before, b);
    if (b > 0) Bodies(velocity_.data(), c).apply(dp * c.n_x, dp * c.n_y);
  }
  for (FrictionalEight& c : between.frictional.eights) {
    const Floats dp_n = go_ahead(c.p_n, c.p_n_before, b), dp_t = go_ahead(c.p_t, c.p_t_before, b);
    if (b <= 0) continue;
    Bodies(velocity_.data(), c).apply(dp_n * c.n_x - dp_t * c.n_y, dp_n * c.n_y + dp_t * c.n_x);
    turn(c, gather(spin_.data(), c.a), gather(spin_.data(), c.b), dp_t);
  }
}

Violation NarrowSweeps::sweep_between(bool measured) {
  if (listed_.empty()) return {};
  Block& between = blocks_[listed_.back()];
  return measured ? sweep_contacts<false, true>(between, 0) : sweep_contacts<false, false>(between, 0);
}

void NarrowSweeps::end_sweep() {
  for (const int list : listed_) blocks_[list].moved = 0;
  for (Touched& touched : touched_) {
    Block& block = blocks_[touched.list];
    const Velocity& v = velocity_[touched.body];
    if (block.turn == sweeps_) touched.velocity = v, touched.spin = spin_[touched.body];
    const float turned = block.frictional.eights.empty() ? 0 : std::abs(spin_[touched.body] - touched.spin);
    const float gone = std::hypot(v.x - touched.velocity.x, v.y - touched.velocity.y);
    block.moved = std::max(block.moved, 2 * (gone + turned));
  }
  ++sweeps_;
}

Violation NarrowSweeps::sweep(bool measured) {
  std::vector<Violation> found(listed_.size());
  parallel_for(blocks(), [&](int k) { found[k] = sweep_block(k, 0, measured); });
  Violation violation;
  for (const Violation& of_block : found) violation += of_block;
  return violation += sweep_between(measured);
}

/// Each Eight takes the contacts that follow until one shares a particle with those before.
template <class AnyEight>
void NarrowSweeps::fill(const RigidContacts<2>& contacts, const ContactBatch& listed, int begin, int idle,
                        Batch<AnyEight>& batch) const {
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
template <class AnyEight>
void NarrowSweeps::load(const RigidContacts<2>& contacts, std::span<const double> offset,
                        const ContactBlock& listed, Batch<AnyEight>& batch) {
  for (std::size_t k = 0; k < batch.eights.size(); ++k) {
    AnyEight& next = batch.eights[k];
    const int c = listed.begin() + batch.places[k].begin, count = batch.places[k].count;
    if (c + eight <= listed.end()) {  // beyond it another thread may be at work
      const WideColumns n = load_wide_columns(&contacts.normal[c]),
                        p = load_wide_columns(&contacts.impulse[c]);
      const auto mine = Integers{0, 1, 2, 3, 4, 5, 6, 7} < count;
      next.n_x = Narrow(n.x).lanes, next.n_y = Narrow(n.y).lanes;
      next.offset = Narrow(load_wide(&offset[c])).lanes;
      next.p_n = next.p_n_before = mine ? Narrow(p.x).lanes : Floats{};
      if constexpr (std::is_same_v<AnyEight, FrictionalEight>)
        next.p_t = next.p_t_before = mine ? Narrow(p.y).lanes : Floats{};
    } else {
      for (int lane = 0; lane < count; ++lane) {
        next.n_x[lane] = static_cast<float>(contacts.normal[c + lane][0]);
        next.n_y[lane] = static_cast<float>(contacts.normal[c + lane][1]);
        next.offset[lane] = static_cast<float>(offset[c + lane]);
        next.p_n[lane] = static_cast<float>(contacts.impulse[c + lane][0]);
        if constexpr (std::is_same_v<AnyEight, FrictionalEight>)
          next.p_t[lane] = static_cast<float>(contacts.impulse[c + lane][1]);
      }
      next.p_n_before = next.p_n;
      if constexpr (std::is_same_v<AnyEight, FrictionalEight>) next.p_t_before = next.p_t;
    }
    Bodies bodies(velocity_.data(), next);
    if constexpr (std::is_same_v<AnyEight, FrictionalEight>) {
      bodies.apply(next.p_n * next.n_x - next.p_t * next.n_y, next.p_n * next.n_y + next.p_t * next.n_x);
      turn(next, gather(spin_.data(), next.a), gather(spin_.data(), next.b), next.p_t);
    } else {
      bodies.apply(next.p_n * next.n_x, next.p_n * next.n_y);
    }
  }
}

void NarrowSweeps::take_bodies(const RigidParticles<2>& particles, const RigidContacts<2>& contacts,
                               double relaxation) {
  bodies_ = static_cast<int>(particles.velocity.size());
  if (relaxation_ != static_cast<float>(relaxation)) blocks_.clear();
  relaxation_ = static_cast<float>(relaxation);
  inertia_ratio_ = static_cast<float>(particles.inertia_ratio);
  blocks_.resize(contacts.blocks.empty() ? 0 : contacts.blocks.back().list + 1);
  listed_.clear();
  for (const ContactBlock& block : contacts.blocks) listed_.push_back(block.list);
  velocity_.resize(bodies_ + blocks_.size());
  spin_.resize(bodies_ + blocks_.size());
  start_.resize(bodies_), end_.resize(bodies_);
  spin_start_.resize(bodies_), spin_end_.resize(bodies_);
  list_of_.resize(bodies_, -1);
  sweeps_ = 0;
  parallel_ranges(bodies_, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Vec<2>& v = particles.velocity[i];
      velocity_[i] = {static_cast<float>(v[0]), static_cast<float>(v[1])};
      spin_[i] = static_cast<float>(particles.spin[i][0]);
    }
  });
}

void NarrowSweeps::take_contacts(const RigidContacts<2>& contacts, const ContactBlock& listed,
                                 std::span<const double> offset) {
  Block& block = blocks_[listed.list];
  const int begin = listed.begin(), idle = bodies_ + listed.list;
  if (block.made != listed.made) {
    fill(contacts, listed.frictionless, begin, idle, block.frictionless);
    fill(contacts, listed.frictional, begin, idle, block.frictional);
    block.made = listed.made;
    const bool inside = listed.list != listed_.back();
    if (inside)
      take_range(contacts, listed, block);
    else
      take_touched(contacts, listed);
  }
  velocity_[idle] = {};
  spin_[idle] = 0;
  load(contacts, offset, listed, block.frictionless);
  load(contacts, offset, listed, block.frictional);
}

/// Of the bodies of a grain.
void NarrowSweeps::take_range(const RigidContacts<2>& contacts, const ContactBlock& listed, Block& block) {
  block.bodies = {bodies_, 0};
  for (int c = listed.begin(); c < listed.end(); ++c) {
    block.bodies.begin = std::min(block.bodies.begin, contacts.body_a[c]);
    block.bodies.end = std::max(block.bodies.end, contacts.body_b[c] + 1);
  }
  for (int i = block.bodies.begin; i < block.bodies.end; ++i) list_of_[i] = listed.list;
}

/// Bodies of grains that have contacts between grains; after all blocks inside them.
void NarrowSweeps::take_touched(const RigidContacts<2>& contacts, const ContactBlock& between) {
  std::vector<int> bodies;
  for (int c = between.begin(); c < between.end(); ++c)
    bodies.push_back(contacts.body_a[c]), bodies.push_back(contacts.body_b[c]);
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  touched_.clear();
  for (const int body : bodies)
    if (list_of_[body] >= 0) touched_.push_back({.body = body, .list = list_of_[body]});
}

void NarrowSweeps::read_impulses(const ContactBlock& listed, std::span<Vec<2>> impulse) const {
  const Block& block = blocks_[listed.list];
  const auto read = [&](const auto& batch, const auto& impulse_of) {
    for (std::size_t e = 0; e < batch.eights.size(); ++e)
      for (int lane = 0, c = listed.begin() + batch.places[e].begin; lane < batch.places[e].count;
           ++lane, ++c)
        impulse[c] = impulse_of(batch.eights[e], lane);
  };
  read(block.frictionless, [](const Eight& e, int lane) { return Vec<2>{e.p_n[lane], 0}; });
  read(block.frictional, [](const FrictionalEight& e, int lane) { return Vec<2>{e.p_n[lane], e.p_t[lane]}; });
}

}  // namespace softgrain
