#pragma once
#include <span>
#include <vector>

#include "softgrain/model/model.hpp"
#include "softgrain/mpm/outline_contacts.hpp"
#include "softgrain/mpm/soft_grains.hpp"
#include "softgrain/mpm/soft_step_report.hpp"

namespace softgrain {

/// Soft grains and their contacts as both integrators hold them.
struct SoftView {
  const SoftGrains& grains;
  std::span<const OutlineContact> contacts;
  std::span<const Vec<2>> impulse;  ///< theirs (p_n, p_t) [N s/m] ...
  double impulse_time = 0;          ///< ... over this time [s]
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

/// Energies from what the work of a run was spent on; `elastic`: stored now [J/m].
Energies energies_of(const WorkBudget& work, double kinetic, double elastic);
/// The columns that split the dissipation of elastic grains, and their energy.
Numbers elastic_numbers(const WorkBudget& work, double elastic);

/// Contacts of a scene from their points: `pair` of grains, walls from `grains` on, `force` f_n [N/m], the
/// `total_force` of the first on the second [N/m], `normal` from the first to the second, `position` [m].
/// Pairs of grains first.
Arrays grain_contacts(std::span<const ContactPoint> points, int grains);

/// Material points as disks of their present area, the outlines with the contact forces on their vertices,
/// and the contacts of grains.
Scene soft_scene(const SoftView& view);

/// The nodes of each grain in its lane.
std::vector<GrainView> grain_views(const SoftGrains& grains);

/// Declares positions and velocities of all nodes, eight grains to a row.
void visit_nodes(SoftGrains& grains, StateVisitor& visit);

/// Declares the contacts and their impulses. Raises IoError for vertices and walls that are not there.
void visit_contacts(const SoftGrains& grains, int walls, std::vector<OutlineContact>& contacts,
                    std::vector<Vec<2>>& impulse, StateVisitor& visit);

/// Declares what work was spent on.
void visit_work(WorkBudget& work, StateVisitor& visit);

}  // namespace softgrain
