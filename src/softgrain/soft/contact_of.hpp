#pragma once
#include <type_traits>

#include "softgrain/soft/outline_contacts.hpp"
#include "softgrain/soft/surface_contacts.hpp"

namespace softgrain {

/// What the geometry of contact is in the plane and in space.
template <int Dim>
using ContactOf = std::conditional_t<Dim == 2, OutlineContact, SurfaceContact>;
template <int Dim>
using NeighboursOf = std::conditional_t<Dim == 2, OutlineNeighbours, SurfaceNeighbours>;

/// Lists of contacts and of impulses, where the dimension follows from another argument.
template <int Dim>
using Contacts = std::type_identity_t<std::span<const ContactOf<Dim>>>;
template <int Dim>
using Impulses = std::type_identity_t<std::span<const Vec<Dim>>>;

}  // namespace softgrain
