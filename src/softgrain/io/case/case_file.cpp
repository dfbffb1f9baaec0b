#include "softgrain/io/case/case_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "softgrain/experiment/advice.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/experiment/solid_case.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/io/case/case_kinds.hpp"
#include "softgrain/io/case/case_relations.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/form_reader.hpp"
#include "softgrain/io/case/placement.hpp"
#include "softgrain/io/case/schema.hpp"
#include "softgrain/io/case/shape_check.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/case/toml_document.hpp"
#include "softgrain/io/case/words.hpp"

namespace softgrain {
namespace {

/// Collects every error of a file and its overrides, and fills in the case on the way.
class CaseReader {
 public:
  CaseReader(std::string_view text, const std::string& name, const std::vector<std::string>& sets)
      : sources_{{name, std::string(text)}}, sets_(sets) {
    draft_.sources = &sources_;
  }

  CaseReading read(bool is_to_run = true) {
    try {
      read_file_text();
      forms_.finish_file();
      for (std::size_t i = 0; i < sets_.size(); ++i) read_set(static_cast<int>(i));
      settle_time_step();
      set_defaults_of_space(draft_.the_case, [&](const char* key) { return draft_.origins.contains(key); });
      forms_.finish_stages();
      given_ = draft_.the_case;
      const PlacedLines lines = place_grains(forms_, draft_, sources_);
      check_heights(draft_);
      forms_.finish_kinds();
      if (draft_.the_case.kinds.empty()) check_shape(draft_);
      if (!draft_.has_shape()) throw CaseFileError(report(draft_.issues, sources_, sets_));
      draft_.the_case = complete_sample(draft_.the_case);
      pour_grains();
      take_quasi_static_speeds();
      take_speed_of_stages();
      check_placement(draft_, lines);
      if (is_to_run) check_relations();
    } catch (const TooManyIssues&) {
    }
    if (!draft_.issues.empty()) throw CaseFileError(report(draft_.issues, sources_, sets_));
    return {draft_.the_case, without_effect(), draft_.notes, draft_.origins, sources_, sets_};
  }

 private:
  /// A default that the file repeats is no wish: `softgrain new --all` and resolved cases write every key.
  /// Nor is what a sample's file or list says anyway.
  std::vector<std::string> without_effect() {
    std::vector<std::string> names;
    for (const Key& key : case_keys()) {
      const auto at = draft_.origins.find(key.name);
      if (at == draft_.origins.end() || covers_a_kind(key)) continue;
      const std::string value = value_in_si(given_, key), held = value_in_si(draft_.the_case, key);
      const bool repeats = value == value_in_si(Case{}, key) || (is_derived(key) && value == held);
      if (at->second.set >= 0 || !repeats) names.push_back(key.name);
    }
    for (const std::string& name : keys_set_by_stages(draft_.the_case))
      if (!covers_a_kind(*find_key(name)) && std::ranges::find(names, name) == names.end())
        names.push_back(name);
    return names;
  }

  /// Does the key do anything for a kind?
  bool covers_a_kind(const Key& key) const {
    return largest_of_kinds(draft_.the_case,
                            [&](const Case& kind) { return key.acts.covers(kind) ? 1.0 : 0.0; }) > 0;
  }

  /// Of a case without errors so far.
  void pour_grains() {
    if (!draft_.issues.empty() || !is_to_pour(draft_.the_case)) return;
    try {
      draft_.the_case = with_poured_grains(draft_.the_case);
    } catch (const UsageError& error) {
      draft_.add(draft_.origins["sample.places"], fmt::format("sample.places \"pour\": {}", error.what()));
    }
  }

  /// Does complete_sample say what this key says?
  bool is_derived(const Key& key) const {
    const Case::Sample& sample = draft_.the_case.sample;
    if (key.name == "sample.smallest_diameter" || key.name == "sample.largest_diameter")
      return !sample.placed.empty() || sample.sizes == SizeLaw::list;
    return !sample.placed.empty() && (key.name == "sample.grains" || key.name == "sample.packing_fraction" ||
                                      key.name == "sample.aspect");
  }

  /// A line that is no TOML is reported and left out, so that one slip of the pen does not hide the other
  /// errors.
  void read_file_text() {
    std::string text = sources_.front().text;
    for (int attempt = 0; attempt < 20; ++attempt) {
      try {
        for (const TomlMember& member : parse_toml(text)) read_table(member);
        return;
      } catch (const TomlError& error) {
        const std::string_view line = line_of(text, error.at.line);
        draft_.add({.at = error.at}, error.what() + quotes_missing(line, error.what()));
        if (line.starts_with('[') || line.find('=') == std::string_view::npos) return;
        text.replace(static_cast<std::size_t>(line.data() - text.data()), line.size(), line.size(), ' ');
      }
    }
  }

  /// The remedy for `radius = 5 mm`.
  static std::string quotes_missing(std::string_view line, std::string_view message) {
    if (!message.starts_with("expected")) return "";
    const std::size_t value = line.find_first_not_of(" \t", line.find('=') + 1);
    if (value == std::string_view::npos || !std::isdigit(static_cast<unsigned char>(line[value]))) return "";
    return "; a quantity stands in quotes, as in \"5 mm\"";
  }

  void read_table(const TomlMember& member) {
    const Origin origin{.at = member.at};
    if (contains(form_tables(), member.key)) return forms_.read_tables(member.key, member.value, origin);
    const auto* entries = std::get_if<TomlValue::Table>(&member.value.content);
    if (entries == nullptr) {
      draft_.add(origin, contains(case_tables(), member.key)
                             ? fmt::format("'{}' is a table: write [{}]", member.key, member.key)
                             : unknown_key(member.key));
    } else if (!contains(case_tables(), member.key)) {
      draft_.add(origin,
                 fmt::format("unknown table '{}'{}", member.key, did_you_mean(member.key, table_names())));
    } else {
      for (const TomlMember& entry : *entries)
        read_key(member.key + "." + entry.key, entry.value, {.at = entry.at});
    }
  }

  void read_set(int i) {
    const std::string& argument = sets_[static_cast<std::size_t>(i)];
    const auto equals = argument.find('=');
    if (equals == std::string::npos)
      return draft_.add({.set = i}, "expected key=value, as in time.step=0.5e-6");
    std::string name = argument.substr(0, equals);
    name.erase(name.find_last_not_of(' ') + 1);
    read_key(name, value_of(argument.substr(equals + 1)), {.set = i});
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
    if (name == "mpm.time_step") return read_old_step(value, origin);
    if (const Key* key = find_key(name)) return draft_.give(*key, name, value, origin);
    if (!forms_.read_key(name, value, origin)) draft_.add(origin, unknown_key(name));
  }

  /// Before there was one key for all models, elastic grains had their own.
  void read_old_step(const TomlValue& value, Origin origin) {
    Key key = *find_key("time.step");
    key.name = "mpm.time_step";
    Case scratch;
    try {
      assign(scratch, key, value);
      old_step_ = scratch.time.step;
      old_step_origin_ = origin;
    } catch (const UsageError& error) {
      if (value.at.line > 0) origin.at = value.at;
      draft_.add(origin, error.what());
    }
  }

  /// Where the old key is given, time.step of the file was that of bonded grains alone.
  void settle_time_step() {
    if (!old_step_) return;
    Case& c = draft_.the_case;
    const double step_given = c.time.step;
    const auto step = draft_.origins.find("time.step");
    const bool is_newer =
        step != draft_.origins.end() && step->second > old_step_origin_ && step->second.set >= 0;
    const bool counts = c.experiment.model == GrainModel::mpm && !is_newer;
    if (counts) {
      c.time.step = *old_step_;
      draft_.origins["time.step"] = old_step_origin_;
    }
    if (counts && step_given != 0 && step_given != *old_step_)
      draft_.notes.push_back(
          "note: time.step has no effect beside mpm.time_step, its old name: leave that out");
    if (*old_step_ == 0 && old_step_origin_.set < 0) return;  // as files of former versions repeat it
    Case now;
    now.time.step = *old_step_;
    draft_.notes.push_back(fmt::format("note: mpm.time_step is an old name{}; write time.step = {}",
                                       counts ? "" : " and has no effect here",
                                       written_value(now, *find_key("time.step"))));
  }

  void take_quasi_static_speeds() {
    if (!set_quasi_static_speeds(draft_.the_case))
      draft_.add(last_origin({"loading.wall_velocity", "loading.shear_rate", "experiment.loading"}),
                 "\"quasi-static\" needs a stress: rigid grains have none of their own; name one, as "
                 "loading.max_stress or that of a stage");
  }

  /// Walls go as fast as their stages say: the time step follows it, and averages of the stress.
  void take_speed_of_stages() {
    Case& c = draft_.the_case;
    if (c.stages.empty() || draft_.origins.contains("loading.wall_velocity")) return;
    if (const double fastest = fastest_speed(c, box_height(c)); fastest > 0)
      c.loading.wall_velocity = fastest;
  }

  void check_relations() {
    for (const Relation& relation : case_relations()) {
      if (!std::ranges::all_of(relation.keys, [&](auto& key) { return draft_.is_valid(key); })) continue;
      const auto is_of_kind = [&](const std::string& key) { return is_key_of_kind(draft_.the_case, key); };
      // looked at for each kind
      if (!draft_.the_case.kinds.empty() && std::ranges::all_of(relation.keys, is_of_kind)) continue;
      const std::string message = relation.broken(draft_.the_case);
      if (!message.empty()) draft_.add(origin_of_fault(message, relation.keys, draft_.origins), message);
    }
  }

  Origin last_origin(const std::vector<std::string>& keys) const {
    return softgrain::last_origin(keys, draft_.origins);
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
    for (const TableOfKeys& table : form_tables()) names.push_back(table.name);
    return names;
  }

  static bool contains(const std::vector<TableOfKeys>& tables, const std::string& name) {
    return std::ranges::find(tables, name, &TableOfKeys::name) != tables.end();
  }

  std::vector<Source> sources_;  // the case file, and the sample's
  const std::vector<std::string>& sets_;
  CaseDraft draft_;
  FormReader forms_{draft_};
  Case given_;  // before what follows from other keys was filled in
  std::optional<double> old_step_;
  Origin old_step_origin_;
};

}  // namespace

Case parse_case(std::string_view text, const std::string& name, const std::vector<std::string>& sets) {
  return CaseReader(text, name, sets).read().the_case;
}

Case parse_recorded_case(std::string_view text, const std::string& name) {
  const std::vector<std::string> no_sets;
  return CaseReader(text, name, no_sets).read(false).the_case;
}

CaseReading parse_case_with_notes(std::string_view text, const std::string& name,
                                  const std::vector<std::string>& sets) {
  return CaseReader(text, name, sets).read();
}

CaseReading read_case_with_notes(const std::string& path, const std::vector<std::string>& sets) {
  return parse_case_with_notes(read_limited(path, "a case file"), path, sets);
}

Case read_case(const std::string& path, const std::vector<std::string>& sets) {
  return parse_case(read_limited(path, "a case file"), path, sets);
}

}  // namespace softgrain
