#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "softgrain/model/model.hpp"

namespace softgrain {

/// One number of each particle, grain, vertex, wall or contact.
using FrameColumn = std::vector<float>;

/// One picture of the page: columns of numbers by name. Absent when the scene does not have them.
///   particle.x .y [m] (from the centre of its grain if there are grains), .radius [m], .grain, and each
///   field
///     that the scene has, as one number: of a vector its length, of a stress (4 numbers) the largest shear
///   grain.x .y [m] (centroid), .area [m^2] (of its outline), and the mean of each field over the grain's
///   area outline.x .y [m] from the grain's centroid, outline.grain wall.x0 .y0 .x1 .y1 [m] contact.a .b
///   (indices, see `contacts_of_grains`), .force [N/m]
struct ReportFrame {
  std::int64_t step = 0;
  double time = 0;                  ///< [s]
  bool contacts_of_grains = false;  ///< a, b count grains, then walls; else particles
  std::map<std::string, FrameColumn> columns;
};

ReportFrame frame_of(const Scene& scene);

/// What the page says of a field of the particles: for known ones words and unit, else its name.
struct ReportField {
  std::string name, label, unit;
};

/// The fields of the particles of a frame, or of the vertices in space, those first that are looked at most.
std::vector<ReportField> fields_of(const ReportFrame& frame);

/// Do material points come in groups of `size` that lie side by side in one grain, as the four of a cell do?
bool can_merge(const ReportFrame& frame, std::size_t size);

/// Replaces each group of `size` particles by its mean.
void merge_particles(ReportFrame& frame, std::size_t size);

}  // namespace softgrain
