#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "softgrain/experiment/simulation.hpp"
#include "softgrain/mpm/outline_contacts.hpp"
#include "softgrain/mpm/soft_grains.hpp"
#include "softgrain/mpm/soft_step_report.hpp"
#include "softgrain/observe/contact_network.hpp"

namespace softgrain {

/// Soft grains between walls as both integrators hold them.
struct SoftView {
  const SoftGrains& grains;
  std::span<const Wall<2>> walls;  ///< bottom, top and, in a box, left, right
  std::span<const OutlineContact> contacts;
  std::span<const Vec<2>> impulse;  ///< theirs (p_n, p_t) [N s/m] ...
  double impulse_time = 0;          ///< ... over this time [s]
};

/// (grains + 1) first outline vertex of each grain.
std::vector<int> outline_begins(const SoftGrains& grains);

/// sum of A_g [m^2]: pi R^2 times the mean J of a disk, by the polygons of the vertices (theory (54)).
double grain_area(const SoftGrains& grains);

/// Contacts that carry impulse. A vertex takes half of the segments beside it, and half of that where the
/// other grain's vertices touch too.
std::vector<ContactPoint> contact_points(const SoftView& view);

/// The columns of energy and what dissipates it [J/m], from what the work of a run was spent on.
std::vector<Quantity> soft_energies(const WorkBudget& work, double kinetic, double elastic);

/// What a box of soft grains shows (packing_row), at a strain rate [1/s].
std::vector<Quantity> soft_packing_row(const SoftView& view, double strain_rate);

/// Contacts of a scene from their points: `pair` of grains, walls from `grains` on, `force` f_n [N/m], the
/// `total_force` of the first on the second [N/m], `normal` from the first to the second, `position` [m].
/// Pairs of grains first.
std::map<std::string, Array> grain_contacts(std::span<const ContactPoint> points, int grains);

/// Material points as disks of their present area, the outlines with the contact forces on their vertices,
/// the contacts of grains and the walls.
Scene soft_scene(const SoftView& view);

/// The nodes of each grain in its lane.
std::vector<GrainView> grain_views(const SoftGrains& grains);

}  // namespace softgrain
