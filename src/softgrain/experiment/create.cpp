#include "softgrain/experiment/create.hpp"

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/stages_of_case.hpp"

namespace softgrain {
namespace {

template <int Dim>
std::unique_ptr<SimulationOf<Dim>> with_loading(const Case& c, PlacedModelOf<Dim> placed) {
  if (is_in_a_box(c) && c.box.open_top) {
    placed.box.open_top = placed.box.walls[top_wall].open = true;
    follow_surface(*placed.model, placed.box);
  }
  LoadingOf<Dim> loading(stages_of(c), frame_of(c), placed.box);
  return std::make_unique<SimulationOf<Dim>>(std::move(placed.model), std::move(placed.box),
                                             std::move(loading), placed.time_step);
}

}  // namespace

std::unique_ptr<AnySimulation> create_any_simulation(const Case& c) {
  if (!is_in_space(c)) return create_simulation(c);
  check_loading(c);
  return with_loading(c, is_bonded(c) ? bonded_grains_of<3>(c) : solid_grains_of(c));
}

std::unique_ptr<Simulation> create_simulation(const Case& c) {
  require(!is_in_space(c),
          "not yet: a simulation in memory with experiment.dimension = 3; `softgrain run` carries such a "
          "case out");
  check_loading(c);
  return with_loading(c, is_mixed(c)    ? mixed_grains_of(c)
                         : is_bonded(c) ? bonded_grains_of<2>(c)
                                        : elastic_grains_of(c));
}

}  // namespace softgrain
