#pragma once
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "support/temporary_directory.hpp"

namespace softgrain::test {

/// A case in a folder of its own, with another file beside it.
struct CaseInFolder {
  TemporaryDirectory directory;
  std::string path;

  CaseInFolder(const std::string& text, const std::string& other_file, const std::string& other_text) {
    directory.file(other_file, other_text);
    path = directory.file("case.toml", text);
  }
  Case read(const std::vector<std::string>& sets = {}) const { return read_case(path, sets); }
  /// What is said against it; empty if nothing.
  std::string refusal(const std::vector<std::string>& sets = {}) const {
    try {
      read(sets);
    } catch (const CaseFileError& error) {
      return error.what();
    }
    return "";
  }
};

inline bool mentions(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

}  // namespace softgrain::test
