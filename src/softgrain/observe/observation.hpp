#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "softgrain/observe/energy.hpp"
#include "softgrain/observe/packing_measures.hpp"

namespace softgrain {

/// What the steps since the last row took: means over them, and maxima.
struct StepMeans {
  double sweeps = 0;
  double residual_mean = 0, residual_max = 0;
  double overlap_mean = 0, overlap_max = 0;
  double wall_seconds = 0;  ///< since the run began [s]
};

/// All that a row of series.csv is made of.
struct Observation {
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  double strain = 0;
  int leg = 0;
  double height = 0, width = 0;    ///< of the box, or the grain's width [m]
  int dimension = 2;               ///< in space forces are in N, energies in J
  double face = 0, side_face = 0;  ///< in space: what bottom and top, and each side wall press on [m^2]
  std::vector<double> wall_force;  ///< outwards, by BoxWall, mean since the last row [N/m in the plane]
  std::optional<double> shear;     ///< gamma of a periodic cell
  std::optional<PackingMeasures> packing;  ///< of a closed box
  Energies energies;
  Numbers numbers;  ///< of the model alone
  std::optional<StepMeans> means;

  /// Of the model or the packing.
  std::optional<double> number(std::string_view name) const {
    for (const auto& [of, value] : numbers)
      if (of == name) return value;
    if (!packing) return std::nullopt;
    for (const auto& [of, value] : packing->numbers)
      if (of == name) return value;
    return std::nullopt;
  }
};

}  // namespace softgrain
