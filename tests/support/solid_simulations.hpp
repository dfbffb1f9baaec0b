#pragma once
#include <memory>
#include <utility>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/experiment/stages_of_case.hpp"

namespace softgrain::test {

/// Coarse elastic spheres without friction in a box.
inline Case case_in_space(LoadingPath path) {
  Case c;
  c.experiment = {.loading = path, .model = GrainModel::mpm, .dimension = 3};
  c.mpm.integrator = Integrator::symplectic_euler;
  c.mpm.cells = 2;
  c.loading.wall_velocity = 1;
  c.output.report = false;
  return c;
}

/// Of a case in space.
inline SimulationOf<3> solid_simulation_of(const Case& c) {
  const std::unique_ptr<AnySimulation> any = create_any_simulation(c);
  return std::move(dynamic_cast<SimulationOf<3>&>(*any));
}

}  // namespace softgrain::test
