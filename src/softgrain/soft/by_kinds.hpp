#pragma once
#include "softgrain/contact/by_kinds.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// The value of a contact of outlines or surfaces.
template <class T, int Dim, class Contact>
const T& value_of(const ByKinds<T>& by_kinds, const GrainsOf<Dim>& grains, const Contact& contact) {
  return by_kinds.of(
      grains.kind(grains.grain_of_vertex(contact.vertex)),
      contact.wall >= 0 ? ByKinds<T>::wall : grains.kind(grains.grain_of_vertex(contact.facing_vertex())));
}

}  // namespace softgrain
