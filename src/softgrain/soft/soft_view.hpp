#pragma once
#include <span>
#include <vector>

#include "softgrain/model/grain_contacts.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/model/work_budget.hpp"
#include "softgrain/soft/outline_contacts.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// Soft grains and their contacts as both integrators hold them.
struct SoftView {
  const SoftGrains& grains;
  std::span<const OutlineContact> contacts;
  std::span<const Vec<2>> impulse;  ///< impulses of `contacts`, (p_n, p_t) [N s/m]
  double impulse_time = 0;          ///< time over which the impulses acted [s]
};

/// Contacts that carry impulse. A vertex takes half of the segments beside it, and half of that where the
/// other grain's vertices touch too.
std::vector<ContactPoint> contact_points(const SoftView& view);

/// Of all grains; their area is pi R^2 times the mean J of a disk, by the polygons of the vertices (theory
/// (54)).
Outlines outlines_of(const SoftGrains& grains);

/// Nodes of all grains.
Bodies nodes_of(const SoftGrains& grains);
std::vector<Vec<2>> centres_of(const SoftGrains& grains);  ///< of mass [m]

/// sum of psi over all points [J/m], and the least det F of all.
double stored_energy(const SoftGrains& grains);
double least_J(const SoftGrains& grains);

/// Material points as disks of their present area, the outlines with the contact forces on their vertices,
/// and the contacts of grains.
Scene soft_scene(const SoftView& view);

/// The nodes of each grain in its lane.
std::vector<GrainView> grain_views(const SoftGrains& grains);

/// Declares positions and velocities of all nodes, and the history of the points, eight grains to a row.
void visit_nodes(SoftGrains& grains, StateVisitor& visit);

/// Declares the contacts and their impulses; with their images if a cell repeats. Raises IoError for vertices
/// and walls that are not there.
void visit_contacts(const SoftGrains& grains, int walls, bool repeats, std::vector<OutlineContact>& contacts,
                    std::vector<Vec<2>>& impulse, StateVisitor& visit);

}  // namespace softgrain
