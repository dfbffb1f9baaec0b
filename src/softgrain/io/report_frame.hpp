#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "softgrain/model/model.hpp"

namespace softgrain {

/// One picture of the page: columns of numbers by name. Absent when the scene does not have them.
///   particle.x .y [m] (from the centre of its grain if there are grains), .radius [m], .pressure [Pa],
///     .coordination, .grain
///   grain.x .y [m] (centroid), .pressure [Pa] (mean over its area), .area [m^2] (of its outline)
///   outline.x .y [m] from the grain's centroid, outline.grain
///   wall.x0 .y0 .x1 .y1 [m]
///   contact.a .b (indices, see `contacts_of_grains`), .force [N/m]
struct ReportFrame {
  std::int64_t step = 0;
  double time = 0;                  ///< [s]
  bool contacts_of_grains = false;  ///< a, b count grains, then walls; else particles
  std::map<std::string, std::vector<float>> columns;
};

ReportFrame frame_of(const Scene& scene);

/// Do material points come in groups of `size` that lie side by side in one grain, as the four of a cell do?
bool can_merge(const ReportFrame& frame, std::size_t size);

/// Replaces each group of `size` particles by its mean.
void merge_particles(ReportFrame& frame, std::size_t size);

}  // namespace softgrain
