#pragma once
#include <string>
#include <vector>

#include "softgrain/io/case/case_draft.hpp"
#include "softgrain/io/case/form_reader.hpp"

namespace softgrain {

/// The lines of a sample's file in which its grains stand; none where the grains come from the case file.
struct PlacedLines {
  std::vector<int> line;
  int source = 0;  ///< the sample's file among the sources
};

/// All that can be read of a file of at most 1 MB; UsageError otherwise. `what`: "a case file".
std::string read_limited(const std::string& path, const char* what);

/// Reads sample.file, if the case names one, into sample.placed. It lies beside the case file, or where a
/// --set says. Its text becomes a source; what is wrong with it becomes issues.
PlacedLines place_grains(const FormReader& forms, CaseDraft& draft, std::vector<Source>& sources);

/// Of placed grains of a case in space: sample.placed_z must have as many as there are.
void check_heights(CaseDraft& draft);

/// Issues for placed grains that overlap, or lie outside the box.
void check_placement(CaseDraft& draft, const PlacedLines& lines);

}  // namespace softgrain
