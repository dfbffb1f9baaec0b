#pragma once
#include <utility>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/experiment/create.hpp"

namespace softgrain::bench {

inline Simulation simulation_of(const Case& the_case) { return std::move(*create_simulation(the_case)); }

/// What moves the primaries of a simulation of bonded grains.
inline const RigidDynamics<2>& bonded(const Simulation& simulation) {
  return dynamic_cast<const BondedGrains&>(simulation.model()).dynamics();
}

}  // namespace softgrain::bench
