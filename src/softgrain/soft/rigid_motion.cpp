#include "softgrain/soft/rigid_motion.hpp"

#include <cmath>

namespace softgrain {
namespace {

Wide cross_of(const Vec<2, Wide>& a, const Vec<2, Wide>& b) { return a[0] * b[1] - a[1] * b[0]; }
Vec<3, Wide> cross_of(const Vec<3, Wide>& a, const Vec<3, Wide>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

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

RigidPoseOf<3> rigid_pose(const BatchOf<3>& batch, const WidePlaces<3>& x) {
  const std::vector<Vec<3>>& X = batch.topology->grid.node;
  const Vec<3, Wide>& centre = x.back();
  // A = (sum r X^T)(sum X X^T)^-1, brought to a rotation: one step of Newton's for the polar factor, from
  // which the nodes are a round-off away
  Mat<3, Wide> rX{};
  Mat<3> XX{};
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const Vec<3, Wide> r = x[k] - centre;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        rX(i, j) += X[k][j] * r[i];
        XX(i, j) += X[k][i] * X[k][j];
      }
  }
  const Mat<3> inverse_XX = inverse(XX);
  const Wide inverse_radius = 1.0 / batch.radius;
  Mat<3, Wide> A{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      A(i, j) = inverse_radius *
                (rX(i, 0) * inverse_XX(0, j) + rX(i, 1) * inverse_XX(1, j) + rX(i, 2) * inverse_XX(2, j));
  Mat<3, Wide> half = Wide(-0.5) * (transpose(A) * A);
  for (int i = 0; i < 3; ++i) half(i, i) += 1.5;
  return {centre, A * half};
}

/// By Rodrigues' formula, R = 1 + sin(a)/a [w] + (1 - cos(a))/a^2 [w]^2, a = |w|.
RigidPoseOf<3> moved(const RigidPoseOf<3>& pose, const Vec<3, Wide>& way, const Vec<3, Wide>& angle) {
  Wide sine, cosine;
  for (int lane = 0; lane < Wide::size; ++lane) {
    const double a = std::sqrt(dot(angle, angle)[lane]);
    sine.set(lane, a > 0 ? std::sin(a) / a : 1.0);
    cosine.set(lane, a > 0 ? 2 * std::pow(std::sin(a / 2) / a, 2) : 0.5);
  }
  Mat<3, Wide> w{};
  w(2, 1) = angle[0], w(1, 2) = -angle[0];
  w(0, 2) = angle[1], w(2, 0) = -angle[1];
  w(1, 0) = angle[2], w(0, 1) = -angle[2];
  Mat<3, Wide> R = sine * w + cosine * (w * w);
  for (int i = 0; i < 3; ++i) R(i, i) += 1.0;
  return {pose.centre + way, R * pose.turn};
}

void place_rigid(const BatchOf<3>& batch, const RigidPoseOf<3>& pose, WidePlaces<3>& x) {
  const std::vector<Vec<3>>& X = batch.topology->grid.node;
  const Mat<3, Wide> RQ = batch.radius * pose.turn;
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = pose.centre;
    for (int i = 0; i < 3; ++i)
      x[k][i] += RQ(i, 0) * Wide(X[k][0]) + RQ(i, 1) * Wide(X[k][1]) + RQ(i, 2) * Wide(X[k][2]);
  }
}

template <int Dim>
RigidTwistOf<Dim> rigid_twist(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch,
                              const WidePlaces<Dim>& x, const WidePlaces<Dim>& v) {
  const RigidMassOf<Dim> all = rigid_mass(grains, batch);
  const Vec<Dim, Wide>& centre = x[centre_node(*batch.topology)];
  Vec<Dim, Wide> momentum{};
  SpinOf<Dim, Wide> angular{};
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Vec<Dim, Wide> p = grains.node_mass(batch, i) * v[i];
    momentum += p;
    angular += cross_of(x[i] - centre, p);
  }
  if constexpr (Dim == 2) {
    return {(1.0 / all.mass) * momentum, angular / all.inertia};
  } else {
    if (batch.topology->rigid_shape())
      return {(1.0 / all.mass) * momentum, inverse(inertia_tensor(grains, batch, x)) * angular};
    return {(1.0 / all.mass) * momentum, (1.0 / all.inertia) * angular};
  }
}

Mat<3, Wide> inertia_tensor(const GrainsOf<3>& grains, const BatchOf<3>& batch, const WidePlaces<3>& x) {
  Mat<3, Wide> I{};
  for (int k = 0; k < batch.topology->grid.nodes(); ++k) {
    const Vec<3, Wide> r = x[k] - x.back();
    const Wide m = grains.node_mass(batch, k), square = dot(r, r);
    for (int i = 0; i < 3; ++i) {
      I(i, i) += m * square;
      for (int j = 0; j < 3; ++j) I(i, j) -= m * r[i] * r[j];
    }
  }
  return I;
}

Vec<3, Wide> turn_freely(const GrainsOf<3>& grains, const BatchOf<3>& batch, double dt,
                         const Vec<3, Wide>& way, const Vec<3, Wide>& spin, WidePlaces<3>& x) {
  constexpr int passes = 6;  // each leaves (dt omega)^2 or less of the error
  const RigidPoseOf<3> pose = rigid_pose(batch, x);
  const Vec<3, Wide> L = inertia_tensor(grains, batch, x) * spin;
  Vec<3, Wide> middle = spin;
  for (int pass = 0; pass < passes; ++pass) {
    place_rigid(batch, moved(pose, {}, Wide(dt / 2) * middle), x);
    middle = inverse(inertia_tensor(grains, batch, x)) * L;
  }
  place_rigid(batch, moved(pose, way, Wide(dt) * middle), x);
  return inverse(inertia_tensor(grains, batch, x)) * L;
}

void set_rigid_twist(const RigidTwist& twist, const WideVectors& x, WideVectors& v) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec<2, Wide> r = x[i] - x[0];
    v[i] = twist.velocity + twist.spin * Vec<2, Wide>{-r[1], r[0]};
  }
}

void set_rigid_twist(const RigidTwistOf<3>& twist, const WidePlaces<3>& x, WidePlaces<3>& v) {
  for (std::size_t i = 0; i < x.size(); ++i) v[i] = twist.velocity + cross_of(twist.spin, x[i] - x.back());
}

template <int Dim>
RigidMassOf<Dim> rigid_mass(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch) {
  RigidMassOf<Dim> all{0.0, 0.0};
  const Wide square = batch.radius * batch.radius;
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Wide m = grains.node_mass(batch, i);
    const Vec<Dim>& X = batch.topology->grid.node[i];
    all.mass += m;
    all.inertia += m * (dot(X, X) * square);
  }
  if constexpr (Dim == 3) all.inertia = (2.0 / 3) * all.inertia;  // integral of y^2 + z^2, not of all three
  return all;
}

template RigidTwistOf<2> rigid_twist(const GrainsOf<2>&, const BatchOf<2>&, const WidePlaces<2>&,
                                     const WidePlaces<2>&);
template RigidTwistOf<3> rigid_twist(const GrainsOf<3>&, const BatchOf<3>&, const WidePlaces<3>&,
                                     const WidePlaces<3>&);
template RigidMassOf<2> rigid_mass(const GrainsOf<2>&, const BatchOf<2>&);
template RigidMassOf<3> rigid_mass(const GrainsOf<3>&, const BatchOf<3>&);

}  // namespace softgrain
