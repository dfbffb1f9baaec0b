#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/rigid/neighbours.hpp"

namespace softgrain {

/// Two bodies that may touch.
struct BodyPair {
  int a, b;
  std::array<int, 3> image{};  // of b
  bool crosses() const { return image != std::array<int, 3>{}; }
};

/// 1 for bodies with more than five times the radius of the smallest, such as rigid grains among primaries:
/// cells of a grid that fit the others do not fit them.
std::vector<char> wide_bodies(std::span<const double> radius);

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
