#include "softgrain/model/grain_contacts.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace softgrain {

Arrays grain_contacts(std::span<const ContactPoint> points, int grains) {
  const ContactNetwork network = contact_network(points, grains);
  std::vector<std::int64_t> pair;
  std::vector<double> force;
  std::vector<Vec<2>> total_force, normal, position;
  for (const auto* list : {&network.pairs, &network.walls})
    for (const GrainPair& p : *list) {
      pair.insert(pair.end(), {p.a, p.b >= 0 ? p.b : grains + wall_index(p.b)});  // its own inverse
      force.push_back(p.normal_force);
      total_force.push_back(p.force);
      normal.push_back(p.normal);
      position.push_back(p.position);
    }
  return {{"pair", {2, std::move(pair)}},
          {"force", {1, std::move(force)}},
          {"total_force", to_array(total_force)},
          {"normal", to_array(normal)},
          {"position", to_array(position)}};
}

}  // namespace softgrain
