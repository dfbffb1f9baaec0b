#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/io/case/case_issues.hpp"
#include "softgrain/io/case/schema.hpp"
#include "softgrain/io/case/toml_document.hpp"

namespace softgrain {

/// A hundred errors: the rest of the file is not read.
struct TooManyIssues {};

/// A case while it is read: what was given so far, where, and what is wrong with it.
class CaseDraft {
 public:
  Case the_case;
  std::map<std::string, Origin> origins;  ///< of the keys of the schema that were given
  std::set<std::string> invalid;          ///< keys whose value was refused
  std::vector<std::string> notes;         ///< what to write instead of an old spelling
  std::vector<Issue> issues;

  std::vector<Source>* sources = nullptr;  ///< files that were read; more may follow
  /// Of an outline that came from one of them: which, and the line of each point.
  struct OutlineLines {
    int source = 0;
    std::vector<int> lines;
  } outline{};

  void add(Origin origin, std::string message);

  /// A value for a key of the schema, which the user calls `name`. Raises nothing: what is wrong is an issue,
  /// also the same key given twice in a file under two names.
  void give(const Key& key, const std::string& name, const TomlValue& value, Origin origin);

  /// The same for a number in SI that was made out of others.
  void give_number(const std::string& key, double number, const std::string& name, Origin origin);

  /// Was there any error about this key?
  bool is_valid(const std::string& key) const { return !invalid.contains(key); }
  /// Is what it says of the shape of grains right, as far as a file says it?
  bool has_shape() const { return is_valid("grain.outline") && is_valid("grain.surface"); }

 private:
  std::map<std::string, std::string> names_;  // under which keys were given in the file
};

}  // namespace softgrain
