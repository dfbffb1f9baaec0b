#pragma once
#include "softgrain/soft/soft_grains.hpp"

// Rigid grains among soft ones (theory (70)): three degrees of freedom, seen as nodes that keep their places
// to each other,
//   x_i = x_c + R Q X_i,  v_i = v_c + w e_z x (x_i - x_c),
// with masses of the nodes that add up to m and to I. Node 0 is the centre of mass. Where a step has moved
// the nodes of a grain along its three motions, the grain is where they lie best.

namespace softgrain {

/// Where the rigid grains of a batch are.
struct RigidPose {
  Vec<2, Wide> centre;             ///< x_c [m]
  Vec<2, Wide> along{{1.0, 0.0}};  ///< Q e_x
};
RigidPose rigid_pose(const GrainBatch& batch, const WideVectors& x);
/// Angle from one pose to another [rad], in (-pi, pi].
Wide angle_between(const RigidPose& from, const RigidPose& to);
/// The pose turned by an angle [rad] and moved.
RigidPose moved(const RigidPose& pose, const Vec<2, Wide>& way, const Wide& angle);
/// x_i of all nodes.
void place_rigid(const GrainBatch& batch, const RigidPose& pose, WideVectors& x);

/// How they move.
struct RigidTwist {
  Vec<2, Wide> velocity;  ///< v_c [m/s]
  Wide spin = 0.0;        ///< w [1/s]
};
/// Momentum over m, and angular momentum about the centre over I, of nodes at x.
RigidTwist rigid_twist(const SoftGrains& grains, const GrainBatch& batch, const WideVectors& x,
                       const WideVectors& v);
/// v_i of all nodes at x.
void set_rigid_twist(const RigidTwist& twist, const WideVectors& x, WideVectors& v);

/// m [kg/m] and I [kg m^2/m] of the grains of a batch.
struct RigidMass {
  Wide mass, inertia;
  /// 1/2 m v^2 + 1/2 I w^2
  Wide energy(const RigidTwist& twist) const {
    return 0.5 * (mass * dot(twist.velocity, twist.velocity) + inertia * twist.spin * twist.spin);
  }
};
RigidMass rigid_mass(const SoftGrains& grains, const GrainBatch& batch);

}  // namespace softgrain
