#pragma once
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/io/case/toml_document.hpp"

namespace softgrain {

/// Where a value was given: a place in a file, or the n-th --set, which comes after all files.
struct Origin {
  int set = -1;
  TextPosition at = {};
  int source = 0;  ///< of the files: 0 is the case file

  friend auto operator<=>(const Origin& a, const Origin& b) {
    if (const auto by_set = a.set <=> b.set; by_set != 0) return by_set;
    if (const auto by_source = a.source <=> b.source; by_source != 0) return by_source;
    return a.at <=> b.at;
  }
  friend bool operator==(const Origin&, const Origin&) = default;
};

/// The last place where one of these keys was given; nowhere if none was.
Origin last_origin(const std::vector<std::string>& keys, const std::map<std::string, Origin>& origins);

/// Where a message first names a key, by its full name; npos for nowhere.
std::size_t place_of_key(const std::string& key, std::string_view message);

/// The place of what is wrong between some keys: the last of those that the message names, if they were
/// given, else of all.
Origin origin_of_fault(std::string_view message, const std::vector<std::string>& keys,
                       const std::map<std::string, Origin>& origins);

/// One error.
struct Issue {
  Origin origin;
  std::string message;
};

/// A file that was read, as messages show it.
struct Source {
  std::string name, text;
};

/// The n-th line of a text, from 1, without its end; "" for line 0.
std::string_view line_of(std::string_view text, int number);

/// Every issue as `file:line:column: error: ...` with its line of the file and a caret, or as `--set ...`,
/// sorted by place; then their count.
std::string report(std::vector<Issue> issues, std::span<const Source> sources,
                   std::span<const std::string> sets);

}  // namespace softgrain
