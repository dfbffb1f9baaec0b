#include "softgrain/io/case/shape_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/shape_of_case.hpp"
#include "softgrain/io/case/words.hpp"
#include "softgrain/soft/soft_outline.hpp"

namespace softgrain {

std::string shape_cannot(const Case& c) {
  constexpr double longest_soft = 10;
  if (c.grain.shape == ShapeOfGrain::disk) return "";
  const std::string_view shape = word_of(c.grain.shape);
  if (is_bonded(c))
    return fmt::format(
        "not yet: bonded grains of shape \"{}\" come with a later version; today these are disks", shape);
  if (is_elastic(c) && c.mpm.formulation == Formulation::updated_lagrangian)
    return fmt::format("mpm.formulation \"updated_lagrangian\" takes disks, not grain.shape \"{}\"", shape);
  if (c.grain.shape == ShapeOfGrain::surface && !is_in_space(c))
    return "grain.surface and grain.shape \"surface\" belong to experiment.dimension = 3: in the plane give "
           "grain.outline";
  if (c.grain.shape == ShapeOfGrain::surface && c.grain.surface.triangle.empty())
    return "grain.shape \"surface\" needs grain.surface: an STL or PLY file";
  if (c.grain.shape == ShapeOfGrain::outline && c.grain.outline.empty())
    return "grain.shape \"outline\" needs grain.outline: a CSV file with the columns x, y";
  if (is_elastic(c) && c.grain.shape == ShapeOfGrain::ellipse && c.grain.aspect > longest_soft)
    return fmt::format("grain.aspect of elastic ellipses must be at most {}, got {}: cells would be too flat",
                       longest_soft, c.grain.aspect);
  if (c.mpm.cells < least_cells(c.grain))
    return fmt::format("a grain of {} corners needs mpm.cells >= {}, got {}: each corner is a vertex",
                       c.grain.shape == ShapeOfGrain::polygon ? c.grain.sides : 4 * least_cells(c.grain),
                       least_cells(c.grain), c.mpm.cells);
  return "";
}

void check_shape(CaseDraft& draft) {
  const Case& c = draft.the_case;
  if (c.grain.shape == ShapeOfGrain::disk || !draft.has_shape()) return;
  Origin origin;
  for (const char* key :
       {"grain.shape", "grain.outline", "grain.surface", "grain.aspect", "grain.sides", "mpm.cells"})
    if (const auto given = draft.origins.find(key); given != draft.origins.end())
      origin = std::max(origin, given->second);
  const auto refuse = [&](const std::string& message) {
    draft.add(origin, message);
    draft.invalid.insert("grain.outline");
  };
  if (const std::string message = shape_cannot(c); !message.empty()) return refuse(message);
  if (c.grain.shape != ShapeOfGrain::outline || is_in_space(c)) return;
  origin = draft.origins["grain.outline"];
  try {
    grain_shape_of(c);
  } catch (const OutlineFolds& fold) {
    const auto& lines = draft.outline.lines;
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < c.grain.outline.size(); ++k)
      if (const double d = norm(c.grain.outline[k].x - fold.place); d < least) least = d, nearest = k;
    if (nearest < lines.size()) origin = {.at = {lines[nearest], 1}, .source = draft.outline.source};
    const Vec<2>& x = c.grain.outline[nearest].x;
    refuse(
        fmt::format("at the point ({:.6g}, {:.6g}) {}; or write model = \"rigid\"", x[0], x[1], fold.what()));
  } catch (const UsageError& error) {
    refuse(fmt::format("grain.outline: {}", error.what()));
  }
}

}  // namespace softgrain
