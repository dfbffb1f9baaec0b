#include "softgrain/lattice/lattice_grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/model/box_loan.hpp"
#include "softgrain/model/grain_contacts.hpp"
#include "softgrain/model/work_budget.hpp"

namespace softgrain {
namespace {

std::vector<Vec<4>> components(std::span<const Mat<2>> tensors) {
  std::vector<Vec<4>> rows;
  for (const Mat<2>& tensor : tensors) rows.push_back({tensor.c});
  return rows;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// As many of all as some holds, from `first` on.
void take(std::vector<Vec<2>>& some, const std::vector<Vec<2>>& all, std::size_t first) {
  std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(first), some.size(), some.begin());
}

}  // namespace

StepReport LatticeGrains::step(Box<2>& box, double dt) {
  const BoxLoan loan(box, dynamics_.box);
  const SoftStepReport soft = dynamics_.step(dt);
  impulse_time_ = dynamics_.impulse_time;
  ++sums_.steps;
  sums_.iterations += soft.iterations;
  sums_.rejected += soft.rejected;
  const UpdatedLagrangianOptions& options = dynamics_.options;
  return {.contacts = soft.contacts,
          .sweeps = soft.sweeps,
          .residual_mean = options.implicit ? soft.residual : soft.residual_mean,
          .residual_max = soft.residual,
          .residual_limit =
              options.implicit ? options.tolerance : options.solver.worst_factor * options.solver.tolerance,
          .overlap_mean = soft.overlap_mean,
          .overlap_max = soft.overlap_max,
          .converged = soft.converged};
}

std::vector<double> LatticeGrains::radii() const {
  std::vector<double> radius;
  for (const PointGrain& grain : dynamics_.grains)
    radius.push_back(std::sqrt(grain.area() / std::numbers::pi));
  return radius;
}

std::vector<Vec<2>> LatticeGrains::centres() const {
  std::vector<Vec<2>> centres;
  for (const PointGrain& grain : dynamics_.grains) {
    Vec<2> centre;
    for (int p = 0; p < grain.points(); ++p) centre += (grain.volume[p] / grain.area()) * grain.position[p];
    centres.push_back(centre);
  }
  return centres;
}

Bodies LatticeGrains::bodies() const {
  Bodies points;
  for (const PointGrain& grain : dynamics_.grains) {
    for (const double V : grain.volume) points.mass.push_back(density() * V);
    points.velocity.insert(points.velocity.end(), grain.velocity.begin(), grain.velocity.end());
    points.grain.resize(points.velocity.size(), static_cast<int>(&grain - dynamics_.grains.data()));
  }
  return points;
}

Outlines LatticeGrains::outlines() const {
  Outlines all{.vertex = {}, .begin = {0}, .area = 0};
  for (const PointGrain& grain : dynamics_.grains) {
    all.vertex.insert(all.vertex.end(), grain.outline.begin(), grain.outline.end());
    all.begin.push_back(static_cast<int>(all.vertex.size()));
    all.area += polygon_area(grain.outline);
  }
  return all;
}

std::vector<ContactPoint> LatticeGrains::contacts() const {
  std::vector<ContactPoint> points;
  for (std::size_t c = 0; c < dynamics_.contacts.size(); ++c) {
    const LatticeContact& contact = dynamics_.contacts[c];
    const Vec<2>& n = contact.normal;
    const Vec<2>& p = dynamics_.impulse[c];
    if (!(p[0] > 0)) continue;
    const std::vector<Vec<2>>& outline = dynamics_.grains[contact.grain].outline;
    points.push_back({.a = contact.grain,
                      .b = contact.other >= 0 ? contact.other : wall_index(contact.wall),
                      .force = (-1 / impulse_time_) * (p[0] * n + p[1] * perpendicular(n)),
                      .normal = -n,
                      .position = contact.vertex >= 0 ? outline[contact.vertex] : contact.node});
  }
  return points;
}

std::pair<double, double> LatticeGrains::extent(int axis) const {
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (const PointGrain& grain : dynamics_.grains)
    for (const Vec<2>& x : grain.outline)
      least = std::min(least, x[axis]), largest = std::max(largest, x[axis]);
  return {least, largest};
}

std::pair<double, double> LatticeGrains::reach() const {
  const auto [low, high] = extent(0);
  const double margin = 0.1 * (high - low);
  return {low - margin, high + margin};
}

Energies LatticeGrains::energies() const {
  double kinetic = 0;
  for (const PointGrain& grain : dynamics_.grains) kinetic += grain.kinetic_energy(density());
  return energies_of(dynamics_.work, kinetic, dynamics_.elastic_energy());
}

Numbers LatticeGrains::numbers(const Box<2>&, const Energies& energies) const {
  Numbers numbers = elastic_numbers(dynamics_.work, energies.stored);
  double least_J = std::numeric_limits<double>::infinity(), area = 0;
  for (const PointGrain& grain : dynamics_.grains) {
    area += grain.area();
    for (const Mat<2>& F : grain.F) least_J = std::min(least_J, determinant(F));
  }
  const std::vector<Vec<2>>& impulse = dynamics_.impulse;
  const auto contacts =
      std::count_if(impulse.begin(), impulse.end(), [](const Vec<2>& p) { return p[0] > 0; });
  numbers.emplace_back("contacts", contacts);
  numbers.emplace_back("least_J", least_J);
  numbers.emplace_back("area_ratio", outlines().area / area);
  if (!dynamics_.options.implicit) return numbers;
  numbers.emplace_back("iterations", sums_.steps > 0 ? sums_.iterations / sums_.steps : 0);
  numbers.emplace_back("rejected_steps", sums_.rejected);
  if (!(dynamics_.options.gravity == Vec<2>{})) numbers.emplace_back("gravity_work", dynamics_.work.gravity);
  return numbers;
}

Scene LatticeGrains::scene(const Box<2>&) const {
  std::vector<double> radius, pressure, dilatation;
  std::vector<Vec<2>> position, force;
  std::vector<Mat<2>> stress;
  std::vector<std::int64_t> grain_of_point, grain_of_vertex;
  std::vector<int> first_vertex;
  for (int g = 0; g < static_cast<int>(dynamics_.grains.size()); ++g) {
    const PointGrain& grain = dynamics_.grains[g];
    for (int p = 0; p < grain.points(); ++p) {
      position.push_back(grain.position[p]);
      dilatation.push_back(determinant(grain.F[p]));
      radius.push_back(std::sqrt(dilatation.back() * grain.volume[p] / std::numbers::pi));
      stress.push_back(dynamics_.stress(g, p));
      pressure.push_back(-trace(stress.back()) / 2);
      grain_of_point.push_back(g);
    }
    first_vertex.push_back(static_cast<int>(force.size()));
    force.resize(force.size() + grain.outline.size());  // zero for contact on nodes
    grain_of_vertex.insert(grain_of_vertex.end(), grain.outline.size(), g);
  }
  for (std::size_t c = 0; c < dynamics_.contacts.size(); ++c) {
    const LatticeContact& contact = dynamics_.contacts[c];
    const Vec<2>& p = dynamics_.impulse[c];
    if (contact.vertex >= 0)
      force[first_vertex[contact.grain] + contact.vertex] +=
          1 / impulse_time_ * (p[0] * contact.normal + p[1] * perpendicular(contact.normal));
  }
  Scene scene;
  scene.particles["position"] = to_array(position);
  scene.particles["radius"] = {1, std::move(radius)};
  scene.particles["pressure"] = {1, std::move(pressure)};
  scene.particles["J"] = {1, std::move(dilatation)};
  scene.particles["stress"] = to_array(components(stress));
  scene.particles["grain"] = {1, std::move(grain_of_point)};
  scene.outlines["position"] = to_array(outlines().vertex);
  scene.outlines["force"] = to_array(force);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  scene.contacts = grain_contacts(contacts(), static_cast<int>(dynamics_.grains.size()));
  return scene;
}

std::vector<GrainView> LatticeGrains::grains() const {
  const auto view = [](const std::vector<Vec<2>>& vectors) {
    return VectorView{.begin = vectors.front().c.data(), .rows = vectors.size()};
  };
  std::vector<GrainView> views;
  for (const PointGrain& grain : dynamics_.grains)
    views.push_back(
        {.position = view(grain.position), .velocity = view(grain.velocity), .outline = view(grain.outline)});
  return views;
}

Settings LatticeGrains::settings() const {
  const UpdatedLagrangianOptions& options = dynamics_.options;
  Settings settings{
      .friction = options.friction, .wall_friction = options.wall_friction, .damping = options.damping};
  if (options.implicit) settings.newton_tolerance = options.tolerance;
  return settings;
}

void LatticeGrains::set(const Settings& settings) {
  UpdatedLagrangianOptions& options = dynamics_.options;
  options.friction = settings.friction.value_or(options.friction);
  options.wall_friction = settings.wall_friction.value_or(options.wall_friction);
  options.damping = settings.damping.value_or(options.damping);
  if (options.implicit) options.tolerance = settings.newton_tolerance.value_or(options.tolerance);
}

void LatticeGrains::visit(StateVisitor& visit) {
  PointGrain all;  // one grain after the other
  for (const PointGrain& grain : dynamics_.grains) {
    append(all.position, grain.position);
    append(all.velocity, grain.velocity);
    append(all.F, grain.F);
    append(all.outline, grain.outline);
  }
  visit({"position", "m", Owner::point, Role::state, "material points"}, all.position);
  visit({"velocity", "m/s", Owner::point, Role::state, "theirs"}, all.velocity);
  std::vector<Vec<4>> F = components(all.F);
  visit({"deformation_gradient", "", Owner::point, Role::state, "F, row by row"}, F);
  visit({"outline", "m", Owner::node, Role::state, "vertices of the outline"}, all.outline);
  std::size_t point = 0, vertex = 0;
  for (PointGrain& grain : dynamics_.grains) {
    for (std::size_t p = 0; p < grain.F.size(); ++p) grain.F[p] = {F[point + p].c};
    take(grain.position, all.position, point);
    take(grain.velocity, all.velocity, point);
    take(grain.outline, all.outline, vertex);
    point += grain.position.size();
    vertex += grain.outline.size();
  }
  visit({"impulse_time", "s", Owner::run, Role::start, "the step over which impulses acted"}, impulse_time_);
  visit_work(dynamics_.work, visit);
  if (dynamics_.options.implicit) visit_implicit(visit);
}

/// From whose impulses NLGS starts, and sums. Raises IoError for contacts that cannot be.
void LatticeGrains::visit_implicit(StateVisitor& visit) {
  std::vector<std::int64_t> bodies;
  std::vector<Vec<4>> places;
  for (const LatticeContact& c : dynamics_.contacts) {
    bodies.insert(bodies.end(), {c.grain, c.other, c.wall, c.vertex});
    places.push_back({c.node[0], c.node[1], c.normal[0], c.normal[1]});
  }
  visit.list({"contact_bodies", "", Owner::contact, Role::start,
              "grain, other grain, wall, vertex of the outline; -1 where there is none"},
             bodies, 4);
  visit.list(
      {"contact_place", "m", Owner::contact, Role::start, "of the node, 0 of a vertex; then the normal"},
      places);
  visit.list({"contact_impulse", "N s/m", Owner::contact, Role::start, "(p_n, p_t)"}, dynamics_.impulse);
  visit({"steps_of_row", "", Owner::run, Role::sum, "steps since the last row"}, sums_.steps);
  visit({"iterations_of_row", "", Owner::run, Role::sum, "iterations since the last row"}, sums_.iterations);
  visit({"rejected_steps", "", Owner::run, Role::sum, "sub-steps taken back"}, sums_.rejected);
  if (!visit.reads()) return;
  if (bodies.size() != 4 * places.size() || places.size() != dynamics_.impulse.size())
    throw IoError("the snapshot's arrays of contacts have different lengths");
  dynamics_.contacts.clear();
  const auto grains = static_cast<std::int64_t>(dynamics_.grains.size());
  for (std::size_t c = 0; c < places.size(); ++c) {
    const std::int64_t* of_contact = &bodies[4 * c];
    if (of_contact[0] < 0 || of_contact[0] >= grains || of_contact[1] < -1 || of_contact[1] >= grains)
      throw IoError("the snapshot's array 'contact_bodies' names a grain that is not there");
    dynamics_.contacts.push_back({.grain = static_cast<int>(of_contact[0]),
                                  .other = static_cast<int>(of_contact[1]),
                                  .wall = static_cast<int>(of_contact[2]),
                                  .vertex = static_cast<int>(of_contact[3]),
                                  .normal = {places[c][2], places[c][3]},
                                  .node = {places[c][0], places[c][1]}});
  }
}

}  // namespace softgrain
