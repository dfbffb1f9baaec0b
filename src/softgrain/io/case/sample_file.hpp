#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/io/case/toml_document.hpp"
#include "softgrain/sample/placed_grain.hpp"

namespace softgrain {

/// What is wrong with a sample's file, and where.
struct SampleIssue {
  TextPosition at;
  std::string message;
};

/// Grains as a file lists them, and the line of each.
struct SampleText {
  std::vector<PlacedGrain> grains;
  std::vector<double> z;  ///< of each, in space [m]
  std::vector<int> lines;
  std::vector<SampleIssue> issues;
};

/// The most grains that a file may list: more do not fit into a case file, where a run keeps them.
inline constexpr std::size_t most_placed_grains = 10000;

/// Reads a table of grains: lines of values between commas; the first one names the columns, each with its
/// unit in brackets, or in SI without: `x [mm], y [mm], radius [mm], angle [deg], kind`. x, y and radius must
/// be there; angle is 0 where it is left out. In space `x [mm], y [mm], z [mm], radius [mm]`. Blank lines and
/// lines that begin with # are skipped. `kinds`: the names that the column kind may have, of several all
/// needed; {""}: any, but one. Collects every issue, up to 20.
SampleText read_sample_text(std::string_view text, const std::vector<std::string>& kinds, int dimension = 2);

}  // namespace softgrain
