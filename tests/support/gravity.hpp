#pragma once
#include "softgrain/rigid/step.hpp"

namespace softgrain::test {

/// The weight of every particle under the acceleration g [m/s^2].
template <int Dim>
ForceField<Dim> gravity(const Vec<Dim>& g) {
  return [g](const RigidParticles<Dim>& particles, std::span<Vec<Dim>> force) {
    for (int i = 0; i < particles.size(); ++i) force[i] += particles.mass[i] * g;
  };
}

template <int Dim>
ForceField<Dim> no_force() {
  return [](const RigidParticles<Dim>&, std::span<Vec<Dim>>) {};
}

/// The same coefficient of friction everywhere.
inline FrictionRule friction(double mu) {
  return [mu](int, int) { return mu; };
}

}  // namespace softgrain::test
