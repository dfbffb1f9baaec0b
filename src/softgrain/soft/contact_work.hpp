#pragma once
#include <span>
#include <vector>

#include "softgrain/model/soft_step_report.hpp"
#include "softgrain/model/work_budget.hpp"
#include "softgrain/soft/outline_contacts.hpp"

namespace softgrain {

/// Adds what contacts did in a step that moved the outlines from state.start to state.position: the work that
/// they took, -sum of p . u and of it the share of friction, the work of the walls and of the cell, and each
/// wall's impulse, from the grains on it [N s/m].
void add_contact_work(std::span<const OutlineContact> contacts, std::span<const Vec<2>> impulse,
                      const OutlineState& state, WorkBudget& work, std::span<Vec<2>> wall_impulse);

}  // namespace softgrain
