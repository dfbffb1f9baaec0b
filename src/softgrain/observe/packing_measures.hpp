#pragma once
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "softgrain/math/tensor.hpp"
#include "softgrain/observe/contact_network.hpp"
#include "softgrain/observe/packing.hpp"
#include "softgrain/observe/surface_measure.hpp"

namespace softgrain {

/// A box of grains as any model shows it.
struct PackingView {
  double width = 0, height = 0;        ///< of the box [m]
  std::span<const double> radius;      ///< of the undeformed grains [m]
  double grain_area = 0;               ///< sum of A_g, of the deformed grains [m^2]
  std::span<const Vec<2>> centre;      ///< of mass, of each grain [m]
  std::span<const Vec<2>> outline;     ///< vertices of all grains, each counter-clockwise [m]
  std::span<const int> outline_begin;  ///< (grains + 1) first vertex of each grain
  std::span<const ContactPoint> contacts;
  std::span<const double> mass;      ///< of the bodies that move: primaries, nodes or points [kg/m]
  std::span<const Vec<2>> velocity;  ///< of the same bodies [m/s]
  double density = 0;                ///< of the grains [kg/m^3]
  double strain_rate = 0;            ///< [1/s]
};

/// Numbers by the names of their columns.
using Numbers = std::vector<std::pair<std::string_view, double>>;

/// A box of grains in space.
struct SolidPackingView {
  double volume = 0;                        ///< of the box [m^3]
  std::span<const double> radius;           ///< of the undeformed grains [m]
  std::span<const SurfaceMeasure> surface;  ///< of each grain, deformed
  std::span<const Vec<3>> centre;           ///< of mass, of each grain [m]
  std::span<const ContactPointOf<3>> contacts;
  std::span<const double> mass;      ///< of the nodes [kg]
  std::span<const Vec<3>> velocity;  ///< of the nodes [m/s]
  double density = 0;                ///< of the grains [kg/m^3]
  double strain_rate = 0;            ///< [1/s]
};

/// What a packing shows, the same for every model; columns.cpp defines each. A column of contacts comes from
/// the network by a function of its own.
struct PackingMeasures {
  ContactNetwork network{};  ///< in the plane
  PackingFraction phi{};
  Coordination coordination{};
  Mat<3> stress{};  ///< of contacts and motion, compression positive [Pa]; in the plane xx, yy and xy alone
  Numbers numbers;  ///< all others
};
PackingMeasures measure_packing(const PackingView& packing);
PackingMeasures measure_packing(const SolidPackingView& packing);

}  // namespace softgrain
