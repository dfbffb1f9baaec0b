#pragma once
#include "softgrain/soft/lumped_bodies.hpp"
#include "softgrain/soft/soft_grains.hpp"

// Rigid grains among soft ones (theory (70)): three degrees of freedom, six in space, seen as nodes that keep
// their places to each other,
//   x_i = x_c + R Q X_i,  v_i = v_c + omega x (x_i - x_c),
// with masses of the nodes that add up to m and to I. In the plane node 0 is the centre of mass, in space the
// last one. Where a step has moved the nodes of a grain along its motions, the grain is where they lie best.

namespace softgrain {

inline std::size_t centre_node(const Topology&) { return 0; }
inline std::size_t centre_node(const SolidTopology& shape) { return shape.grid.node.size() - 1; }

/// Where the rigid grains of a batch are.
template <int Dim>
struct RigidPoseOf;
template <>
struct RigidPoseOf<2> {
  Vec<2, Wide> centre;             ///< x_c [m]
  Vec<2, Wide> along{{1.0, 0.0}};  ///< Q e_x
};
template <>
struct RigidPoseOf<3> {
  Vec<3, Wide> centre;  ///< x_c [m]
  Mat<3, Wide> turn;    ///< Q
};
using RigidPose = RigidPoseOf<2>;

RigidPose rigid_pose(const GrainBatch& batch, const WideVectors& x);
RigidPoseOf<3> rigid_pose(const BatchOf<3>& batch, const WidePlaces<3>& x);
/// Angle from one pose to another [rad], in (-pi, pi].
Wide angle_between(const RigidPose& from, const RigidPose& to);
/// The pose turned by an angle [rad], in space by the length of a vector about it, and moved.
RigidPose moved(const RigidPose& pose, const Vec<2, Wide>& way, const Wide& angle);
RigidPoseOf<3> moved(const RigidPoseOf<3>& pose, const Vec<3, Wide>& way, const Vec<3, Wide>& angle);
/// x_i of all nodes.
void place_rigid(const GrainBatch& batch, const RigidPose& pose, WideVectors& x);
void place_rigid(const BatchOf<3>& batch, const RigidPoseOf<3>& pose, WidePlaces<3>& x);

/// How they move.
template <int Dim>
struct RigidTwistOf {
  Vec<Dim, Wide> velocity;   ///< v_c [m/s]
  SpinOf<Dim, Wide> spin{};  ///< omega [1/s]
};
using RigidTwist = RigidTwistOf<2>;

/// Momentum over m, and angular momentum about the centre over I, of nodes at x.
template <int Dim>
RigidTwistOf<Dim> rigid_twist(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch,
                              const WidePlaces<Dim>& x, const WidePlaces<Dim>& v);
/// v_i of all nodes at x.
void set_rigid_twist(const RigidTwist& twist, const WideVectors& x, WideVectors& v);
void set_rigid_twist(const RigidTwistOf<3>& twist, const WidePlaces<3>& x, WidePlaces<3>& v);

/// m [kg/m] and I [kg m^2/m] of the grains of a batch; in space without "/m", of balls.
template <int Dim>
struct RigidMassOf {
  Wide mass, inertia;
  /// I omega . omega'
  Wide of_spins(const SpinOf<Dim, Wide>& spin, const SpinOf<Dim, Wide>& other) const {
    if constexpr (Dim == 2)
      return inertia * spin * other;
    else
      return inertia * dot(spin, other);
  }
  /// 1/2 m v^2 + 1/2 I omega^2
  Wide energy(const RigidTwistOf<Dim>& twist) const {
    return 0.5 * (mass * dot(twist.velocity, twist.velocity) + of_spins(twist.spin, twist.spin));
  }
};
using RigidMass = RigidMassOf<2>;

template <int Dim>
RigidMassOf<Dim> rigid_mass(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch);

/// I = sum m_i (r . r 1 - r (x) r) about the centre, of nodes at x [kg m^2]: of any shape.
Mat<3, Wide> inertia_tensor(const GrainsOf<3>& grains, const BatchOf<3>& batch, const WidePlaces<3>& x);

/// A free turn of grains of any shape over dt: their angular momentum stays, L = I omega,
///   Q+ = exp(dt omega_m) Q,  omega_m = I(exp(dt/2 omega_m) Q)^-1 L,  omega+ = I(Q+)^-1 L.
/// Places the nodes, moved by `way` besides, and returns omega+.
Vec<3, Wide> turn_freely(const GrainsOf<3>& grains, const BatchOf<3>& batch, double dt,
                         const Vec<3, Wide>& way, const Vec<3, Wide>& spin, WidePlaces<3>& x);

}  // namespace softgrain
