#include "softgrain/soft/soft_grains.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/history.hpp"

namespace softgrain {

SoftGrains::SoftGrains(std::vector<GrainPlacement> grains, std::vector<GrainMaterial> materials)
    : materials_(std::move(materials)) {
  for (const GrainMaterial& material : materials_)
    require(material.density > 0, "the density must be > 0, got {} kg/m^3", material.density);
  place_.resize(grains.size());
  outline_begin_.push_back(0);
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    const GrainPlacement& placed = grains[g];
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
      batches[b].history = undeformed_history(law(batches[b]), *placed.topology);
    }
    GrainBatch& batch = batches[b];
    int lane = 0;
    while (batch.grain[lane] >= 0) ++lane;
    batch.grain[lane] = g;
    place_[g] = {b, lane};
    const double c = std::cos(placed.angle), s = std::sin(placed.angle);
    for (int free = lane; free < Wide::size; ++free) {  // the lanes without a grain repeat the last one
      batch.radius.set(free, placed.radius);
      batch.placed_along[0].set(free, c);
      batch.placed_along[1].set(free, s);
      for (int i = 0; i < placed.topology->grid.nodes(); ++i) {
        const Vec<2>& X = placed.topology->grid.node[i];
        const Vec<2> x = placed.centre + placed.radius * Vec<2>{c * X[0] - s * X[1], s * X[0] + c * X[1]};
        for (int d = 0; d < 2; ++d) {
          batch.position[i][d].set(free, x[d]);
          batch.velocity[i][d].set(free, placed.velocity[d]);
        }
      }
    }
  }
}

double SoftGrains::mean_density() const {
  if (kinds() == 1) return materials_.front().density;  // to the last digit
  double mass_of_all = 0;
  for (int g = 0; g < size(); ++g) mass_of_all += mass(g);
  return mass_of_all / undeformed_area();
}

bool SoftGrains::has_rigid() const {
  return std::any_of(materials_.begin(), materials_.end(),
                     [](const GrainMaterial& material) { return material.rigid; });
}

bool SoftGrains::has_history() const {
  return std::any_of(materials_.begin(), materials_.end(),
                     [](const GrainMaterial& material) { return softgrain::has_history(material.law); });
}

double SoftGrains::fastest_wave() const {
  double fastest = 0;
  for (const GrainMaterial& material : materials_)
    if (!material.rigid) fastest = std::max(fastest, wave_speed(material.law, material.density));
  return fastest;
}

double SoftGrains::largest_wave_modulus() const {
  double largest = 0;
  for (const GrainMaterial& material : materials_) {
    if (material.rigid) continue;
    const double wave = wave_speed(material.law, material.density);
    largest = std::max(largest, material.density * wave * wave);
  }
  return largest;
}

double SoftGrains::radius_of_area(int grain) const {
  const Topology& shape = topology(grain);
  return shape.round ? radius(grain) : radius(grain) * std::sqrt(shape.area / std::numbers::pi);
}

double SoftGrains::mass(int grain) const {
  return materials_[kind(grain)].density * shapes_[grain]->area * radius_[grain] * radius_[grain];
}

std::array<int, 2> SoftGrains::beside(int vertex) const {
  const int grain = grain_of_vertex(vertex), begin = outline_begin(grain), end = outline_end(grain);
  return {vertex > begin ? vertex - 1 : end - 1, vertex + 1 < end ? vertex + 1 : begin};
}

void SoftGrains::gather_outline(std::vector<Vec<2>>& position) const {
  position.resize(outline_size());
  for (const GrainBatch& batch : batches)
    for_each_vertex(batch, [&](int v, int i, int lane) {
      position[v] = {batch.position[i][0][lane], batch.position[i][1][lane]};
    });
}

void SoftGrains::scatter_outline(std::span<const Vec<2>> value, const GrainBatch& batch,
                                 WideVectors& nodes) const {
  for_each_vertex(batch, [&](int v, int i, int lane) {
    for (int d = 0; d < 2; ++d) nodes[i][d].set(lane, nodes[i][d][lane] + value[v][d]);
  });
}

Vec<2> SoftGrains::node_position(int grain, int node) const {
  const GrainBatch& batch = batches[place_[grain].batch];
  const int lane = place_[grain].lane;
  return {batch.position[node][0][lane], batch.position[node][1][lane]};
}

Vec<2> SoftGrains::momentum() const {
  Vec<2> sum;
  for (const GrainBatch& batch : batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
        for (int d = 0; d < 2; ++d) sum[d] += (node_mass(batch, i) * batch.velocity[i][d])[lane];
  return sum;
}

double SoftGrains::kinetic_energy() const {
  double sum = 0;
  for (const GrainBatch& batch : batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide energy = 0.5 * node_mass(batch, i) * dot(batch.velocity[i], batch.velocity[i]);
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) sum += energy[lane];
    }
  return sum;
}

double SoftGrains::undeformed_area() const {
  double sum = 0;
  for (int g = 0; g < size(); ++g) sum += mass(g) / materials_[kind(g)].density;
  return sum;
}

int SoftGrains::runaway_grain(double dt) const {
  std::vector<int> runaway(batches.size(), -1);
  parallel_for(static_cast<int>(batches.size()), [&](int b) {
    const GrainBatch& batch = batches[b];
    Wide sum = 0.0;
    for (const Vec<2, Wide>& v : batch.velocity) sum += dot(v, v);
    const double nodes = static_cast<double>(batch.velocity.size());
    for (int lane = Wide::size - 1; lane >= 0; --lane)
      if (batch.grain[lane] >= 0 &&
          !(dt * std::sqrt(sum[lane] / nodes) < largest_motion * batch.radius[lane]))
        runaway[b] = batch.grain[lane];
  });
  for (const int grain : runaway)
    if (grain >= 0) return grain;
  return -1;
}

Vec<2, Wide> centre_of_mass(const SoftGrains& grains, const GrainBatch& batch, const WideVectors& x) {
  Wide mass = 0.0;
  Vec<2, Wide> first{};
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Wide m = grains.node_mass(batch, i);
    mass += m;
    first += m * x[i];
  }
  return (1.0 / mass) * first;
}

Vec<2, Wide> affine_velocity(const SoftGrains& grains, const GrainBatch& batch, const Mat<2>& L) {
  const Vec<2, Wide> x = centre_of_mass(grains, batch, batch.position);
  Vec<2, Wide> v{L(0, 0) * x[0] + L(0, 1) * x[1], L(1, 0) * x[0] + L(1, 1) * x[1]};
  for (int lane = 0; lane < Wide::size; ++lane)
    if (batch.grain[lane] < 0)
      for (int d = 0; d < 2; ++d) v[d].set(lane, 0);
  return v;
}

double add_affine_velocity(SoftGrains& grains, const Mat<2>& L) {
  const double before = grains.kinetic_energy();
  for (GrainBatch& batch : grains.batches) {
    const Vec<2, Wide> more = affine_velocity(grains, batch, L);
    for (Vec<2, Wide>& v : batch.velocity) v += more;
  }
  return grains.kinetic_energy() - before;
}

}  // namespace softgrain
