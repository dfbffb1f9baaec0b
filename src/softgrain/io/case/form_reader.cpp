#include "softgrain/io/case/form_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/suggest.hpp"

namespace softgrain {
namespace {

/// Keys of later versions, and what does their work today. A key covers those below it.
struct LaterKey {
  std::string_view name, today;
};
constexpr std::array later_keys{
    LaterKey{"pair.restitution", "contact.restitution holds for all pairs"},
    LaterKey{"pair.adhesion", "pair.surface_energy makes grains and walls adhere"},
    LaterKey{"box.die_friction", "a [[pair]] between a kind and \"wall\" holds for all walls"},
};

bool is_below(std::string_view name, std::string_view above) {
  return name == above || (name.starts_with(above) && name[above.size()] == '.');
}

bool has_forms_below(const std::string& name) {
  return std::ranges::any_of(form_keys(),
                             [&](const FormKey& form) { return form.name.starts_with(name + "."); });
}

constexpr std::string_view set_prefix = "stage.set.";

/// Names of keys that a stage may set.
std::vector<std::string> settable_keys() {
  std::vector<std::string> names;
  for (const FormKey& form : form_keys())
    if (form.name.starts_with(set_prefix)) names.push_back(form.name.substr(set_prefix.size()));
  return names;
}

std::string unknown_key(const std::string& name) {
  if (name.starts_with(set_prefix)) {
    const std::string key = name.substr(set_prefix.size());
    const std::string allowed = fmt::format("set takes {}", fmt::join(settable_keys(), ", "));
    if (find_key(key) == nullptr)
      return fmt::format("unknown key '{}'{}; {}", key, did_you_mean(key, settable_keys()), allowed);
    return fmt::format("'{}' may not change between stages; {}", key, allowed);
  }
  std::vector<std::string> names;
  for (const FormKey& form : form_keys()) names.push_back(form.name);
  return fmt::format("unknown key '{}'{}", name, did_you_mean(name, names));
}

std::string quoted(const std::vector<std::string>& words) {
  return fmt::format("{}\"{}\"", words.size() > 1 ? "one of " : "", fmt::join(words, "\", \""));
}

std::string word_in(const TomlValue& value) {
  const auto* text = std::get_if<std::string>(&value.content);
  return text == nullptr ? "" : *text;
}

/// The texts of a list, or nothing.
std::vector<std::string> texts_of(const TomlValue& value) {
  std::vector<std::string> texts;
  if (const auto* items = std::get_if<TomlValue::Array>(&value.content))
    for (const TomlValue& item : *items)
      if (const auto* text = std::get_if<std::string>(&item.content)) texts.push_back(*text);
  return texts;
}

std::string takes_a_text(const FormKey& form) {
  return fmt::format("{} takes a text in quotes, which is not empty", form.name);
}

}  // namespace

std::string not_yet(const std::string& name) {
  for (const LaterKey& later : later_keys)
    if (is_below(name, later.name))
      return fmt::format("not yet: '{}' comes with a later version; today {}", name, later.today);
  return "";
}

void FormReader::for_each_entry(const std::string& prefix, const TomlValue::Table& table, int set,
                                const Visit& visit) {
  for (const TomlMember& entry : table) {
    const std::string name = prefix + "." + entry.key;
    const Origin origin{.set = set, .at = entry.at};
    const auto* inner = std::get_if<TomlValue::Table>(&entry.value.content);
    if (const std::string later = not_yet(name); !later.empty())
      draft_.add(origin, later);
    else if (inner != nullptr && (has_forms_below(name) || name.starts_with(set_prefix)))
      for_each_entry(name, *inner, set, visit);
    else if (const FormKey* form = find_form(name))
      visit(*form, entry.value, origin);
    else
      draft_.add(origin, has_forms_below(name) ? fmt::format("'{}' is a table", name) : unknown_key(name));
  }
}

void FormReader::read_tables(const std::string& table, const TomlValue& tables, Origin at) {
  const auto* items = std::get_if<TomlValue::Array>(&tables.content);
  if (items == nullptr)
    return draft_.add(at, fmt::format("'{}' may stand several times: write [[{}]]", table, table));
  for (const TomlValue& item : *items) {
    const auto* entries = std::get_if<TomlValue::Table>(&item.content);
    const Origin origin{.at = item.at.line > 0 ? item.at : at.at};
    if (entries == nullptr)
      draft_.add(origin, fmt::format("'{}' is a list of tables: write [[{}]]", table, table));
    else if (table == "pair")
      pairs_.emplace_back(*entries, origin);
    else if (table == "stage")
      stages_.push_back(read_stage(*entries, origin));
    else if (items->size() > 1)
      keep_kind(*entries, origin);
    else
      read_kind(*entries);
  }
}

bool FormReader::read_key(const std::string& name, const TomlValue& value, Origin origin) {
  if (const std::string later = not_yet(name); !later.empty()) return draft_.add(origin, later), true;
  if (!kinds_.empty() && name.starts_with("kind.")) return keep_key_of_kind(name, value, origin);
  const FormKey* form = find_form(name);
  const std::string own = fmt::format("kind.{}.", kind_name_);  // of the only one
  if (form == nullptr && name.starts_with(own)) form = find_form("kind." + name.substr(own.size()));
  if (form == nullptr) return false;
  if (name.starts_with("pair.") || name.starts_with("stage."))
    return draft_.add(origin,
                      fmt::format("'{}' stands in a table of the file only; --set takes the keys that it "
                                  "stands for, as loading.max_strain or contact.friction",
                                  name)),
           true;
  give(*form, value, origin);
  return true;
}

void FormReader::give(const FormKey& form, const TomlValue& value, Origin origin) {
  const auto* text = std::get_if<std::string>(&value.content);
  if (form.takes == Takes::as_key) {
    if (text != nullptr && std::ranges::find(form.later, *text) != form.later.end())
      return draft_.add(value.at.line > 0 ? Origin{.set = origin.set, .at = value.at} : origin,
                        fmt::format("not yet: {} = \"{}\" comes with a later version; today it is {}",
                                    form.name, *text, accepted(*find_key(form.keys.front()))));
    for (const std::string& key : form.keys) draft_.give(*find_key(key), form.name, value, origin);
    const std::string& first = form.keys.front();
    if (form.name == "kind.diameter" && draft_.is_valid(first))  // also of one grain between walls
      draft_.the_case.grain.radius = draft_.the_case.sample.smallest_diameter / 2;
  } else if (form.takes == Takes::word) {
    check_word(form, value, origin);
  } else if (form.takes == Takes::number) {
    if (const auto share = number(form, value, origin); share && *share != 1)
      draft_.add(origin,
                 fmt::format("{} = {}: there is only one [[kind]], which has all grains", form.name, *share));
  } else if (text == nullptr || text->empty()) {
    draft_.add(value.at.line > 0 ? Origin{.set = origin.set, .at = value.at} : origin, takes_a_text(form));
  } else if (form.name == "kind.name") {
    kind_name_ = *text;
    if (*text == "wall") draft_.add(origin, "kind.name \"wall\" is taken: [[pair]] calls the walls so");
  } else if (form.name == "sample.file") {
    sample_file_ = *text;
    sample_file_origin_ = origin;
  }
}

void FormReader::read_kind(const TomlValue::Table& table) {
  for_each_entry("kind", table, -1, [&](const FormKey& form, const TomlValue& value, Origin origin) {
    give(form, value, origin);
  });
}

bool FormReader::check_word(const FormKey& form, const TomlValue& value, Origin origin) {
  std::string word = word_in(value);
  if (const auto* i = std::get_if<std::int64_t>(&value.content)) word = fmt::format("{}", *i);
  if (const auto* x = std::get_if<double>(&value.content)) word = fmt::format("{}", *x);
  const auto is_word = [&](const std::vector<std::string>& words) {
    return std::ranges::find(words, word) != words.end();
  };
  if (is_word(form.words)) return true;
  if (value.at.line > 0) origin.at = value.at;
  if (is_word(form.later))
    draft_.add(origin, fmt::format("not yet: {} = {} comes with a later version; today it is {}", form.name,
                                   word, form.words.front()));
  else
    draft_.add(origin, fmt::format("{} takes {}, got '{}'{}", form.name, quoted(form.words), word,
                                   did_you_mean(word, form.words)));
  return false;
}

std::optional<double> FormReader::number(const FormKey& form, const TomlValue& value, Origin origin) {
  Key key{form.name, {}, form.unit, form.range, form.text};
  if (form.takes == Takes::as_key) {
    key = *find_key(form.keys.front());
    key.name = form.name;
  }
  key.member = MemberOf<double>(+[](Case& c) -> double& { return c.loading.hold; });
  Case scratch;
  try {
    assign(scratch, key, value);
    return scratch.loading.hold;
  } catch (const UsageError& error) {
    if (value.at.line > 0) origin.at = value.at;
    const std::string message = error.what();
    draft_.add(origin, message.substr(0, message.find("; the default is")));
    return std::nullopt;
  }
}

StageText FormReader::read_stage(const TomlValue::Table& table, Origin at) {
  StageText stage{.at = at, .numbers = {}, .words = {}};
  for_each_entry("stage", table, -1, [&](const FormKey& form, const TomlValue& value, Origin origin) {
    if (form.takes == Takes::number || form.takes == Takes::as_key) {
      if (const auto read = number(form, value, origin)) stage.numbers[form.name] = {*read, origin};
    } else if (form.takes == Takes::word) {
      if (check_word(form, value, origin)) stage.words[form.name] = {word_in(value), origin};
    } else if (const std::string text = word_in(value); !text.empty()) {
      stage.words[form.name] = {text, origin};
    } else {
      draft_.add(origin, takes_a_text(form));
    }
  });
  return stage;
}

void FormReader::read_pair(const TomlValue::Table& table, Origin at) {
  std::vector<std::string> sides;
  PairNumbers numbers;
  for_each_entry("pair", table, -1, [&](const FormKey& form, const TomlValue& value, Origin origin) {
    if (form.takes == Takes::texts) sides = texts_of(value), at = origin;
    if (form.takes == Takes::as_key) numbers.push_back({&form, &value, origin});
  });
  if (sides.size() != 2)
    return draft_.add(at,
                      "pair.between takes two names, as in [\"copper\", \"wall\"]: of kinds, or \"wall\"");
  int walls = 0;
  for (const std::string& side : sides) {
    if (side == "wall") {
      ++walls;
    } else if (side == "bottom" || side == "top" || side == "left" || side == "right") {
      return draft_.add(at,
                        fmt::format("not yet: pair.between a kind and the wall '{}' alone comes with a later "
                                    "version; today \"wall\" is all of them",
                                    side));
    } else if (std::vector<std::string> names = kind_names(); std::ranges::find(names, side) == names.end()) {
      names.emplace_back("wall");
      return draft_.add(
          at, fmt::format("pair.between: no [[kind]] has the name '{}'{}", side, did_you_mean(side, names)));
    }
  }
  if (walls == 2) return draft_.add(at, "pair.between: two walls never meet");
  if (numbers.empty()) return;
  if (!kinds_.empty()) return add_pair(walls, sides, numbers);
  for (const auto& [form, value, origin] : numbers) {  // the second key of two is that of walls
    const std::string& key = walls == 1 ? form->keys.back() : form->keys.front();
    draft_.give(*find_key(key), fmt::format("{}{}", form->name, walls == 1 ? " of a wall" : ""), *value,
                origin);
  }
}

/// A list where there are values, lognormal where there is a median.
void FormReader::imply_law_of_sizes() {
  const auto given = [&](const char* key) { return draft_.origins.contains(key); };
  if (given("sample.sizes")) return;
  if (given("sample.diameters"))
    draft_.the_case.sample.sizes = SizeLaw::list;
  else if (given("sample.median_diameter"))
    draft_.the_case.sample.sizes = SizeLaw::lognormal;
}

/// A shape of one's own where an outline or a surface is given, and no word of it is said.
void FormReader::imply_shape() {
  Case::Grain& grain = draft_.the_case.grain;
  if (draft_.origins.contains("grain.shape")) return;
  if (!grain.outline.empty()) grain.shape = ShapeOfGrain::outline;
  if (!grain.surface.triangle.empty()) grain.shape = ShapeOfGrain::surface;
}

void FormReader::finish_file() {
  imply_law_of_sizes();
  for (const auto& [table, at] : pairs_) read_pair(table, at);
}

void FormReader::finish_stages() {
  if (!stages_.empty() && draft_.issues.empty()) read_stages(stages_, draft_);
  if (!stages_.empty() && draft_.the_case.stages.empty()) draft_.invalid.insert("experiment.loading");
}

}  // namespace softgrain
