#include "softgrain/soft/soft_grains.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/soft/history.hpp"

namespace softgrain {
namespace {

Mat<2> rotation_by(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c, -s, s, c}};
}
Mat<3> rotation_by(const Mat<3>& Q) { return Q; }

}  // namespace

template <int Dim>
GrainsOf<Dim>::GrainsOf(std::vector<PlacementOf<Dim>> grains, std::vector<GrainMaterial> materials)
    : materials_(std::move(materials)) {
  for (const GrainMaterial& material : materials_)
    require(material.density > 0, "the density must be > 0, got {} kg/m^3", material.density);
  place_.resize(grains.size());
  batches.reserve(grains.size() / Wide::size + materials_.size());  // a vector that grows copies them
  outline_begin_.push_back(0);
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    const PlacementOf<Dim>& placed = grains[g];
    require(placed.radius > 0, "grain {}: the radius must be > 0, got {} m", g, placed.radius);
    require(placed.kind >= 0 && placed.kind < kinds(), "grain {}: there is no kind {}", g, placed.kind);
    require(placed.topology->rigid() == materials_[placed.kind].rigid,
            "grain {}: its kind {} is {}rigid, its shape is not so", g, placed.kind,
            materials_[placed.kind].rigid ? "" : "not ");
    shapes_.push_back(placed.topology);
    radius_.push_back(placed.radius);
    const int vertices = placed.topology->grid.outline_nodes();
    outline_begin_.push_back(outline_begin_.back() + vertices);
    grain_of_vertex_.insert(grain_of_vertex_.end(), vertices, g);

    // the next free lane of a batch of this shape and kind
    int b = static_cast<int>(batches.size()) - 1;
    while (b >= 0 && !(batches[b].topology == placed.topology.get() && batches[b].kind == placed.kind &&
                       batches[b].grain.back() < 0))
      --b;
    if (b < 0) {
      b = static_cast<int>(batches.size());
      batches.push_back({.topology = placed.topology.get(),
                         .kind = placed.kind,
                         .grain = {},
                         .position = {},
                         .velocity = {}});
      batches[b].grain.fill(-1);
      batches[b].position.resize(placed.topology->grid.nodes());
      batches[b].velocity.resize(placed.topology->grid.nodes());
      batches[b].history = undeformed_history<Dim>(law(batches[b]), placed.topology->points.size());
    }
    Batch& batch = batches[b];
    int lane = 0;
    while (batch.grain[lane] >= 0) ++lane;
    batch.grain[lane] = g;
    place_[g] = {b, lane};
    const Mat<Dim> Q = rotation_by(placed.angle);
    for (int free = lane; free < Wide::size; ++free) {  // the lanes without a grain repeat the last one
      batch.radius.set(free, placed.radius);
      for (int d = 0; d < 2; ++d) batch.placed_along[d].set(free, Q(d, 0));
      for (int i = 0; i < placed.topology->grid.nodes(); ++i) {
        const Vec<Dim> x = placed.centre + placed.radius * (Q * placed.topology->grid.node[i]);
        for (int d = 0; d < Dim; ++d) {
          batch.position[i][d].set(free, x[d]);
          batch.velocity[i][d].set(free, placed.velocity[d]);
        }
      }
    }
  }
  std::vector<double> weight;
  for (const Batch& batch : batches) weight.push_back(static_cast<double>(batch.topology->points.size()));
  shares = Shares(weight);
}

template <int Dim>
void GrainsOf<Dim>::gather() {
  collect(
      shares, static_cast<int>(batches.size()), [](int b) { return b; },
      [&](int b, Message& message) {
        message(batches[b].position), message(batches[b].velocity), message(batches[b].history);
      });
}

template <int Dim>
void GrainsOf<Dim>::know_all() {
  if (shares.alone()) return;
  shared_for(
      shares, static_cast<int>(batches.size()), [](int) {},
      [&](int b, Message& message) { message(batches[b].position), message(batches[b].velocity); });
}

template <int Dim>
double GrainsOf<Dim>::mean_density() const {
  if (kinds() == 1) return materials_.front().density;  // to the last digit
  double mass_of_all = 0;
  for (int g = 0; g < size(); ++g) mass_of_all += mass(g);
  return mass_of_all / undeformed_area();
}

template <int Dim>
bool GrainsOf<Dim>::has_rigid() const {
  return std::any_of(materials_.begin(), materials_.end(),
                     [](const GrainMaterial& material) { return material.rigid; });
}

template <int Dim>
bool GrainsOf<Dim>::has_history() const {
  return std::any_of(materials_.begin(), materials_.end(),
                     [](const GrainMaterial& material) { return softgrain::has_history(material.law); });
}

template <int Dim>
double GrainsOf<Dim>::fastest_wave() const {
  double fastest = 0;
  for (const GrainMaterial& material : materials_)
    if (!material.rigid) fastest = std::max(fastest, wave_speed(material.law, material.density));
  return fastest;
}

template <int Dim>
double GrainsOf<Dim>::largest_wave_modulus() const {
  double largest = 0;
  for (const GrainMaterial& material : materials_) {
    if (material.rigid) continue;
    const double wave = wave_speed(material.law, material.density);
    largest = std::max(largest, material.density * wave * wave);
  }
  return largest;
}

template <int Dim>
double GrainsOf<Dim>::mass(int grain) const {
  return materials_[kind(grain)].density * body_size(*shapes_[grain]) * radius_[grain] * radius_[grain] *
         (Dim == 3 ? radius_[grain] : 1);
}

template <>
double SoftGrains::radius_of_area(int grain) const {
  const Topology& shape = topology(grain);
  return shape.round ? radius(grain) : radius(grain) * std::sqrt(shape.area / std::numbers::pi);
}

template <>
double GrainsOf<3>::radius_of_area(int grain) const {
  const SolidTopology& shape = topology(grain);
  return shape.rigid_shape() ? radius(grain) * std::cbrt(shape.volume / (4 * std::numbers::pi / 3))
                             : radius(grain);
}

template <>
std::array<int, 2> SoftGrains::beside(int vertex) const {
  const int grain = grain_of_vertex(vertex), begin = outline_begin(grain), end = outline_end(grain);
  return {vertex > begin ? vertex - 1 : end - 1, vertex + 1 < end ? vertex + 1 : begin};
}

template <int Dim>
void GrainsOf<Dim>::scatter_outline(std::span<const Vec<Dim>> value, const Batch& batch,
                                    WidePlaces<Dim>& nodes) const {
  for_each_vertex(batch, [&](int v, int i, int lane) {
    for (int d = 0; d < Dim; ++d) nodes[i][d].set(lane, nodes[i][d][lane] + value[v][d]);
  });
}

template <int Dim>
Vec<Dim> GrainsOf<Dim>::node_position(int grain, int node) const {
  const Batch& batch = batches[place_[grain].batch];
  const int lane = place_[grain].lane;
  return lane_of(batch.position[node], lane);
}

template <int Dim>
Vec<Dim> GrainsOf<Dim>::momentum() const {
  Vec<Dim> sum;
  for (const Batch& batch : batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
        for (int d = 0; d < Dim; ++d) sum[d] += (node_mass(batch, i) * batch.velocity[i][d])[lane];
  return sum;
}

template <int Dim>
double GrainsOf<Dim>::kinetic_energy() const {
  double sum = 0;
  for (const Batch& batch : batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide energy = 0.5 * node_mass(batch, i) * dot(batch.velocity[i], batch.velocity[i]);
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) sum += energy[lane];
    }
  return sum;
}

template <int Dim>
double GrainsOf<Dim>::undeformed_area() const {
  double sum = 0;
  for (int g = 0; g < size(); ++g) sum += mass(g) / materials_[kind(g)].density;
  return sum;
}

template <int Dim>
int GrainsOf<Dim>::runaway_grain(double dt, std::span<const double> further) const {
  std::vector<int> runaway(batches.size(), -1);
  const auto look = [&](int b) {
    const Batch& batch = batches[b];
    Wide sum = 0.0;
    for (const Vec<Dim, Wide>& v : batch.velocity) sum += dot(v, v);
    const double nodes = static_cast<double>(batch.velocity.size());
    for (int lane = Wide::size - 1; lane >= 0; --lane) {
      const int grain = batch.grain[lane];
      if (grain < 0) continue;
      const double most = largest_motion * batch.radius[lane] * (further.empty() ? 1 : further[grain]);
      if (!(dt * std::sqrt(sum[lane] / nodes) < most)) runaway[b] = grain;
    }
  };
  shared_for(shares, static_cast<int>(batches.size()), look,
             [&](int b, Message& message) { message(runaway[b]); });
  for (const int grain : runaway)
    if (grain >= 0) return grain;
  return -1;
}

template <int Dim>
Vec<Dim, Wide> affine_velocity(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch, const Mat<Dim>& L) {
  const Vec<Dim, Wide> x = centre_of_mass(grains, batch, batch.position);
  Vec<Dim, Wide> v;
  for (int d = 0; d < Dim; ++d) {
    v[d] = L(d, 0) * x[0];
    for (int k = 1; k < Dim; ++k) v[d] = v[d] + L(d, k) * x[k];
  }
  for (int lane = 0; lane < Wide::size; ++lane)
    if (batch.grain[lane] < 0)
      for (int d = 0; d < Dim; ++d) v[d].set(lane, 0);
  return v;
}

template <int Dim>
double add_affine_velocity(GrainsOf<Dim>& grains, const Mat<Dim>& L) {
  const double before = grains.kinetic_energy();
  for (BatchOf<Dim>& batch : grains.batches) {
    const Vec<Dim, Wide> more = affine_velocity(grains, batch, L);
    for (Vec<Dim, Wide>& v : batch.velocity) v += more;
  }
  return grains.kinetic_energy() - before;
}

template Vec<2, Wide> affine_velocity(const GrainsOf<2>&, const BatchOf<2>&, const Mat<2>&);
template Vec<3, Wide> affine_velocity(const GrainsOf<3>&, const BatchOf<3>&, const Mat<3>&);
template double add_affine_velocity(GrainsOf<2>&, const Mat<2>&);
template double add_affine_velocity(GrainsOf<3>&, const Mat<3>&);

template class GrainsOf<2>;
template class GrainsOf<3>;

}  // namespace softgrain
