#include "live_simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <variant>

#include "softgrain/experiment/create.hpp"
#include "softgrain/observe/columns.hpp"
#include "softgrain/observe/outlines.hpp"
#include "softgrain/observe/stress.hpp"

namespace softgrain {
namespace {

/// A motion by hand ends with the page [s].
constexpr double without_end = 1e6;

void add(std::vector<float>& list, std::initializer_list<double> values) {
  for (const double value : values) list.push_back(static_cast<float>(value));
}

/// Of each grain [m^2].
std::vector<double> areas_of(const Outlines& outlines) {
  std::vector<double> areas;
  for (std::size_t g = 0; g + 1 < outlines.begin.size(); ++g) {
    const auto vertex = outlines.vertex.begin();
    const std::vector<Vec<2>> own(vertex + outlines.begin[g], vertex + outlines.begin[g + 1]);
    areas.push_back(total_area(own, std::array{0, static_cast<int>(own.size())}));
  }
  return areas;
}

}  // namespace

const std::vector<std::string>& live_numbers() {
  static const std::vector<std::string> names{"step",  "time", "strain", "wall_height", "width",
                                              "phi_0", "phi",  "z",      "stress_top",  "kinetic_energy"};
  return names;
}

LiveSimulation::LiveSimulation(const Case& c)
    : simulation_(create_simulation(c)),
      speed_(c.loading.wall_velocity),
      start_height_(simulation_->box().height()),
      goal_(start_height_) {
  simulation_->follow({.duration = without_end, .velocity = [this](double) { return wall_velocity(); }});
  if (c.experiment.model != GrainModel::bpm) return;
  const Scene scene = simulation_->scene();
  for (const double radius : std::get<std::vector<double>>(scene.particles.at("radius").values))
    primary_radius_.push_back(static_cast<float>(radius));
}

/// Of the distance to the bottom [m/s]: full speed but for the last step to the goal.
double LiveSimulation::wall_velocity() const {
  const double dt = simulation_->time_step(), way = goal_ - simulation_->box().height();
  return std::abs(way) < speed_ * dt ? way / dt : std::copysign(speed_, way);
}

void LiveSimulation::step() { simulation_->step(); }

const LivePicture& LiveSimulation::picture() {
  picture_ = {};
  const Outlines outlines = simulation_->model().outlines();
  if (primary_radius_.empty())
    for (const Vec<2>& x : outlines.vertex) add(picture_.outline, {x[0], x[1]});
  else
    draw_primaries();
  picture_.outline_begin = outlines.begin;
  draw_contacts(outlines);
  const std::vector<Quantity> row = row_of(simulation_->observe());
  simulation_->begin_row();
  for (const std::string& name : live_numbers()) {
    const auto quantity =
        std::find_if(row.begin(), row.end(), [&](const Quantity& q) { return q.name == name; });
    picture_.numbers.push_back(quantity == row.end() ? std::nan("") : quantity->value);
  }
  return picture_;
}

void LiveSimulation::draw_primaries() {
  std::size_t i = 0;
  double number = 0;
  for (const GrainView& grain : simulation_->grains()) {
    const VectorView& x = grain.position;
    for (std::size_t k = 0; k < x.rows; ++k) {
      const double* at = x.begin + k * x.row;
      add(picture_.disks, {at[0], at[x.component], primary_radius_[i++], number});
    }
    ++number;
  }
}

void LiveSimulation::draw_contacts(const Outlines& outlines) {
  const std::vector<Vec<2>> centre = simulation_->model().centres();
  const std::vector<ContactPoint> contacts = simulation_->model().contacts();
  const auto grains = centre.size();
  std::vector<BranchForce> forces;
  for (const ContactPoint& c : contacts) {
    const Vec<2> from_b = c.b < 0 ? Vec<2>{} : c.position - centre[static_cast<std::size_t>(c.b)];
    forces.push_back(
        {c.a, std::max(c.b, -1), c.force, c.position - centre[static_cast<std::size_t>(c.a)], from_b});
  }
  for (const double pressure : virial_pressure(forces, areas_of(outlines)))
    add(picture_.pressure, {pressure});
  const ContactNetwork network = contact_network(contacts, static_cast<int>(grains));
  for (const auto* pairs : {&network.pairs, &network.walls})
    for (const GrainPair& pair : *pairs)
      for (const int body : {pair.a, pair.b}) {
        if (body < 0) continue;
        const Vec<2>& x = centre[static_cast<std::size_t>(body)];
        add(picture_.chains, {x[0], x[1], pair.position[0], pair.position[1], pair.normal_force});
      }
}

}  // namespace softgrain
