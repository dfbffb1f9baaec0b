#include "softgrain/model/work_budget.hpp"

#include <string_view>

namespace softgrain {

Energies energies_of(const WorkBudget& work, double kinetic, double elastic) {
  return {.kinetic = kinetic,
          .stored = elastic,
          .wall_work = work.walls,
          .dissipation =
              (work.contacts - work.adhesion) + (work.internal + work.inertia - elastic) + work.damping,
          .contact = work.contacts - work.adhesion,
          .friction = work.friction,
          .error = work.walls + work.gravity - kinetic - work.internal - work.inertia - work.contacts -
                   work.damping};
}

Numbers elastic_numbers(const WorkBudget& work, double elastic) {
  return {{"elastic_energy", elastic},
          {"dissipation_integration", work.internal + work.inertia - elastic - work.flow},
          {"dissipation_damping", work.damping}};
}

void visit_work(WorkBudget& work, StateVisitor& visit) {
  const auto declare = [&](const char* name, std::string_view text, double& value) {
    visit({name, "J/m", Owner::run, Role::sum, text}, value);
  };
  declare("work_of_walls", "done by the walls", work.walls);
  declare("work_of_gravity", "done by gravity", work.gravity);
  declare("work_internal", "of the internal forces", work.internal);
  declare("work_in_contacts", "taken by contacts", work.contacts);
  declare("work_of_friction", "of it by sliding", work.friction);
  declare("work_of_inertia", "taken by backward Euler", work.inertia);
  declare("work_of_damping", "taken by damping", work.damping);
}

}  // namespace softgrain
