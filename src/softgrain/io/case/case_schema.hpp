#pragma once
#include <string>

namespace softgrain {

/// JSON Schema (draft 2020-12) of a case file: editors complete and check with it.
std::string case_json_schema();

/// The reference page docs/reference/case-file.md.
std::string case_reference_page();

}  // namespace softgrain
