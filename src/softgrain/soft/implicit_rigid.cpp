#include "softgrain/soft/implicit_step.hpp"

// Rigid grains in the implicit step (theory (71)): their equations, and A, on three motions.

namespace softgrain {

/// A on the three motions of a batch's grains, the compliance of their outlines, and what A answers to
///   f = m g - m (x_c - x_c,n - dt v_n)/dt^2,  couple = -I (angle - dt w_n)/dt^2.
/// Forces have the arms that they have where contacts take place and normal, OutlineState::normals_at of the
/// step, so that contact without friction gives no energy.
void ImplicitDynamics::solve_rigid(int b, double dt) {
  const GrainBatch& batch = grains.batches[b];
  RigidStep& rigid = rigid_[b];
  const WideVectors &x = batch.position, &x_n = start_[b];
  const double t = step_of_matrix(dt);
  WideVectors weight(x.size());  // of A: m/t^2 + c p/l
  grains.scatter_outline(proximal_, batch, weight);
  Wide W = 0.0, s = 0.0;
  Vec<2, Wide> mean{};
  rigid.arm.resize(x.size());
  force_[b].resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec<2, Wide> r_n = x_n[i] - x_n[0], r = r_n + Wide(outline_.normals_at) * (x[i] - x[0] - r_n);
    rigid.arm[i] = {-r[1], r[0]};
    weight[i][0] += grains.node_mass(batch, static_cast<int>(i)) * Wide(1 / (t * t));
    W += weight[i][0];
    mean += weight[i][0] * rigid.arm[i];
  }
  mean = (1.0 / W) * mean;
  for (std::size_t i = 0; i < x.size(); ++i) {
    rigid.arm[i] -= mean;
    s += weight[i][0] * dot(rigid.arm[i], rigid.arm[i]);
  }
  rigid.compliance = 1.0 / W;
  rigid.turn_compliance = 1.0 / s;

  WideVectors flight(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) flight[i] = flight_velocity(b, i);
  const RigidTwist free = rigid_twist(grains, batch, x_n, flight);
  const RigidMass all = rigid_mass(grains, batch);
  const Wide angle = angle_between(rigid_pose(batch, x_n), rigid_pose(batch, x)), rate = 1 / (dt * dt);
  const Vec<2, Wide> f = all.mass * (Vec<2, Wide>{options.gravity[0], options.gravity[1]} -
                                     rate * (x[0] - x_n[0] - Wide(dt) * free.velocity));
  const Wide couple = -rate * all.inertia * (angle - Wide(dt) * free.spin);
  rigid.way = rigid.compliance * f;
  rigid.turn = rigid.turn_compliance * (couple - dot(mean, f));

  const std::size_t begin = batch.topology->grid.outline_begin, nodes = kept_[b].size(), width = 2 * nodes;
  for (std::size_t v = 0; v < nodes; ++v) kept_[b][v] = rigid.way + rigid.turn * rigid.arm[begin + v];
  for (int lane = 0; lane < Wide::size; ++lane) {
    double* entry = compliance_[b].data() + lane * width * width;
    const double along = rigid.compliance[lane], turning = rigid.turn_compliance[lane];
    for (std::size_t i = 0; i < width; ++i) {
      const double a = turning * rigid.arm[begin + i / 2][static_cast<int>(i % 2)][lane];
      for (std::size_t j = 0; j < width; ++j)
        *entry++ = a * rigid.arm[begin + j / 2][static_cast<int>(j % 2)][lane] + (i % 2 == j % 2 ? along : 0);
    }
  }
}

/// From forces on the nodes to what A answers to them, on top of solve_rigid.
void ImplicitDynamics::correct_rigid(int b) {
  const RigidStep& rigid = rigid_[b];
  WideVectors& f = force_[b];
  Vec<2, Wide> sum{};
  Wide couple = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    sum += f[i];
    couple += dot(rigid.arm[i], f[i]);
  }
  const Vec<2, Wide> way = rigid.way + rigid.compliance * sum;
  const Wide turn = rigid.turn + rigid.turn_compliance * couple;
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = way + turn * rigid.arm[i];
}

/// After the nodes were moved, by whatever is linear in the three motions.
void ImplicitDynamics::keep_rigid(int b) {
  GrainBatch& batch = grains.batches[b];
  if (batch.topology->rigid()) place_rigid(batch, rigid_pose(batch, batch.position), batch.position);
}

/// v = (x - x_n)/dt and w = angle/dt.
void ImplicitDynamics::end_rigid(int b, double dt) {
  GrainBatch& batch = grains.batches[b];
  const RigidPose before = rigid_pose(batch, start_[b]), now = rigid_pose(batch, batch.position);
  const Wide rate = 1 / dt;
  set_rigid_twist({rate * (now.centre - before.centre), rate * angle_between(before, now)}, batch.position,
                  batch.velocity);
}

/// What backward Euler takes of a grain on which these forces act: (m (dv)^2 + I (dw)^2)/2, and where its
/// arms are not those of the middle of the turn, the work of the forces along the chords of their places less
/// that of their sum and couple, sum f_i . (r_i - r_i,n) - couple angle.
Wide ImplicitDynamics::inertia_work_of_rigid(int b, std::span<const Vec<2>> force) const {
  const GrainBatch& batch = grains.batches[b];
  const WideVectors &x = batch.position, &x_n = start_[b];
  const RigidPose before = rigid_pose(batch, x_n), now = rigid_pose(batch, x);
  const RigidTwist start = rigid_twist(grains, batch, x_n, velocity_start_[b]);
  const Wide rate = 1 / outline_.dt, angle = angle_between(before, now);
  WideVectors outer(x.size());
  grains.scatter_outline(force, batch, outer);
  Wide chords = 0.0, couple = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec<2, Wide> r_n = x_n[i] - x_n[0], chord = x[i] - x[0] - r_n;
    const Vec<2, Wide> arm = r_n + Wide(outline_.normals_at) * chord;
    chords += dot(outer[i], chord);
    couple += arm[0] * outer[i][1] - arm[1] * outer[i][0];
  }
  return rigid_mass(grains, batch)
             .energy({rate * (now.centre - before.centre) - start.velocity, rate * angle - start.spin}) +
         (chords - couple * angle);
}

}  // namespace softgrain
