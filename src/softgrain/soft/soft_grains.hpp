#pragma once
#include <array>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "softgrain/core/shared_loop.hpp"
#include "softgrain/geometry/wall.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/math/wide.hpp"
#include "softgrain/soft/solid_topology.hpp"
#include "softgrain/soft/topology.hpp"

namespace softgrain {

template <int Dim>
using WidePlaces = std::vector<Vec<Dim, Wide>>;
using WideVectors = WidePlaces<2>;

/// What grains of one shape share, in the plane or in space.
template <int Dim>
using TopologyOf = std::conditional_t<Dim == 2, Topology, SolidTopology>;
inline double body_size(const Topology& shape) { return shape.area; }         ///< [R^2]
inline double body_size(const SolidTopology& shape) { return shape.volume; }  ///< [R^3]

/// R^Dim.
template <int Dim, class T>
T body_unit(const T& R) {
  if constexpr (Dim == 2)
    return R * R;
  else
    return R * R * R;
}

/// The vector in one lane.
template <int N>
Vec<N> lane_of(const Vec<N, Wide>& v, int lane) {
  Vec<N> of_lane;
  for (int d = 0; d < N; ++d) of_lane[d] = v[d][lane];
  return of_lane;
}

/// What the grains of a kind are made of.
struct GrainMaterial {
  AnyLaw law;
  double density = 0;  ///< rho [kg/m^3]
  bool rigid = false;  ///< they do not deform, and have no law
  /// In space: whether U' is taken at the mean J of a cell, against locking; in the plane it always is.
  bool mean_dilatation = false;
};

/// Eight grains of one topology and one kind, one in each lane. Lanes without a grain repeat the first one
/// and are not read.
template <int Dim>
struct BatchOf {
  const TopologyOf<Dim>* topology = nullptr;
  int kind = 0;                           ///< of all its grains
  std::array<int, Wide::size> grain;      ///< index of the grain in each lane, -1 for none
  Wide radius = 1.0;                      ///< R [m]
  Vec<2, Wide> placed_along{{1.0, 0.0}};  ///< (cos, sin) of the angle of placement, in the plane
  WidePlaces<Dim> position;               ///< (nodes) x_i [m]
  WidePlaces<Dim> velocity;               ///< (nodes) v_i [m/s]
  /// (points) what each remembers of its flow, as the law's State has it; empty where the law has none
  std::vector<Wide> history = {};
  /// First grain among the lanes whose bits are set, -1 if none holds a grain.
  int grain_in(unsigned lanes) const {
    for (int lane = 0; lane < Wide::size; ++lane)
      if ((lanes >> lane & 1u) != 0 && grain[lane] >= 0) return grain[lane];
    return -1;
  }
};
using GrainBatch = BatchOf<2>;

/// How a reference grid is turned: by an angle [rad], in space by a rotation.
template <int Dim>
using TurnOf = std::conditional_t<Dim == 2, double, Mat<3>>;
template <int Dim>
inline constexpr TurnOf<Dim> no_turn{};
template <>
inline constexpr Mat<3> no_turn<3> = identity<3>();

/// One grain as it is placed: a shape, its size, and where it lies.
template <int Dim>
struct PlacementOf {
  std::shared_ptr<const TopologyOf<Dim>> topology;
  double radius = 1e-3;              ///< R [m], the unit of the topology
  Vec<Dim> centre;                   ///< [m]
  TurnOf<Dim> angle = no_turn<Dim>;  ///< of the reference grid
  Vec<Dim> velocity;                 ///< [m/s]
  int kind = 0;
};
using GrainPlacement = PlacementOf<2>;

/// Soft grains by total-Lagrangian MPM: each has its own grid and velocity field; they meet only through
/// contact. In the plane per metre of depth, plane strain. Rigid ones among them have an outline and no cells
/// (rigid_motion.hpp).
template <int Dim>
class GrainsOf {
 public:
  using Batch = BatchOf<Dim>;

  /// materials: by kind. Grains of one topology and kind share batches. Raises UsageError for radii or
  /// densities not positive, and for a rigid grain of a kind that is not.
  GrainsOf(std::vector<PlacementOf<Dim>> grains, std::vector<GrainMaterial> materials);
  /// Of one kind; density rho [kg/m^3].
  GrainsOf(std::vector<PlacementOf<Dim>> grains, AnyLaw law, double density)
      : GrainsOf(std::move(grains), {GrainMaterial{law, density}}) {}

  int size() const { return static_cast<int>(radius_.size()); }
  double radius(int grain) const { return radius_[grain]; }
  /// Of the disk of the grain's undeformed area [m]: R of a disk; of a ball its R.
  double radius_of_area(int grain) const;
  int kinds() const { return static_cast<int>(materials_.size()); }
  int kind(int grain) const { return batches[place_[grain].batch].kind; }
  const GrainMaterial& material(int kind) const { return materials_[kind]; }
  const AnyLaw& law(const Batch& batch) const { return materials_[batch.kind].law; }
  double density(const Batch& batch) const { return materials_[batch.kind].density; }
  /// Of all grains together, undeformed [kg/m^3].
  double mean_density() const;
  bool has_rigid() const;  ///< is a kind rigid?
  /// Does a kind flow, creep or relax?
  bool has_history() const;
  /// The fastest of all kinds: of pressure waves in the unstrained material [m/s]; 0 if all are rigid.
  double fastest_wave() const;
  /// rho c^2 of the stiffest kind [Pa]; 0 if all are rigid.
  double largest_wave_modulus() const;
  /// rho pi R^2 for a disk [kg/m], 4/3 rho pi R^3 for a ball [kg].
  double mass(int grain) const;
  const TopologyOf<Dim>& topology(int grain) const { return *shapes_[grain]; }
  /// Mass of node i of the grains of a batch [kg/m in the plane].
  Wide node_mass(const Batch& batch, int node) const {
    return density(batch) * batch.topology->node_volume[node] * body_unit<Dim>(batch.radius);
  }

  /// Outline vertices of all grains, one after the other, counter-clockwise.
  int outline_begin(int grain) const { return outline_begin_[grain]; }
  int outline_end(int grain) const { return outline_begin_[grain + 1]; }
  int outline_size() const { return outline_begin_.back(); }
  int grain_of_vertex(int vertex) const { return grain_of_vertex_[vertex]; }
  /// The vertices before and after it on its outline.
  std::array<int, 2> beside(int vertex) const;
  /// visit(vertex, node, lane) for all outline vertices of the grains of a batch.
  template <class Visit>
  void for_each_vertex(const Batch& batch, Visit&& visit) const {
    const auto& grid = batch.topology->grid;
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      for (int i = grid.outline_begin, v = outline_begin_[batch.grain[lane]]; i < grid.nodes(); ++i, ++v)
        visit(v, i, lane);
  }
  /// x of all outline vertices [m], from the batches.
  template <class Place>
  void gather_outline(std::vector<Place>& position) const {
    position.resize(outline_size());
    for (const Batch& batch : batches)
      for_each_vertex(batch, [&](int v, int i, int lane) { position[v] = lane_of(batch.position[i], lane); });
  }
  /// Values of vertices (force, increment) added to the nodes of a batch.
  void scatter_outline(std::span<const Vec<Dim>> value, const Batch& batch, WidePlaces<Dim>& nodes) const;

  /// The batch and lane of a grain.
  int batch_number(int grain) const { return place_[grain].batch; }
  std::pair<const Batch*, int> batch_of(int grain) const {
    return {&batches[place_[grain].batch], place_[grain].lane};
  }
  Vec<Dim> node_position(int grain, int node) const;
  Vec<Dim> momentum() const;       ///< sum_i m_i v_i [kg m/s per m]
  double kinetic_energy() const;   ///< sum_i 1/2 m_i v_i^2 [J/m]
  double undeformed_area() const;  ///< of all grains [m^2], in space their volume [m^3]
  /// First grain that moves by more than half its radius in dt (root mean square of its nodes), or not by a
  /// number; -1 if none does. further: (grains) of each, by how much more it may; empty: none.
  int runaway_grain(double dt, std::span<const double> further = {}) const;

  /// On all ranks at once: the first one gets positions, velocities and history of all batches from the ranks
  /// that have them (ModelOf::gather); all get positions and velocities.
  void gather();
  void know_all();

  std::vector<Batch> batches;
  Shares shares;  ///< of batches: on which rank each is worked on

 private:
  static constexpr double largest_motion = 0.5;

  struct Place {
    int batch = 0, lane = 0;
  };
  std::vector<GrainMaterial> materials_;
  std::vector<std::shared_ptr<const TopologyOf<Dim>>> shapes_;  // of each grain
  std::vector<double> radius_;
  std::vector<Place> place_;
  std::vector<int> outline_begin_, grain_of_vertex_;
};
using SoftGrains = GrainsOf<2>;

template <>
double SoftGrains::radius_of_area(int grain) const;
template <>
double GrainsOf<3>::radius_of_area(int grain) const;
template <>
std::array<int, 2> SoftGrains::beside(int vertex) const;

/// Centre of mass of the grains of a batch at x [m].
template <int Dim>
Vec<Dim, Wide> centre_of_mass(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch,
                              const WidePlaces<Dim>& x) {
  Wide mass = 0.0;
  Vec<Dim, Wide> first{};
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Wide m = grains.node_mass(batch, i);
    mass += m;
    first += m * x[i];
  }
  return (1.0 / mass) * first;
}

/// L x_c of each grain of a batch, x_c its centre of mass [m/s]; 0 in lanes without a grain.
template <int Dim>
Vec<Dim, Wide> affine_velocity(const GrainsOf<Dim>& grains, const BatchOf<Dim>& batch, const Mat<Dim>& L);

/// Each grain as a whole gets the velocity L x_c more. Returns by how much the kinetic energy grew [J/m].
template <int Dim>
double add_affine_velocity(GrainsOf<Dim>& grains, const Mat<Dim>& L);

}  // namespace softgrain
