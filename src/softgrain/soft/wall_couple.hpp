#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/friction_by_kind.hpp"
#include "softgrain/soft/outline_contacts.hpp"

namespace softgrain {

/// A round grain of isotropic material between frictionless plane walls keeps its spin, however it is turned
/// and wherever the walls press: nothing tells one diameter from another. The grid does: what vertices and
/// cells bear has an arm about the centre, of some hundredths of R where the contact is a few segments wide
/// (docs/decisions/0034). A couple takes that off such grains: 1 in their lanes, 0 in others.
///
/// Such a grain is round (Topology::round), walls are frictionless for its kind, and all contacts of its
/// vertices in the list, also open ones, are with walls. met: (grains) 1 for those near other bodies than
/// grains and walls; empty: none is. (batches)
std::vector<Wide> grains_on_smooth_walls_alone(const SoftGrains& grains,
                                               std::span<const OutlineContact> contacts,
                                               const FrictionByKind& friction,
                                               std::span<const char> met = {});

/// Gives the grains whose lanes in `alone` are 1 the rotation that takes back the angular momentum that
/// `impulse` gave them about their centres. outline: (outline vertices) where they are [m].
/// Returns the kinetic energy that this gives [J/m].
double turn_back(SoftGrains& grains, std::span<const Wide> alone, std::span<const OutlineContact> contacts,
                 std::span<const Vec<2>> impulse, std::span<const Vec<2>> outline);

}  // namespace softgrain
