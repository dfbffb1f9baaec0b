#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/io/case/case_draft.hpp"

namespace softgrain {

/// One [[stage]] as it stands in the file.
struct StageText {
  Origin at;
  std::map<std::string, std::pair<double, Origin>> numbers;     ///< by form key: "stage.yy.velocity", in SI
  std::map<std::string, std::pair<std::string, Origin>> words;  ///< "stage.yy" = "rest", "stage.name"

  std::optional<double> number(const std::string& name) const;
  std::string word(const std::string& name) const;  ///< "" where there is none
};

/// Makes them the stages of the case, whose path is "stages" where it says no other. What contradicts itself
/// or never ends is an issue.
void read_stages(const std::vector<StageText>& stages, CaseDraft& draft);

/// Keys of the schema that any stage sets.
std::vector<std::string> keys_set_by_stages(const Case& the_case);

/// The stages as they stand in a file, in SI; "" where a case has none of its own.
std::string stages_text(const Case& the_case);
/// The same as a list of objects in JSON.
std::string stages_json(const Case& the_case);

}  // namespace softgrain
