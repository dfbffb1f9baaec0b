#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/io/case/case_draft.hpp"

namespace softgrain {

/// One [[stage]] as it stands in the file.
struct StageText {
  Origin at;
  std::map<std::string, std::pair<double, Origin>> numbers;  ///< by form key: "stage.yy.velocity", in SI
  std::set<std::string> rests;                               ///< "stage.yy" = "rest"

  std::optional<double> number(const std::string& name) const;
};

/// Puts stages into the keys of [loading], or says what no path of today can do.
void read_stages(const std::vector<StageText>& stages, CaseDraft& draft);

}  // namespace softgrain
