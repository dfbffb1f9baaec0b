#pragma once
#include <string>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Does this key of the schema say what a [[kind]] says, of grains as those of the case?
bool is_key_of_kind(const Case& the_case, const std::string& name);

/// Several kinds and their pairs as they stand in a file, in SI; "" where there is but one.
std::string kinds_text(const Case& the_case);
/// The same as lists of objects in JSON: {"kind": [...], "pair": [...]}, or "{}".
std::string kinds_json(const Case& the_case);

}  // namespace softgrain
