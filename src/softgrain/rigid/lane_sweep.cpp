#include "softgrain/rigid/lane_sweep.hpp"

#include "softgrain/math/lanes.hpp"

namespace softgrain {
namespace {

/// Velocities of the bodies a and b of four contacts, and the impulses that change them.
struct BodyLanes {
  BodyLanes(Vec<2>* velocity, const RigidContacts<2>& contacts, int c)
      : velocity_(velocity), a_(&contacts.body_a[c]), b_(&contacts.body_b[c]) {
    v_a = gather_columns(velocity, a_);
    v_b = gather_columns(velocity, b_);
  }
  /// v_a -= P/m_a, v_b += P/m_b.
  void apply(const LaneColumns& impulse, Lanes inverse_a, Lanes inverse_b) {
    v_a.x -= inverse_a * impulse.x, v_a.y -= inverse_a * impulse.y;
    v_b.x += inverse_b * impulse.x, v_b.y += inverse_b * impulse.y;
    scatter_columns(v_a, velocity_, a_);
    scatter_columns(v_b, velocity_, b_);
  }

  LaneColumns v_a, v_b;

 private:
  Vec<2>* velocity_;
  const int *a_, *b_;
};

/// Per contact: reads 72 B of contact and 32 B of velocities, writes 16 B and 32 B.
LaneViolation<Lanes> sweep_frictionless(const SweepData& data, const ContactBatch& batch) {
  const auto& [particles, contacts, offset, impulse, friction, relaxation] = data;
  LaneViolation<Lanes> violation;
  for (int c = batch.begin; c < batch.fours_end; c += lane_count) {
    BodyLanes bodies(particles.velocity.data(), contacts, c);
    const LaneColumns n = load_columns(&contacts.normal[c]);
    const Lanes inverse_a = load_lanes(&contacts.inverse_mass_a[c]),
                inverse_b = load_lanes(&contacts.inverse_mass_b[c]);
    const Lanes gain = relaxation * load_lanes(&contacts.inverse_delassus[c]);
    LaneColumns p = load_columns(&impulse[c]);
    // u_n = n . (v_b - v_a) + q_n
    const Lanes u_n =
        n.x * (bodies.v_b.x - bodies.v_a.x) + n.y * (bodies.v_b.y - bodies.v_a.y) + load_lanes(&offset[c]);
    const Lanes p_n = normal_impulse(p.x, u_n, gain);
    const Lanes dp = p_n - p.x;
    p.x = p_n;
    store_columns(p, &impulse[c]);
    bodies.apply({dp * n.x, dp * n.y}, inverse_a, inverse_b);
    violation.add(Vec<1, Lanes>{dp * (inverse_a + inverse_b)}, p_n);
  }
  return violation;
}

Lanes gather_spin(const Spin<2>* spin, const int* index) {
  return Lanes{spin[index[0]][0], spin[index[1]][0], spin[index[2]][0], spin[index[3]][0]};
}
void scatter_spin(Lanes lanes, Spin<2>* spin, const int* index) {
  for (int lane = 0; lane < lane_count; ++lane) spin[index[lane]][0] = lanes[lane];
}

/// Per contact: reads 80 B of contact and 48 B of velocities and spins, writes 16 B and 48 B.
LaneViolation<Lanes> sweep_frictional(const SweepData& data, const ContactBatch& batch) {
  const auto& [particles, contacts, offset, impulse, friction, relaxation] = data;
  LaneViolation<Lanes> violation;
  const double kappa = particles.inertia_ratio;
  Spin<2>* spin = particles.spin.data();
  for (int c = batch.begin; c < batch.fours_end; c += lane_count) {
    const int *a = &contacts.body_a[c], *b = &contacts.body_b[c];
    BodyLanes bodies(particles.velocity.data(), contacts, c);
    const Lanes s_a = gather_spin(spin, a), s_b = gather_spin(spin, b);
    const LaneColumns n = load_columns(&contacts.normal[c]);
    const Lanes inverse_a = load_lanes(&contacts.inverse_mass_a[c]),
                inverse_b = load_lanes(&contacts.inverse_mass_b[c]);
    const Lanes gain = relaxation * load_lanes(&contacts.inverse_delassus[c]);
    const LaneColumns loaded = load_columns(&impulse[c]);
    const Vec<2, Lanes> p{loaded.x, loaded.y};
    const Lanes du_x = bodies.v_b.x - bodies.v_a.x, du_y = bodies.v_b.y - bodies.v_a.y;
    // u_n = n . (v_b - v_a) + q_n;  u_t = t . (v_b - v_a) - (s_a + s_b),  t = (-n_y, n_x)
    const Lanes u_n = n.x * du_x + n.y * du_y + load_lanes(&offset[c]);
    const Lanes u_t = n.x * du_y - n.y * du_x - (s_a + s_b);
    const Vec<2, Lanes> solved =
        solve_uncoupled(p, {u_n, u_t}, gain, gain / (1 + kappa), load_lanes(&friction[c]));
    const Lanes dp_n = solved[0] - p[0], dp_t = solved[1] - p[1];
    store_columns({solved[0], solved[1]}, &impulse[c]);
    bodies.apply({dp_n * n.x - dp_t * n.y, dp_n * n.y + dp_t * n.x}, inverse_a, inverse_b);
    // ds = -kappa p_t / m on both
    scatter_spin(s_a - kappa * inverse_a * dp_t, spin, a);
    scatter_spin(s_b - kappa * inverse_b * dp_t, spin, b);
    const Lanes W_nn = inverse_a + inverse_b;
    violation.add(Vec<2, Lanes>{W_nn * dp_n, (1 + kappa) * W_nn * dp_t}, solved[0]);
  }
  return violation;
}

}  // namespace

Violation sweep_fours(const SweepData& data, const ContactBatch& batch, bool frictional) {
  return (frictional ? sweep_frictional : sweep_frictionless)(data, batch).total(data.relaxation);
}

void push_fours(RigidParticles<2>& particles, const RigidContacts<2>& contacts,
                std::span<const Vec<2>> impulse, const ContactBatch& batch) {
  for (int c = batch.begin; c < batch.fours_end; c += lane_count) {
    const Lanes p_n = load_columns(&impulse[c]).x;
    BodyLanes bodies(particles.velocity.data(), contacts, c);
    const LaneColumns n = load_columns(&contacts.normal[c]);
    bodies.apply({p_n * n.x, p_n * n.y}, load_lanes(&contacts.inverse_mass_a[c]),
                 load_lanes(&contacts.inverse_mass_b[c]));
  }
}

}  // namespace softgrain
