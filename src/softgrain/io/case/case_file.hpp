#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/case.hpp"
#include "softgrain/io/case/case_issues.hpp"

namespace softgrain {

/// A case that cannot be run. what() holds every error at once, each as `file:line:column: error: ...` with
/// its line of the file, and the count; it is printed as it is.
struct CaseFileError : UsageError {
  using UsageError::UsageError;
};

/// Reads a case file (TOML; keys, units and ranges in io/schema.cpp) and then the overrides `key=value`, in
/// which a value is TOML or a bare quantity: `time.step=0.05 us`. What is not given keeps its default. Raises
/// UsageError when the file cannot be read, and CaseFileError with all errors sorted by line and column.
Case read_case(const std::string& path, const std::vector<std::string>& sets = {});

/// A case, and what it gives in vain.
struct CaseReading {
  Case the_case;
  /// Full names of the keys that do nothing in this case although they were given: by an override, or in the
  /// file with another value than the default; in the order of the schema.
  std::vector<std::string> without_effect;
  std::vector<std::string> notes{};         ///< on old spellings: what to write now
  std::map<std::string, Origin> origins{};  ///< where keys were given, by full name
  std::vector<Source> sources{};            ///< the files that were read
  std::vector<std::string> sets{};          ///< the overrides
};
CaseReading read_case_with_notes(const std::string& path, const std::vector<std::string>& sets = {});

/// The same from text; `name` stands for the file in messages.
Case parse_case(std::string_view text, const std::string& name, const std::vector<std::string>& sets = {});

/// The case that a run has recorded, to be shown, not to be run: the version that began the run has checked
/// what must hold between keys, and the same key may have had another meaning then.
Case parse_recorded_case(std::string_view text, const std::string& name);
CaseReading parse_case_with_notes(std::string_view text, const std::string& name,
                                  const std::vector<std::string>& sets = {});

}  // namespace softgrain
