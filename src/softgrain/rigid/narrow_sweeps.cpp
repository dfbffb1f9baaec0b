#include <algorithm>
#include <cmath>
#include <numeric>

#include "softgrain/rigid/narrow_impulses.hpp"

namespace softgrain {
namespace {

/// p <- p + b (p - p'), and p' becomes the p of now. Returns the change.
[[gnu::always_inline]] inline Narrow::Floats go_ahead(Narrow::Floats& p, Narrow::Floats& before, float b) {
  const Narrow::Floats last = p;
  p += b * (p - before);
  before = last;
  return p - last;
}

template <int N>
float distance(const NarrowRow<N>& a, const NarrowRow<N>& b) {
  if constexpr (N == 1) return std::abs(a.c[0] - b.c[0]);
  float square = 0;
  for (int k = 0; k < N; ++k) square += (a.c[k] - b.c[k]) * (a.c[k] - b.c[k]);
  return std::sqrt(square);
}

}  // namespace

/// Starts from y = p + b (p - p'), p' the impulse before. Per contact in the plane: reads 40 B of contact and
/// 16 B of velocities, writes 8 B and 16 B; in space 44, 32, 8 and 32.
template <int Dim>
template <bool Ahead, bool Measured>
void NarrowSweepsOf<Dim>::relax(Eight& c, float b, LaneViolation<Floats>& violation) {
  if constexpr (Ahead) go_ahead(c.p_n, c.p_n_before, b);
  Bodies bodies(velocity_.data(), c);
  // u_n = n . (v_b - v_a) + q_n
  Floats u_n = c.n[0] * (bodies.b[0] - bodies.a[0]);
  for (int k = 1; k < Dim; ++k) u_n += c.n[k] * (bodies.b[k] - bodies.a[k]);
  u_n += c.offset;
  const Floats p_n = normal_impulse(c.p_n, u_n, c.gain);
  const Floats dp = p_n - c.p_n;
  c.p_n = p_n;
  bodies.apply(impulse_of(c, dp));
  if constexpr (Measured) violation.add(Vec<1, Floats>{dp * (c.inverse_a + c.inverse_b)}, p_n);
}

template <int Dim>
template <bool Ahead, bool Measured>
void NarrowSweepsOf<Dim>::relax(FrictionalEight& c, float b, LaneViolation<Floats>& violation) {
  if constexpr (Ahead) {
    go_ahead(c.p_n, c.p_n_before, b);
    for (int k = 0; k < Dim - 1; ++k) go_ahead(c.p_t[k], c.p_t_before[k], b);
  }
  Bodies bodies(velocity_.data(), c);
  const float kappa = inertia_ratio_;
  const Turning s_a = gather_columns(spin_.data(), c.a), s_b = gather_columns(spin_.data(), c.b);
  const Vector du = bodies.b - bodies.a;
  // u_n = n . (v_b - v_a) + q_n;  u_t = t . (v_b - v_a - (s_a + s_b) x n)
  Floats u_n = c.n[0] * du[0];
  for (int k = 1; k < Dim; ++k) u_n += c.n[k] * du[k];
  u_n += c.offset;
  const Tangential u_t = slip_of(c, du, s_a + s_b);
  Vector p{c.p_n}, u{u_n};
  for (int k = 1; k < Dim; ++k) p[k] = c.p_t[k - 1], u[k] = u_t[k - 1];
  const Vector solved = solve_uncoupled(p, u, c.gain, c.gain / (1 + kappa), c.friction);
  const Vector dp = solved - p;
  Tangential dp_t;
  c.p_n = solved[0];
  for (int k = 1; k < Dim; ++k) c.p_t[k - 1] = solved[k], dp_t[k - 1] = dp[k];
  bodies.apply(impulse_of(c, dp[0], dp_t));
  turn(c, s_a, s_b, dp_t);
  if constexpr (Measured) {
    const Floats W_nn = c.inverse_a + c.inverse_b;
    Vector jump{W_nn * dp[0]};
    for (int k = 1; k < Dim; ++k) jump[k] = (1 + kappa) * W_nn * dp[k];
    violation.add(jump, solved[0]);
  }
}

template <int Dim>
template <bool Ahead, bool Measured>
Violation NarrowSweepsOf<Dim>::sweep_contacts(Block& block, float b) {
  LaneViolation<Floats> violation;
  for (Eight& contact : block.frictionless.eights) relax<Ahead, Measured>(contact, b, violation);
  for (FrictionalEight& contact : block.frictional.eights) relax<Ahead, Measured>(contact, b, violation);
  return Measured ? violation.total(relaxation_) : Violation{};
}

/// v <- v + b (v'' - v'), where the block's own contacts made v'' of v' in its last turn. Spins follow where
/// they matter to them.
template <int Dim>
Violation NarrowSweepsOf<Dim>::sweep_block(int k, double ahead, bool measured) {
  Block& block = blocks_[listed_[k]];
  const auto b = static_cast<float>(ahead);
  const int begin = block.bodies.begin, end = block.bodies.end;
  const bool spins = block.spins;
  const auto go_ahead = [&]<int N>(NarrowRow<N>* now, NarrowRow<N>* start, const NarrowRow<N>* last) {
    for (int i = begin; i < end; ++i) {
      const auto at = now[i];
      if (b > 0)
        for (int m = 0; m < N; ++m) now[i].c[m] += b * (last[i].c[m] - start[i].c[m]);
      start[i] = at;
    }
  };
  go_ahead(velocity_.data(), start_.data(), end_.data());
  if (spins) go_ahead(spin_.data(), spin_start_.data(), spin_end_.data());
  const Violation violation =
      measured ? sweep_contacts<true, true>(block, b) : sweep_contacts<true, false>(block, b);
  std::copy(velocity_.begin() + begin, velocity_.begin() + end, end_.begin() + begin);
  if (spins) std::copy(spin_.begin() + begin, spin_.begin() + end, spin_end_.begin() + begin);
  block.turn = sweeps_;
  return violation;
}

/// What contacts between grains see of a grain.
template <int Dim>
void NarrowSweepsOf<Dim>::pass_touched(const Block& block, Message& message) {
  message.at(touched(block), std::span(velocity_));
  if (block.spins) message.at(touched(block), std::span(spin_));
}

template <int Dim>
void NarrowSweepsOf<Dim>::sweep_blocks(std::span<const int> open, std::span<Violation> found, double ahead,
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

template <int Dim>
void NarrowSweepsOf<Dim>::go_ahead_between(double ahead) {
  if (listed_.empty()) return;
  const auto b = static_cast<float>(ahead);
  Block& between = blocks_[listed_.back()];
  for (Eight& c : between.frictionless.eights) {
    const Floats dp = go_ahead(c.p_n, c.p_n_before, b);
    if (b > 0) Bodies(velocity_.data(), c).apply(impulse_of(c, dp));
  }
  for (FrictionalEight& c : between.frictional.eights) {
    const Floats dp_n = go_ahead(c.p_n, c.p_n_before, b);
    Tangential dp_t;
    for (int k = 0; k < Dim - 1; ++k) dp_t[k] = go_ahead(c.p_t[k], c.p_t_before[k], b);
    if (b <= 0) continue;
    Bodies(velocity_.data(), c).apply(impulse_of(c, dp_n, dp_t));
    turn(c, gather_columns(spin_.data(), c.a), gather_columns(spin_.data(), c.b), dp_t);
  }
}

template <int Dim>
Violation NarrowSweepsOf<Dim>::sweep_between(bool measured) {
  if (listed_.empty()) return {};
  Block& between = blocks_[listed_.back()];
  return measured ? sweep_contacts<false, true>(between, 0) : sweep_contacts<false, false>(between, 0);
}

template <int Dim>
void NarrowSweepsOf<Dim>::end_sweep() {
  for (const int list : listed_) blocks_[list].moved = 0;
  for (Touched& touched : touched_) {
    Block& block = blocks_[touched.list];
    if (!block.any) continue;
    const Velocity& v = velocity_[touched.body];
    if (block.turn == sweeps_) {
      touched.velocity = v;
      touched.spin = spin_[touched.body];
      continue;
    }
    const float turned = block.spins ? distance(spin_[touched.body], touched.spin) : 0;
    block.moved = std::max(block.moved, 2 * (distance(v, touched.velocity) + turned));
  }
  ++sweeps_;
}

template <int Dim>
Violation NarrowSweepsOf<Dim>::sweep(bool measured) {
  std::vector<Violation> found(listed_.size());
  std::vector<int> all(blocks());
  std::iota(all.begin(), all.end(), 0);
  sweep_blocks(all, found, 0, measured);
  Violation violation;
  for (const Violation& of_block : found) violation += of_block;
  return violation += sweep_between(measured);
}

template class NarrowSweepsOf<2>;
template class NarrowSweepsOf<3>;

}  // namespace softgrain
