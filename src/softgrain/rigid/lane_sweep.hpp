#pragma once
#include <span>

#include "softgrain/contact/law.hpp"
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// What a sweep works on: views of the bodies and the contacts.
struct SweepData {
  RigidParticles<2>& particles;
  const RigidContacts<2>& contacts;
  std::span<const double> offset;    ///< (m) [m/s] as from signorini_offset
  std::span<Vec<2>> impulse;         ///< (m) [N s/m]
  std::span<const double> friction;  ///< (m)
  double relaxation;                 ///< omega
};

/// Relaxes the contacts of a batch up to its `fours_end` four at once, as RigidContactSystem::relax_contact
/// does one by one.
Violation sweep_fours(const SweepData& data, const ContactBatch& batch, bool frictional);

/// v += M^-1 n p_n for the same contacts of a frictionless batch.
void push_fours(RigidParticles<2>& particles, const RigidContacts<2>& contacts,
                std::span<const Vec<2>> impulse, const ContactBatch& batch);

}  // namespace softgrain
