#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// The resolved case: every key with its value in SI, runnable as it is. Reading it gives an equal Case, bit
/// for bit.
std::string resolved_case_text(const Case& the_case);

/// The resolved case as JSON: an object for each table.
std::string case_json(const Case& the_case);

enum class Keys { all, that_act };

/// A case file to edit: keys with their values in the unit in which people write them, and what they mean
/// above them. The keys that act in this case, or all. `advice` stands at the top: lines of a comment.
std::string commented_case_text(const Case& the_case, Keys keys, std::string_view advice = "");

/// A named start for `softgrain new`.
struct CaseTemplate {
  std::string name;
  std::string text;
  std::function<Case()> content;  ///< made when it is asked for: the program lists templates at each start
  std::string advice{};           ///< lines of a comment on what to change first
};
const std::vector<CaseTemplate>& case_templates();

}  // namespace softgrain
