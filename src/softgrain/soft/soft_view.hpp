#pragma once
#include <span>
#include <vector>

#include "softgrain/model/grain_contacts.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/model/work_budget.hpp"
#include "softgrain/soft/contact_of.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// Soft grains and their contacts as both integrators hold them.
template <int Dim>
struct SoftViewOf {
  const GrainsOf<Dim>& grains;
  std::span<const ContactOf<Dim>> contacts;
  std::span<const Vec<Dim>> impulse;     ///< impulses of `contacts`, (p_n, p_t) [N s/m in the plane]
  std::span<const double> attraction{};  ///< theirs, a [N s/m]; empty where nothing adheres
  double impulse_time = 0;               ///< time over which the impulses acted [s]
};
using SoftView = SoftViewOf<2>;

/// Contacts that carry impulse, with what attracts. One that touches takes half of the segments beside its
/// vertex, and half of that where the other grain's vertices touch too.
std::vector<ContactPoint> contact_points(const SoftView& view);
std::vector<ContactPointOf<3>> contact_points(const SoftViewOf<3>& view);

/// Of all grains; their area is pi R^2 times the mean J of a disk, by the polygons of the vertices (theory
/// (54)). In space volume and area by the smooth outlines, as if they held the body's volume at rest.
Outlines outlines_of(const SoftGrains& grains);
std::vector<SurfaceMeasure> outlines_of(const SolidGrains& grains);

/// Nodes of all grains.
template <int Dim>
BodiesOf<Dim> nodes_of(const GrainsOf<Dim>& grains);
template <int Dim>
std::vector<Vec<Dim>> centres_of(const GrainsOf<Dim>& grains);  ///< of mass [m]

/// sum of psi over all points [J/m in the plane], and the least det F of all.
template <int Dim>
double stored_energy(const GrainsOf<Dim>& grains);
template <int Dim>
double least_J(const GrainsOf<Dim>& grains);

/// Material points as disks of their present area, the outlines with the contact forces on their vertices,
/// and the contacts of grains.
Scene soft_scene(const SoftView& view);
/// The points of up to eight grains at a time, from the rank that has them; and the scene without them. Keeps
/// the references of the view.
ParticleParts particle_parts(const SoftView& view);
Scene scene_around_points(const SoftView& view);

/// In space the outlines' vertices with the contact forces on them, their quads with the pressure of the
/// cells behind, and the contacts of grains; centres and radii of the grains as particles.
Scene soft_scene(const SoftViewOf<3>& view);
inline ParticleParts particle_parts(const SoftViewOf<3>&) { return {}; }  ///< they are not many
inline Scene scene_around_points(const SoftViewOf<3>& view) { return soft_scene(view); }

/// The nodes of each grain in its lane.
template <int Dim>
std::vector<GrainView> grain_views(const GrainsOf<Dim>& grains);

/// Declares positions and velocities of all nodes, and the history of the points, eight grains to a row.
template <int Dim>
void visit_nodes(GrainsOf<Dim>& grains, StateVisitor& visit);

/// Declares the contacts and their impulses; with their images if a cell repeats. Raises IoError for vertices
/// and walls that are not there.
void visit_contacts(const SoftGrains& grains, int walls, bool repeats, std::vector<OutlineContact>& contacts,
                    std::vector<Vec<2>>& impulse, StateVisitor& visit);
/// Declares what attracts at the contacts, after these.
void visit_attraction(std::size_t contacts, std::vector<double>& attraction, double& energy, double& gained,
                      StateVisitor& visit);
void visit_contacts(const SolidGrains& grains, int walls, bool repeats, std::vector<SurfaceContact>& contacts,
                    std::vector<Vec<3>>& impulse, StateVisitor& visit);

}  // namespace softgrain
