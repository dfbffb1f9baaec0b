#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/geometry/outline_curve.hpp"
#include "softgrain/io/case/case_draft.hpp"
#include "softgrain/io/case/sample_file.hpp"

namespace softgrain {

/// An outline as a file lists its points, and the line of each.
struct OutlineText {
  std::vector<OutlinePoint> points;
  std::vector<int> lines;
  std::vector<SampleIssue> issues;
};

/// The most points that a file may list: a run keeps them in its case file.
inline constexpr std::size_t most_outline_points = 2000;

/// Reads the points of a closed outline, in their order: lines of values between commas; the first one names
/// the columns x, y and, where wanted, corner (0 or 1), units in brackets change nothing. Without that column
/// corners are where the polygon turns by more than 30 degrees (find_corners). The first point may stand
/// again at the end. Collects every issue, up to 20; an outline that crosses itself is one, at the line of an
/// edge.
OutlineText read_outline_text(std::string_view text);

/// The points of the file that a case names, as a list, or an empty one with issues in the draft. The file
/// lies beside the case file, or where a --set says, and becomes one of the sources.
TomlValue outline_of_file(const std::string& name, Origin origin, CaseDraft& draft);

}  // namespace softgrain
