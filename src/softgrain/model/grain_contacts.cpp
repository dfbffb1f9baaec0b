#include "softgrain/model/grain_contacts.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace softgrain {

namespace {

template <int Dim>
Arrays contacts_of_grains(std::span<const ContactPointOf<Dim>> points, int grains) {
  const ContactNetworkOf<Dim> network = contact_network(points, grains);
  std::vector<std::int64_t> pair;
  std::vector<double> force;
  std::vector<Vec<Dim>> total_force, normal, position;
  for (const auto* list : {&network.pairs, &network.walls})
    for (const auto& p : *list) {
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

}  // namespace

Arrays grain_contacts(std::span<const ContactPointOf<2>> points, int grains) {
  return contacts_of_grains(points, grains);
}
Arrays grain_contacts(std::span<const ContactPointOf<3>> points, int grains) {
  return contacts_of_grains(points, grains);
}

}  // namespace softgrain
