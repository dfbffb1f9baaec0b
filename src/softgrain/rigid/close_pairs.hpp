#pragma once
#include <array>
#include <vector>

#include "softgrain/rigid/neighbours.hpp"

namespace softgrain {

/// Two bodies that may touch.
struct BodyPair {
  int a, b;
  std::array<int, 3> image{};  // of b
  bool crosses() const { return image != std::array<int, 3>{}; }
};

/// Pairs of a list with gap < skin + reach at its reference: of particles of different grains, through all
/// images, then of particles and walls.
template <int Dim>
std::vector<BodyPair> pairs_between(const RigidParticles<Dim>& particles,
                                    const NeighbourReference<Dim>& reference);
/// Those of the particles of a grain with gap < skin.
template <int Dim>
std::vector<BodyPair> pairs_inside(const RigidParticles<Dim>& particles,
                                   const NeighbourReference<Dim>& reference, const GrainRange& grain);

}  // namespace softgrain
