#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/material/elastic_law.hpp"
#include "softgrain/soft/contact_lists.hpp"
#include "softgrain/soft/soft_view.hpp"

namespace softgrain {
namespace {

/// Forces of contacts on the outlines' vertices [N].
std::vector<Vec<3>> forces_on_vertices(const SoftViewOf<3>& view) {
  std::vector<Vec<3>> force(view.grains.outline_size());
  for (std::size_t c = 0; c < view.contacts.size(); ++c) {
    if (!(view.impulse[c][0] > 0)) continue;
    const Vec<3> f = (1 / view.impulse_time) * impulse_vector(view.contacts[c], view.impulse[c]);
    view.contacts[c].for_each_vertex([&](int vertex, double weight) { force[vertex] += weight * f; });
  }
  return force;
}

/// Cauchy stress P F^T/J of point p of a grain at F [Pa].
Mat<3> stress_at(const SolidGrains& grains, int grain, std::size_t p, const Mat<3>& F) {
  const auto place = grains.batch_of(grain);
  const SolidBatch* batch = place.first;  // not a structured binding: clang 14 keeps those out of lambdas
  const int lane = place.second;
  const Mat<3> P = std::visit(
      [&]<class Law>(const Law& law) -> Mat<3> {
        if constexpr (SplitLaw<Law, 3>) {
          return law.stress(F);
        } else if constexpr (HistoryLaw<Law, 3>) {
          typename Law::template State<3, double> state;
          for (std::size_t k = 0; k < state.size(); ++k)
            state[k] = batch->history[state.size() * p + k][lane];
          return law.stress(F, state, 0);
        } else {
          return {};
        }
      },
      grains.law(*batch));
  return (1 / determinant(F)) * (P * transpose(F));
}

/// Of each rigid grain the mean stress of its contacts, V^-1 sum (x - x_c) (x) f [Pa].
std::vector<Mat<3>> rigid_stresses(const SoftViewOf<3>& view, std::span<const Vec<3>> centre) {
  const SolidGrains& grains = view.grains;
  std::vector<Mat<3>> stress(centre.size());
  const auto add = [&](int grain, const Vec<3>& x, const Vec<3>& f) {
    const double volume = body_size(grains.topology(grain)) * body_unit<3>(grains.radius(grain));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) stress[grain](i, j) += (x - centre[grain])[i] * f[j] / volume;
  };
  for (const ContactPointOf<3>& point : contact_points(view)) {
    add(point.a, point.position, Vec<3>{} - point.force);
    if (point.b >= 0) add(point.b, point.position - point.image, point.force);
  }
  return stress;
}

/// Means over the cell behind a quad, compression positive.
struct Skin {
  double pressure = 0;  ///< -tr(sigma)/3 [Pa]
  double J = 0;
  Mat<3> stress;  ///< sigma [Pa]
};

/// Behind each quad of a grain: the last cells of the grid, in the order of the quads.
std::vector<Skin> skin_of(const SolidGrains& grains, int grain) {
  const SolidTopology& shape = grains.topology(grain);
  std::vector<Skin> skin;
  for (std::size_t c = shape.grid.cell.size() - shape.grid.quad.size(); c < shape.grid.cell.size(); ++c) {
    Skin mean;
    for (std::size_t p = 8 * c; p < 8 * c + 8; ++p) {
      Mat<3> F;
      for (std::size_t a = 0; a < 8; ++a) {
        const Vec<3> x = (1 / grains.radius(grain)) * grains.node_position(grain, shape.grid.cell[c][a]);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) F(i, j) += x[i] * shape.points[p].gradient[a][j];
      }
      mean.stress += (1.0 / 8) * stress_at(grains, grain, p, F);
      mean.J += determinant(F) / 8;
    }
    mean.pressure = -trace(mean.stress) / 3;
    skin.push_back(mean);
  }
  return skin;
}

std::vector<Skin> skin_of_rigid(const SolidGrains& grains, int grain, const Mat<3>& stress) {
  return {grains.topology(grain).grid.quad.size(), Skin{-trace(stress) / 3, 1, stress}};
}

constexpr std::size_t masters = 16, bodies_of_contact = 3 + masters;

/// The patch that has these vertices, or the sphere at one of them. Raises IoError if there is none.
void set_faced_patch(const SolidGrains& grains, const std::array<int, masters>& vertices,
                     SurfaceContact& contact) {
  contact.facing = grains.grain_of_vertex(vertices[0]);
  const SolidTopology& shape = grains.topology(contact.facing);
  if (shape.ball) {
    contact.patch = &net_of_one_vertex;
    contact.facing_begin = vertices[0];
    return;
  }
  contact.facing_begin = grains.outline_begin(contact.facing);
  for (const PatchNet& net : shape.patches) {
    const auto is_there = [&](int vertex, int faced) { return contact.facing_begin + vertex == faced; };
    if (std::equal(net.vertex.begin(), net.vertex.end(), vertices.begin(), is_there)) {
      contact.patch = &net;
      return;
    }
  }
  throw IoError("the snapshot's array 'contact_bodies' holds a patch that its grain does not have");
}

}  // namespace

std::vector<ContactPointOf<3>> contact_points(const SoftViewOf<3>& view) {
  const SolidGrains& grains = view.grains;
  std::vector<PaddedVec> x;
  grains.gather_outline(x);
  std::vector<ContactPointOf<3>> points;
  for (std::size_t c = 0; c < view.contacts.size(); ++c) {
    const SurfaceContact& contact = view.contacts[c];
    if (!(view.impulse[c][0] > 0)) continue;
    Vec<3> place = place_of(contact, x);
    if (const int g = grains.grain_of_vertex(contact.vertex); grains.topology(g).ball)
      place -= grains.radius(g) * contact.normal;
    points.push_back({.a = grains.grain_of_vertex(contact.vertex),
                      .b = contact.wall >= 0 ? wall_index(contact.wall) : contact.facing,
                      .force = (-1 / view.impulse_time) * impulse_vector(contact, view.impulse[c]),
                      .normal = Vec<3>{} - contact.normal,
                      .position = place,
                      .image = contact.image});
  }
  return points;
}

std::vector<SurfaceMeasure> outlines_of(const SolidGrains& grains) {
  std::vector<Vec<3>> x;
  grains.gather_outline(x);
  std::vector<SurfaceMeasure> measures(grains.size());
  parallel_for(grains.size(), [&](int g) {
    const SolidTopology& shape = grains.topology(g);
    measures[g] = measure_surface(shape.patches, &x[grains.outline_begin(g)]);
    measures[g].volume *= shape.patch_fullness;
    measures[g].area *= std::pow(shape.patch_fullness, 2.0 / 3);
  });
  return measures;
}

Scene soft_scene(const SoftViewOf<3>& view) {
  const SolidGrains& grains = view.grains;
  std::vector<Vec<3>> outline;
  grains.gather_outline(outline);
  std::vector<double> radius, pressure, dilatation, stress;
  std::vector<std::int64_t> grain, kind, grain_of_vertex, quads, grain_of_quad;
  const std::vector<Vec<3>> centre = centres_of(grains);
  const std::vector<Mat<3>> of_contacts =
      grains.has_rigid() ? rigid_stresses(view, centre) : std::vector<Mat<3>>{};
  for (int g = 0; g < grains.size(); ++g) {
    grain.push_back(g);
    kind.push_back(grains.kind(g));
    radius.push_back(grains.radius(g));
    const int begin = grains.outline_begin(g), first = grains.topology(g).grid.outline_begin;
    grain_of_vertex.insert(grain_of_vertex.end(), grains.outline_end(g) - begin, g);
    for (const auto& quad : grains.topology(g).grid.quad)
      for (const int node : quad) quads.push_back(begin + node - first);
    grain_of_quad.insert(grain_of_quad.end(), grains.topology(g).grid.quad.size(), g);
    const bool rigid = grains.topology(g).rigid();
    for (const Skin& skin : rigid ? skin_of_rigid(grains, g, of_contacts[g]) : skin_of(grains, g)) {
      pressure.push_back(skin.pressure);
      dilatation.push_back(skin.J);
      stress.insert(stress.end(), skin.stress.c.begin(), skin.stress.c.end());
    }
  }
  Scene scene;
  scene.particles["position"] = to_array(centre);
  scene.particles["radius"] = {1, std::move(radius)};
  scene.particles["grain"] = {1, std::move(grain)};
  if (grains.kinds() > 1) scene.particles["kind"] = {1, std::move(kind)};
  scene.outlines["position"] = to_array(outline);
  scene.outlines["force"] = to_array(forces_on_vertices(view));
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  scene.surface["quad"] = {4, std::move(quads)};
  scene.surface["grain"] = {1, std::move(grain_of_quad)};
  scene.surface["pressure"] = {1, std::move(pressure)};
  scene.surface["J"] = {1, std::move(dilatation)};
  scene.surface["stress"] = {9, std::move(stress)};
  scene.contacts = grain_contacts(contact_points(view), grains.size());
  return scene;
}

void visit_contacts(const SolidGrains& grains, int walls, bool repeats, std::vector<SurfaceContact>& contacts,
                    std::vector<Vec<3>>& impulse, StateVisitor& visit) {
  std::vector<std::int64_t> bodies;
  std::vector<Vec<4 + masters>> places;
  std::vector<Vec<3>> images;
  for (const SurfaceContact& c : contacts) {
    bodies.insert(bodies.end(), {c.point, c.vertex, c.wall});
    for (std::size_t k = 0; k < masters; ++k)
      bodies.push_back(c.wall < 0 ? c.facing_begin + c.patch->vertex[k] : 0);
    Vec<4 + masters> place{c.normal[0], c.normal[1], c.normal[2], c.gap};
    for (std::size_t k = 0; k < masters; ++k) place[static_cast<int>(4 + k)] = c.weight[k];
    places.push_back(place);
    if (repeats) images.push_back(c.image);
  }
  visit_contact_lists(visit, bodies, bodies_of_contact, places);
  if (repeats) visit_contact_images(visit, images);
  visit.list({"contact_impulse", "N s/m", Owner::contact, Role::start, "(p_n, p_t)"}, impulse);
  if (!visit.reads()) return;
  const Middles middles(grains);
  check_contact_bodies(bodies, bodies_of_contact, 2, [&](std::size_t k) {
    return k == 2 ? walls : grains.outline_size() + (k == 0 ? middles.size() : 0);
  });
  if (places.size() != impulse.size() || (repeats && images.size() != impulse.size()) ||
      bodies.size() != bodies_of_contact * places.size())
    throw IoError("the snapshot's arrays of contacts have different lengths");
  contacts.clear();
  for (std::size_t c = 0; c < places.size(); ++c) {
    const auto body = [&](std::size_t k) { return static_cast<int>(bodies[bodies_of_contact * c + k]); };
    const auto& place = places[c];
    SurfaceContact contact{.point = body(0), .vertex = body(1), .grain = grains.grain_of_vertex(body(1))};
    if (contact.point >= grains.outline_size())
      contact = middles.point(contact.point - grains.outline_size());
    if (contact.vertex != body(1))
      throw IoError(fmt::format(
          "the snapshot's array 'contact_bodies' holds vertex {} for the middle of a patch at vertex {}, as "
          "version 0.2 wrote it where rigid spheres meet elastic ones; begin the run again",
          body(1), contact.vertex));
    contact.wall = body(2);
    contact.normal = {place[0], place[1], place[2]};
    contact.gap = place[3];
    if (repeats) contact.image = images[c];
    if (contact.wall < 0) {
      std::array<int, masters> vertices;
      std::array<double, masters> weights;
      for (std::size_t k = 0; k < masters; ++k)
        vertices[k] = body(3 + k), weights[k] = place[static_cast<int>(4 + k)];
      set_faced_patch(grains, vertices, contact);
      contact.weight = narrow_weights(weights);
    }
    contact.offset = offset_of(contact, grains);
    contacts.push_back(contact);
  }
}

}  // namespace softgrain
