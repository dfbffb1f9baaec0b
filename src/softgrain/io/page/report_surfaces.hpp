#pragma once
#include <vector>

#include "softgrain/io/page/report_frame.hpp"

namespace softgrain {

/// One picture of a scene in space. Columns:
///   vertex.x .y .z [m], .grain, and each field of the cells behind, the mean of the quads round it; of a
///     stress (9 numbers) the largest shear, (s_1 - s_3)/2
///   quad.0 to .3: its vertices, counter-clockwise seen from outside
///   grain.x .y .z [m] (mean of its vertices), .volume [m^3] (between its flat quads), and of each field the
///     mean over its surface; .kind where there are several
///   wall.0 to .11: four corners of each face [m]
///   contact.a .b (grains, then walls), .force [N]; none across the ends of a cell that repeats
ReportFrame frame_of_surfaces(const Scene& scene);

/// Takes from the vertices of all frames what each grain moves and deforms as a whole: with X the places in
/// the first frame from the mean x_g of the grain's vertices,
///   x = x_g + A_g X + r,  A_g = (sum x X^T)(sum X X^T)^-1,  x from x_g,
/// so that r, which vertex.x .y .z hold then, is small. Adds rest.x .y .z (X) and grain.a00 to .a22 (A).
void part_off_motion(std::vector<ReportFrame>& frames);

/// Of the fields of vertices leaves the pressure alone; those of grains stay.
void keep_pressure_alone(std::vector<ReportFrame>& frames);

}  // namespace softgrain
