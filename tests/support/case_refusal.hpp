#pragma once
#include <string>
#include <vector>

#include "softgrain/io/case/case_file.hpp"

namespace softgrain::test {

/// The message with which a case of this text and these settings is refused, or "" where it is taken.
inline std::string refusal(const std::string& text, const std::vector<std::string>& sets = {}) {
  try {
    parse_case(text, "case.toml", sets);
  } catch (const CaseFileError& error) {
    return error.what();
  }
  return "";
}

inline bool mentions(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

}  // namespace softgrain::test
