#include "softgrain/rigid/narrow_sweeps.hpp"

#include <algorithm>
#include <cstring>

namespace softgrain {
namespace {

using Floats = Narrow::Floats;
using Integers = int __attribute__((vector_size(32)));
using Pairs = double __attribute__((vector_size(32)));  // of floats, moved as one

struct FloatColumns {
  Floats x, y;
};

struct WideColumns {
  Wide x, y;
};
WideColumns load_wide_columns(const Vec<2>* rows) {
  const LaneColumns low = load_columns(rows), high = load_columns(rows + lane_count);
  return {{low.x, high.x}, {low.y, high.y}};
}

template <class Row>
double pair_at(const Row& row) {
  double pair;
  static_assert(sizeof row == sizeof pair);
  std::memcpy(&pair, &row, sizeof pair);
  return pair;
}

/// Rows index[0..7], as columns.
template <class Row>
FloatColumns gather_columns(const Row* rows, const int* index) {
  const auto four = [&](int k, int l, int m, int n) {
    return reinterpret_cast<Floats>(Pairs{pair_at(rows[index[k]]), pair_at(rows[index[l]]),
                                          pair_at(rows[index[m]]), pair_at(rows[index[n]])});
  };
  const Floats rows0145 = four(0, 1, 4, 5), rows2367 = four(2, 3, 6, 7);
  return {__builtin_shufflevector(rows0145, rows2367, 0, 2, 8, 10, 4, 6, 12, 14),
          __builtin_shufflevector(rows0145, rows2367, 1, 3, 9, 11, 5, 7, 13, 15)};
}

/// The inverse of gather_columns: all indices must differ, or hold the same row.
template <class Row>
void scatter_columns(const FloatColumns& columns, Row* rows, const int* index) {
  const auto store = [&](int lane, double pair) { std::memcpy(&rows[index[lane]], &pair, sizeof pair); };
  const auto rows0145 =
      reinterpret_cast<Pairs>(__builtin_shufflevector(columns.x, columns.y, 0, 8, 1, 9, 4, 12, 5, 13));
  const auto rows2367 =
      reinterpret_cast<Pairs>(__builtin_shufflevector(columns.x, columns.y, 2, 10, 3, 11, 6, 14, 7, 15));
  store(0, rows0145[0]), store(1, rows0145[1]), store(2, rows2367[0]), store(3, rows2367[1]);
  store(4, rows0145[2]), store(5, rows0145[3]), store(6, rows2367[2]), store(7, rows2367[3]);
}

Floats gather(const float* numbers, const int* index) {
  Floats lanes;
  for (int lane = 0; lane < Wide::size; ++lane) lanes[lane] = numbers[index[lane]];
  return lanes;
}
void scatter(Floats lanes, float* numbers, const int* index) {
  for (int lane = 0; lane < Wide::size; ++lane) numbers[index[lane]] = lanes[lane];
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

NarrowSweeps::System::System(NarrowSweeps& sweeps, const RigidParticles<2>& particles,
                             const RigidContacts<2>& contacts, std::span<const double> offset)
    : sweeps_(sweeps), contacts_(contacts), offset_(offset), inertia_ratio_(particles.inertia_ratio) {}

Mat<2> NarrowSweeps::System::delassus_block(int contact) const {
  const double W_nn = contacts_.inverse_mass_a[contact] + contacts_.inverse_mass_b[contact];
  return Mat<2>::diagonal({W_nn, (1 + inertia_ratio_) * W_nn});
}

Vec<2> NarrowSweeps::System::relative_velocity(int contact) const {
  const int a = contacts_.body_a[contact], b = contacts_.body_b[contact];
  const Velocity &v_a = sweeps_.velocity_[a], &v_b = sweeps_.velocity_[b];
  const Vec<2> along = Vec<2>{static_cast<double>(v_b.x) - v_a.x, static_cast<double>(v_b.y) - v_a.y} +
                       contacts_.image_velocity(contact);
  const Vec<2>& n = contacts_.normal[contact];
  return {dot(n, along) + offset_[contact],
          dot(perpendicular(n), along) - (static_cast<double>(sweeps_.spin_[a]) + sweeps_.spin_[b])};
}

void NarrowSweeps::System::apply_impulse(int contact, const Vec<2>& dp) {
  const Vec<2>& n = contacts_.normal[contact];
  const Vec<2> P = dp[0] * n + dp[1] * perpendicular(n);
  const auto give = [&](int body, double inverse_mass, double sign) {
    Velocity& v = sweeps_.velocity_[body];
    v.x += static_cast<float>(sign * inverse_mass * P[0]);
    v.y += static_cast<float>(sign * inverse_mass * P[1]);
    sweeps_.spin_[body] -= static_cast<float>(inertia_ratio_ * inverse_mass * dp[1]);
  };
  give(contacts_.body_a[contact], contacts_.inverse_mass_a[contact], -1);
  give(contacts_.body_b[contact], contacts_.inverse_mass_b[contact], 1);
}

void NarrowSweeps::turn(const Eight& c, Floats s_a, Floats s_b, Floats p_t) {
  scatter(s_a - inertia_ratio_ * c.inverse_a * p_t, spin_.data(), c.a);
  scatter(s_b - inertia_ratio_ * c.inverse_b * p_t, spin_.data(), c.b);
}

/// Per contact: reads 36 B of contact and 16 B of velocities, writes 4 B and 16 B.
template <bool Measured>
void NarrowSweeps::relax(Eight& c, LaneViolation<Floats>& violation) {
  Bodies bodies(velocity_.data(), c);
  // u_n = n . (v_b - v_a) + q_n
  const Floats u_n = c.n_x * (bodies.b.x - bodies.a.x) + c.n_y * (bodies.b.y - bodies.a.y) + c.offset;
  const Floats p_n = normal_impulse(c.p_n, u_n, c.gain);
  const Floats dp = p_n - c.p_n;
  c.p_n = p_n;
  bodies.apply(dp * c.n_x, dp * c.n_y);
  if constexpr (Measured) violation.add(Vec<1, Floats>{dp * (c.inverse_a + c.inverse_b)}, p_n);
}

template <bool Measured>
void NarrowSweeps::relax(FrictionalEight& c, LaneViolation<Floats>& violation) {
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

template <bool Measured>
Violation NarrowSweeps::sweep_block(Block& block) {
  LaneViolation<Floats> violation;
  for (Eight& contact : block.frictionless.eights) relax<Measured>(contact, violation);
  for (FrictionalEight& contact : block.frictional.eights) relax<Measured>(contact, violation);
  return Measured ? violation.total(relaxation_) : Violation{};
}

Violation NarrowSweeps::sweep(bool measured) {
  std::vector<Violation> found(listed_.size());
  for_each_block(static_cast<int>(listed_.size()), [&](int k) {
    Block& block = blocks_[listed_[k]];
    found[k] = measured ? sweep_block<true>(block) : sweep_block<false>(block);
  });
  Violation violation;
  for (const Violation& of_block : found) violation += of_block;
  return violation;
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
      next.p_n = mine ? Narrow(p.x).lanes : Floats{};
      if constexpr (std::is_same_v<AnyEight, FrictionalEight>) next.p_t = mine ? Narrow(p.y).lanes : Floats{};
    } else {
      for (int lane = 0; lane < count; ++lane) {
        next.n_x[lane] = static_cast<float>(contacts.normal[c + lane][0]);
        next.n_y[lane] = static_cast<float>(contacts.normal[c + lane][1]);
        next.offset[lane] = static_cast<float>(offset[c + lane]);
        next.p_n[lane] = static_cast<float>(contacts.impulse[c + lane][0]);
        if constexpr (std::is_same_v<AnyEight, FrictionalEight>)
          next.p_t[lane] = static_cast<float>(contacts.impulse[c + lane][1]);
      }
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
