#include "softgrain/soft/rigid_motion.hpp"

#include <cmath>

namespace softgrain {
namespace {

Wide cross_of(const Vec<2, Wide>& a, const Vec<2, Wide>& b) { return a[0] * b[1] - a[1] * b[0]; }

}  // namespace

RigidPose rigid_pose(const GrainBatch& batch, const WideVectors& x) {
  const std::vector<Vec<2>>& X = batch.topology->grid.node;
  // along = sum_i X_i^-1 (x_i - x_c) as complex numbers, brought to length 1
  Vec<2, Wide> sum{};
  for (std::size_t i = 1; i < x.size(); ++i) {
    const Vec<2, Wide> r = x[i] - x[0];
    sum[0] += X[i][0] * r[0] + X[i][1] * r[1];
    sum[1] += X[i][0] * r[1] - X[i][1] * r[0];
  }
  return {x[0], (1.0 / sqrt(dot(sum, sum))) * sum};
}

Wide angle_between(const RigidPose& from, const RigidPose& to) {
  const Wide sine = cross_of(from.along, to.along), cosine = dot(from.along, to.along);
  Wide angle;
  for (int lane = 0; lane < Wide::size; ++lane) angle.set(lane, std::atan2(sine[lane], cosine[lane]));
  return angle;
}

RigidPose moved(const RigidPose& pose, const Vec<2, Wide>& way, const Wide& angle) {
  Wide c, s;
  for (int lane = 0; lane < Wide::size; ++lane) {
    c.set(lane, std::cos(angle[lane]));
    s.set(lane, std::sin(angle[lane]));
  }
  return {pose.centre + way, {c * pose.along[0] - s * pose.along[1], s * pose.along[0] + c * pose.along[1]}};
}

void place_rigid(const GrainBatch& batch, const RigidPose& pose, WideVectors& x) {
  const std::vector<Vec<2>>& X = batch.topology->grid.node;
  const Wide c = batch.radius * pose.along[0], s = batch.radius * pose.along[1];
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = pose.centre +
           Vec<2, Wide>{c * Wide(X[i][0]) - s * Wide(X[i][1]), s * Wide(X[i][0]) + c * Wide(X[i][1])};
}

RigidTwist rigid_twist(const SoftGrains& grains, const GrainBatch& batch, const WideVectors& x,
                       const WideVectors& v) {
  const RigidMass all = rigid_mass(grains, batch);
  Vec<2, Wide> momentum{};
  Wide angular = 0.0;
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Vec<2, Wide> p = grains.node_mass(batch, i) * v[i];
    momentum += p;
    angular += cross_of(x[i] - x[0], p);
  }
  return {(1.0 / all.mass) * momentum, angular / all.inertia};
}

void set_rigid_twist(const RigidTwist& twist, const WideVectors& x, WideVectors& v) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec<2, Wide> r = x[i] - x[0];
    v[i] = twist.velocity + twist.spin * Vec<2, Wide>{-r[1], r[0]};
  }
}

RigidMass rigid_mass(const SoftGrains& grains, const GrainBatch& batch) {
  RigidMass all{0.0, 0.0};
  const Wide square = batch.radius * batch.radius;
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Wide m = grains.node_mass(batch, i);
    const Vec<2>& X = batch.topology->grid.node[i];
    all.mass += m;
    all.inertia += m * (dot(X, X) * square);
  }
  return all;
}

}  // namespace softgrain
