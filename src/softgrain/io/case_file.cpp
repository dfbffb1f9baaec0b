#include "softgrain/io/case_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "softgrain/io/case_relations.hpp"
#include "softgrain/io/case_value.hpp"
#include "softgrain/io/file.hpp"
#include "softgrain/io/schema.hpp"
#include "softgrain/io/suggest.hpp"
#include "softgrain/io/toml_document.hpp"

namespace softgrain {
namespace {

/// Where a value was given: a place in the file, or the n-th --set.
struct Origin {
  int set = -1;
  TextPosition at;

  friend auto operator<=>(const Origin&, const Origin&) = default;
};

constexpr std::size_t most_errors = 100;  // the rest of the file is not read

struct Issue {
  Origin origin;
  std::string message;
};

/// Collects every error of a file and its overrides, and fills in the case on the way.
class CaseReader {
 public:
  CaseReader(std::string_view text, const std::string& name, const std::vector<std::string>& sets)
      : text_(text), name_(name), sets_(sets) {}

  CaseReading read() {
    read_file_text();
    for (std::size_t i = 0; i < sets_.size(); ++i) read_set(static_cast<int>(i));
    check_relations();
    if (!issues_.empty()) throw CaseFileError(report());
    return {case_, without_effect()};
  }

 private:
  /// A default that the file repeats is no wish: `softgrain new` and resolved cases write every key.
  std::vector<std::string> without_effect() {
    std::vector<std::string> names;
    for (const Key& key : case_keys()) {
      const auto given = origins_.find(key.name);
      if (given == origins_.end() || key.acts.covers(case_)) continue;
      if (given->second.set >= 0 || si_value(case_, key) != si_value(Case{}, key)) names.push_back(key.name);
    }
    return names;
  }

  /// A line that is no TOML is reported and left out, so that one slip of the pen does not hide the other
  /// errors.
  void read_file_text() {
    std::string text(text_);
    for (int attempt = 0; attempt < 20; ++attempt) {
      try {
        for (const TomlMember& member : parse_toml(text)) read_table(member);
        return;
      } catch (const TomlError& error) {
        const std::string_view line = line_of(text, error.at.line);
        add({-1, error.at}, error.what() + quotes_missing(line, error.what()));
        if (line.starts_with('[') || line.find('=') == std::string_view::npos) return;
        text.replace(static_cast<std::size_t>(line.data() - text.data()), line.size(), line.size(), ' ');
      }
    }
  }

  static std::string_view line_of(std::string_view text, int number) {
    if (number == 0) return "";
    for (int line = 1; line < number; ++line) text.remove_prefix(std::min(text.size(), text.find('\n') + 1));
    text = text.substr(0, text.find('\n'));
    return text.substr(0, text.find('\r'));
  }

  /// The remedy for `radius = 5 mm`.
  static std::string quotes_missing(std::string_view line, std::string_view message) {
    if (!message.starts_with("expected")) return "";
    const std::size_t value = line.find_first_not_of(" \t", line.find('=') + 1);
    if (value == std::string_view::npos || !std::isdigit(static_cast<unsigned char>(line[value]))) return "";
    return "; a quantity stands in quotes, as in \"5 mm\"";
  }

  void read_table(const TomlMember& member) {
    const auto* entries = std::get_if<TomlValue::Table>(&member.value.content);
    if (entries == nullptr) {
      add({-1, member.at}, is_table(member.key)
                               ? fmt::format("'{}' is a table: write [{}]", member.key, member.key)
                               : unknown_key(member.key));
    } else if (!is_table(member.key)) {
      add({-1, member.at},
          fmt::format("unknown table '{}'{}", member.key, did_you_mean(member.key, table_names())));
    } else {
      for (const TomlMember& entry : *entries)
        read_key(member.key + "." + entry.key, entry.value, {-1, entry.at});
    }
  }

  void read_set(int i) {
    const std::string& argument = sets_[static_cast<std::size_t>(i)];
    const auto equals = argument.find('=');
    if (equals == std::string::npos) return add({i, {}}, "expected key=value, as in time.step=0.5e-6");
    std::string name = argument.substr(0, equals);
    name.erase(name.find_last_not_of(' ') + 1);
    read_key(name, value_of(argument.substr(equals + 1)), {i, {}});
  }

  /// TOML where it is TOML, otherwise the text itself: 0.05 us needs no quotes.
  static TomlValue value_of(const std::string& text) {
    try {
      TomlValue::Table document = parse_toml("value = " + text);
      if (document.size() == 1 && document.front().key == "value") return document.front().value;
    } catch (const TomlError&) {
    }
    return {text, {}};
  }

  void read_key(const std::string& name, const TomlValue& value, Origin origin) {
    origins_[name] = origin;
    const Key* key = find_key(name);
    if (key == nullptr) return add(origin, unknown_key(name));
    try {
      assign(case_, *key, value);
    } catch (const UsageError& error) {
      if (value.at.line > 0) origin.at = value.at;
      add(origin, error.what());
      invalid_.insert(name);
    }
  }

  void check_relations() {
    for (const Relation& relation : case_relations()) {
      const auto is_invalid = [&](const std::string& key) { return invalid_.contains(key); };
      if (std::any_of(relation.keys.begin(), relation.keys.end(), is_invalid)) continue;
      const std::string message = relation.broken(case_);
      if (!message.empty()) add(last_origin(relation.keys), message);
    }
  }

  Origin last_origin(const std::vector<std::string>& keys) const {
    Origin last;
    for (const std::string& key : keys)
      if (const auto found = origins_.find(key); found != origins_.end())
        last = std::max(last, found->second);
    return last;
  }

  /// The nearest full name, or the key of this name in another table.
  static std::string unknown_key(const std::string& name) {
    const std::string short_name = name.substr(name.find('.') + 1);
    for (const Key& key : case_keys())
      if (key.short_name() == short_name)
        return fmt::format("unknown key '{}'; did you mean '{}'?", name, key.name);
    return fmt::format("unknown key '{}'{}", name, did_you_mean(name, key_names()));
  }

  static std::vector<std::string> table_names() {
    std::vector<std::string> names;
    for (const TableOfKeys& table : case_tables()) names.push_back(table.name);
    return names;
  }

  static bool is_table(const std::string& name) {
    const auto names = table_names();
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  void add(Origin origin, std::string message) {
    issues_.push_back({origin, std::move(message)});
    if (issues_.size() == most_errors) throw CaseFileError(report());
  }

  std::string report() {
    std::stable_sort(issues_.begin(), issues_.end(),
                     [](const Issue& a, const Issue& b) { return a.origin < b.origin; });
    std::string text;
    for (const Issue& issue : issues_) text += show(issue);
    return text + fmt::format("{} error{}; nothing was run", issues_.size(), issues_.size() == 1 ? "" : "s");
  }

  std::string show(const Issue& issue) const {
    const auto& [set, at] = issue.origin;
    if (set >= 0)
      return fmt::format("--set {}: error: {}\n", sets_[static_cast<std::size_t>(set)], issue.message);
    if (at.line == 0) return fmt::format("{}: error: {}\n", name_, issue.message);
    return fmt::format("{}:{}:{}: error: {}\n", name_, at.line, at.column, issue.message) + source_line(at);
  }

  /// The line of the file with a caret under the column; nothing where the line would flood or harm a
  /// terminal.
  std::string source_line(TextPosition at) const {
    const std::string_view line = line_of(text_, at.line);
    if (line.size() > 200 || !is_printable(line)) return "";
    std::string blank;  // a tab stays a tab, so that the caret stands where the terminal puts the column
    int column = 1;
    for (std::size_t i = 0; i < line.size() && column < at.column; ++i) {
      if ((static_cast<unsigned char>(line[i]) & 0xC0u) == 0x80u) continue;  // inside a UTF-8 character
      blank += line[i] == '\t' ? '\t' : ' ';
      ++column;
    }
    return fmt::format("{:5} | {}\n      | {}^\n", at.line, line, blank);
  }

  std::string_view text_;
  std::string name_;
  const std::vector<std::string>& sets_;
  Case case_;
  std::map<std::string, Origin> origins_;
  std::set<std::string> invalid_;
  std::vector<Issue> issues_;
};

std::string read_case_text(const std::string& path) {
  constexpr std::size_t largest = 1'000'000;
  std::string text;
  try {
    text = read_beginning(path, largest + 1);
  } catch (const IoError& error) {
    throw UsageError(error.what());
  }
  require(text.size() <= largest, "{} is larger than 1 MB: not a case file", path);
  return text;
}

}  // namespace

Case parse_case(std::string_view text, const std::string& name, const std::vector<std::string>& sets) {
  return CaseReader(text, name, sets).read().the_case;
}

CaseReading parse_case_with_notes(std::string_view text, const std::string& name,
                                  const std::vector<std::string>& sets) {
  return CaseReader(text, name, sets).read();
}

CaseReading read_case_with_notes(const std::string& path, const std::vector<std::string>& sets) {
  return parse_case_with_notes(read_case_text(path), path, sets);
}

Case read_case(const std::string& path, const std::vector<std::string>& sets) {
  return parse_case(read_case_text(path), path, sets);
}

}  // namespace softgrain
