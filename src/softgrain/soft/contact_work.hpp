#pragma once
#include <span>
#include <vector>

#include "softgrain/model/soft_step_report.hpp"
#include "softgrain/model/work_budget.hpp"
#include "softgrain/soft/contact_of.hpp"

namespace softgrain {

/// Adds what contacts did in a step that moved the outlines from state.start to state.position: the work that
/// they took, -sum of p . u and of it the share of friction, the work of the walls and of the cell, and each
/// wall's impulse, from the grains on it [N s/m in the plane].
template <int Dim>
void add_contact_work(Contacts<Dim> contacts, Impulses<Dim> impulse, const OutlineStateOf<Dim>& state,
                      WorkBudget& work, std::type_identity_t<std::span<Vec<Dim>>> wall_impulse);

}  // namespace softgrain
