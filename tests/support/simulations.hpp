#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/lattice/lattice_grains.hpp"
#include "softgrain/observe/columns.hpp"
#include "softgrain/soft/elastic_grains.hpp"

namespace softgrain::test {

inline double value_of(const std::vector<Quantity>& row, std::string_view name) {
  const auto found = std::ranges::find(row, name, &Quantity::name);
  REQUIRE(found != row.end());
  return found->value;
}

inline Simulation simulation_of(const Case& the_case) { return std::move(*create_simulation(the_case)); }

/// What moves the grains of a simulation. Raises std::bad_cast for another model.
inline const RigidDynamics<2>& bonded(const Simulation& simulation) {
  return dynamic_cast<const BondedGrains&>(simulation.model()).dynamics();
}
template <class Dynamics>
const Dynamics& elastic(const Simulation& simulation) {
  return dynamic_cast<const ElasticGrains<Dynamics>&>(simulation.model()).dynamics();
}
inline const UpdatedLagrangianDynamics& lattice(const Simulation& simulation) {
  return dynamic_cast<const LatticeGrains&>(simulation.model()).dynamics();
}

/// The row now; the next one begins.
inline std::vector<Quantity> next_row(Simulation& simulation) {
  std::vector<Quantity> row = row_of(simulation.observe());
  simulation.begin_row();
  return row;
}

inline void advance(Simulation& simulation, std::int64_t steps) {
  while (steps-- > 0 && !simulation.finished()) simulation.step();
}

}  // namespace softgrain::test
