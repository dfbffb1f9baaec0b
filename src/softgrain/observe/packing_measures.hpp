#pragma once
#include <span>

#include "softgrain/math/tensor.hpp"
#include "softgrain/observe/contact_network.hpp"
#include "softgrain/observe/packing.hpp"

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

/// What a packing shows, the same for every model; columns.cpp defines each. A column of contacts comes from
/// the network by a function of its own.
struct PackingMeasures {
  ContactNetwork network{};
  PackingFraction phi{};
  Coordination coordination{};
  double sides = 0;
  Mat<2> stress{};            ///< of contacts and motion, compression positive [Pa]
  double stress_kinetic = 0;  ///< [Pa]
  double inertial_number = 0;
  double circularity = 0, aspect_ratio = 0;
};
PackingMeasures measure_packing(const PackingView& packing);

}  // namespace softgrain
