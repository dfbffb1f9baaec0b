#include "softgrain/rigid/narrow_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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
  [[gnu::always_inline]] Bodies(Velocity* velocity, const Eight& contact)
      : rows(velocity), of(contact), a(gather_columns(rows, of.a)), b(gather_columns(rows, of.b)) {}

  /// v_a -= P/m_a, v_b += P/m_b.
  [[gnu::always_inline]] void apply(Floats P_x, Floats P_y) {
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

/// v <- v + b (v'' - v'), where the block's own contacts made v'' of v' in its last turn. Spins follow where
/// they matter to them.
Violation NarrowSweeps::sweep_block(int k, double ahead, bool measured) {
  Block& block = blocks_[listed_[k]];
  const auto b = static_cast<float>(ahead);
  const int begin = block.bodies.begin, end = block.bodies.end;
  const bool spins = block.spins;
  const auto go_ahead = [&](auto* now, auto* start, const auto* last, const auto& add) {
    for (int i = begin; i < end; ++i) {
      const auto at = now[i];
      if (b > 0) add(now[i], start[i], last[i]);
      start[i] = at;
    }
  };
  go_ahead(velocity_.data(), start_.data(), end_.data(),
           [b](Velocity& v, const Velocity& start, const Velocity& last) {
             v.x += b * (last.x - start.x), v.y += b * (last.y - start.y);
           });
  if (spins)
    go_ahead(spin_.data(), spin_start_.data(), spin_end_.data(),
             [b](float& s, float start, float last) { s += b * (last - start); });
  const Violation violation =
      measured ? sweep_contacts<true, true>(block, b) : sweep_contacts<true, false>(block, b);
  std::copy(velocity_.begin() + begin, velocity_.begin() + end, end_.begin() + begin);
  if (spins) std::copy(spin_.begin() + begin, spin_.begin() + end, spin_end_.begin() + begin);
  block.turn = sweeps_;
  return violation;
}

/// What contacts between grains see of a grain.
void NarrowSweeps::pass_touched(const Block& block, Message& message) {
  const auto bodies = std::span<const int>(touched_bodies_)
                          .subspan(block.touched.begin, block.touched.end - block.touched.begin);
  message.at(bodies, velocity_);
  if (block.spins) message.at(bodies, spin_);
}

void NarrowSweeps::sweep_blocks(std::span<const int> open, std::span<Violation> found, double ahead,
                                bool measured) {
  shared_for(
      shares_, static_cast<int>(open.size()), [&](int k) { return listed_[open[k]]; },
      [&](int k) { found[open[k]] = sweep_block(open[k], ahead, measured); },
      [&](int k, Message& message) {
        Block& block = blocks_[listed_[open[k]]];
        message(found[open[k]]), message(block.turn);
        pass_touched(block, message);
      });
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
    if (block.turn == sweeps_) {
      touched.velocity = v;
      touched.spin = spin_[touched.body];
      continue;
    }
    const float dx = v.x - touched.velocity.x, dy = v.y - touched.velocity.y;
    const float turned = block.spins ? std::abs(spin_[touched.body] - touched.spin) : 0;
    block.moved = std::max(block.moved, 2 * (std::sqrt(dx * dx + dy * dy) + turned));
  }
  ++sweeps_;
}

Violation NarrowSweeps::sweep(bool measured) {
  std::vector<Violation> found(listed_.size());
  std::vector<int> all(blocks());
  std::iota(all.begin(), all.end(), 0);
  sweep_blocks(all, found, 0, measured);
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

void NarrowSweeps::take_contacts(const RigidContacts<2>& contacts, const ContactBlock& listed,
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
  spin_[idle] = 0;
  load(contacts, offset, listed, block.frictionless);
  load(contacts, offset, listed, block.frictional);
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
