#include "softgrain/experiment/create.hpp"

#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/stages_of_case.hpp"

namespace softgrain {

std::unique_ptr<Simulation> create_simulation(const Case& c) {
  check_loading(c);
  PlacedModel placed = is_bonded(c) ? bonded_grains_of(c) : elastic_grains_of(c);
  Loading loading(stages_of(c), frame_of(c), placed.box);
  return std::make_unique<Simulation>(std::move(placed.model), std::move(placed.box), std::move(loading),
                                      placed.time_step);
}

}  // namespace softgrain
