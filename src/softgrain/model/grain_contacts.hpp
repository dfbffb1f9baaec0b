#pragma once
#include <span>

#include "softgrain/observe/contact_network.hpp"
#include "softgrain/state/array.hpp"

namespace softgrain {

/// Contacts of a scene from their points: `pair` of grains, walls from `grains` on, `force` f_n [N/m], the
/// `total_force` of the first on the second [N/m], `normal` from the first to the second, `position` [m].
/// Pairs of grains first.
Arrays grain_contacts(std::span<const ContactPointOf<2>> points, int grains);
Arrays grain_contacts(std::span<const ContactPointOf<3>> points, int grains);

}  // namespace softgrain
