#pragma once
#include <fmt/core.h>

#include <cstdint>
#include <span>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// The numbers of bodies of contacts, so many a contact, and what else is known of them.
template <int N>
void visit_contact_lists(StateVisitor& visit, std::vector<std::int64_t>& bodies,
                         std::size_t bodies_of_contact, std::vector<Vec<N>>& places) {
  visit.list(
      {"contact_bodies", "", Owner::contact, Role::start,
       "vertex, wall or -1, four master vertices; in space point, vertex, wall or -1, 16 of the patch"},
      bodies, bodies_of_contact);
  visit.list(
      {"contact_places", "", Owner::contact, Role::start,
       "share, normal (2), gap [m], slip [m]; in space normal (3), gap found [m], weights of the patch (16)"},
      places);
}

/// Where the contacts of a periodic cell are met.
template <int Dim>
void visit_contact_images(StateVisitor& visit, std::vector<Vec<Dim>>& images) {
  visit.list({"contact_image", "m", Owner::contact, Role::start, "from the master to where it is met"},
             images);
}

/// Raises IoError unless the k-th body of each contact is from 0, a wall from -1, to below count_of(k).
template <class Count>
void check_contact_bodies(std::span<const std::int64_t> bodies, std::size_t bodies_of_contact,
                          std::size_t wall, const Count& count_of) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::size_t k = i % bodies_of_contact;
    if (bodies[i] < (k == wall ? -1 : 0) || bodies[i] >= count_of(k))
      throw IoError(fmt::format("the snapshot's array 'contact_bodies' holds {}", bodies[i]));
  }
}

}  // namespace softgrain
