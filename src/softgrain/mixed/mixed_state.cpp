#include <cstdint>

#include "softgrain/core/error.hpp"
#include "softgrain/mixed/mixed_grains.hpp"

namespace softgrain {
namespace {

/// Of a contact: the primary, the elastic grain, the vertex or -1, and the four of the span.
constexpr std::size_t bodies_of_contact = 7;

/// Raises IoError for bodies that are not there.
void check_bodies(const std::vector<std::int64_t>& bodies, int primaries, const SoftGrains& grains) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const std::size_t part = k % bodies_of_contact;
    const int count = part == 0 ? primaries : part == 1 ? grains.size() : grains.outline_size();
    if (bodies[k] < (part == 2 ? -1 : 0) || bodies[k] >= count)
      throw IoError(fmt::format("the snapshot's array 'primary_contact_bodies' holds {}", bodies[k]));
  }
}

}  // namespace

void MixedGrains::visit(StateVisitor& visit) {
  elastic_.visit(visit);
  PartVisitor part(visit, "bonded_");
  bonded_.visit(part);
  std::vector<std::int64_t> bodies;
  std::vector<Vec<4>> places;
  std::vector<Vec<2>> images;
  const bool repeats = bonded_.dynamics().particles.cell.any();
  for (const PrimaryContact& c : contacts_) {
    bodies.insert(bodies.end(), {c.primary, c.grain, c.vertex});
    bodies.insert(bodies.end(), c.span.begin(), c.span.end());
    if (repeats) images.push_back(c.image);
    places.push_back({c.share, c.normal[0], c.normal[1], c.gap});
  }
  visit.list({"primary_contact_bodies", "", Owner::contact, Role::start,
              "of primaries and outlines: primary, elastic grain, vertex or -1, four vertices of the span"},
             bodies, bodies_of_contact);
  visit.list({"primary_contact_places", "", Owner::contact, Role::start, "share, normal (2), gap [m]"},
             places);
  visit.list({"primary_contact_impulse", "N s/m", Owner::contact, Role::start, "(p_n, p_t)"}, impulse_);
  if (repeats)
    visit.list({"primary_contact_image", "m", Owner::contact, Role::start,
                "from the outline to where the primary meets it"},
               images);
  if (!visit.reads()) return;
  if (bodies.size() != bodies_of_contact * places.size() || places.size() != impulse_.size() ||
      (repeats && images.size() != places.size()))
    throw IoError("the snapshot's arrays of contacts have different lengths");
  check_bodies(bodies, bonded_.dynamics().particles.size(), elastic_.dynamics().grains);
  contacts_.clear();
  for (std::size_t c = 0; c < places.size(); ++c) {
    const auto body = [&](std::size_t k) { return static_cast<int>(bodies[bodies_of_contact * c + k]); };
    contacts_.push_back({.primary = body(0),
                         .grain = body(1),
                         .vertex = body(2),
                         .span = {body(3), body(4), body(5), body(6)},
                         .share = places[c][0],
                         .normal = {places[c][1], places[c][2]},
                         .gap = places[c][3],
                         .image = repeats ? images[c] : Vec<2>{}});
  }
}

void MixedGrains::go_on(const Box<2>& box) {
  elastic_.go_on(box);
  bonded_.go_on(box);
  tell_who_is_met();
}

}  // namespace softgrain
