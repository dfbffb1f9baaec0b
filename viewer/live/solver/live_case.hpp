#pragma once
#include <string_view>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// The case of a text of tables and keys, as the live page writes and offers it: the part of a case file that
/// needs no parser of TOML. Lines are `[table]` or `key = value`, a value is a number in SI or a word between
/// quotes, and `#` begins a comment. What is not given keeps its default. The program reads the same text
/// (io/case/case_file.hpp) and makes the same case of it.
/// Raises UsageError, with the number of the line, for what the page does not write.
Case live_case(std::string_view text);

}  // namespace softgrain
