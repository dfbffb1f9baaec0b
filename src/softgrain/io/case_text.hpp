#pragma once
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// The resolved case: every key with its value in SI, runnable as it is. Reading it gives an equal Case, bit
/// for bit.
std::string resolved_case_text(const Case& the_case);

/// The resolved case as JSON: an object for each table.
std::string case_json(const Case& the_case);

/// A case file to edit: every key with its value in the unit in which people write it, and what it means
/// above it.
std::string commented_case_text(const Case& the_case);

/// JSON Schema (draft 2020-12) of a case file: editors complete and check with it.
std::string case_json_schema();

/// The reference page docs/reference/case-file.md.
std::string case_reference_page();

/// A named start for `softgrain new`.
struct CaseTemplate {
  std::string name;
  std::string text;
  Case content;
};
const std::vector<CaseTemplate>& case_templates();

}  // namespace softgrain
