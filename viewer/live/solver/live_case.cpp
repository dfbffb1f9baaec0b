#include "live_case.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>

#include "softgrain/core/error.hpp"
#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) - begin + 1);
}

double number_of(std::string_view value) {
  const std::string text(value);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  require(!text.empty() && *end == '\0', "expected a number in SI, got {}", text);
  return number;
}

int count_of(std::string_view value) { return static_cast<int>(number_of(value)); }

std::string_view word_of(std::string_view value) {
  require(value.size() > 2 && value.front() == '"' && value.back() == '"',
          "expected a word between quotes, got {}", value);
  return value.substr(1, value.size() - 2);
}

GrainModel model_of(std::string_view word) {
  require(word == "mpm" || word == "bpm", "no model '{}'", word);
  return word == "mpm" ? GrainModel::mpm : GrainModel::bpm;
}

LoadingPath loading_of(std::string_view word) {
  require(word == "compaction", "the page only compacts, got '{}'", word);
  return LoadingPath::compaction;
}

MaterialLaw law_of_name(std::string_view word) {
  for (const LawChoice& choice : law_choices())
    if (choice.name == word) return choice.law;
  throw UsageError(fmt::format("no law '{}'", word));
}

struct LiveKey {
  std::string_view name;
  void (*set)(Case&, std::string_view value);
};

constexpr LiveKey live_keys[] = {
    {"experiment.loading", [](Case& c, auto v) { c.experiment.loading = loading_of(word_of(v)); }},
    {"experiment.model", [](Case& c, auto v) { c.experiment.model = model_of(word_of(v)); }},
    {"mpm.law", [](Case& c, auto v) { c.mpm.law = law_of_name(word_of(v)); }},
    {"mpm.cells", [](Case& c, auto v) { c.mpm.cells = count_of(v); }},
    {"bpm.primaries", [](Case& c, auto v) { c.bpm.primaries = count_of(v); }},
    {"bpm.library", [](Case& c, auto v) { c.bpm.library = count_of(v); }},
    {"contact.friction", [](Case& c, auto v) { c.contact.friction = number_of(v); }},
    {"contact.wall_friction", [](Case& c, auto v) { c.contact.wall_friction = number_of(v); }},
    {"time.step", [](Case& c, auto v) { c.time.step = number_of(v); }},
    {"sample.grains", [](Case& c, auto v) { c.sample.grains = count_of(v); }},
    {"sample.seed", [](Case& c, auto v) { c.sample.seed = count_of(v); }},
    {"sample.packing_fraction", [](Case& c, auto v) { c.sample.packing_fraction = number_of(v); }},
    {"loading.wall_velocity", [](Case& c, auto v) { c.loading.wall_velocity = number_of(v); }},
    {"loading.max_strain", [](Case& c, auto v) { c.loading.max_strain = number_of(v); }},
};

void set_key(Case& c, const std::string& name, std::string_view value) {
  for (const MaterialParameter& parameter : material_parameters)
    if (name == fmt::format("mpm.{}", parameter.name)) {
      c.mpm.material.*parameter.value = number_of(value);
      return;
    }
  const auto* key = std::find_if(std::begin(live_keys), std::end(live_keys),
                                 [&](const LiveKey& known) { return known.name == name; });
  require(key != std::end(live_keys), "the page knows no key '{}'", name);
  key->set(c, value);
}

}  // namespace

Case live_case(std::string_view text) {
  Case c;
  std::string table;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    try {
      const std::size_t equals = line.find('=');
      if (line.front() == '[' && line.back() == ']')
        table = std::string(line.substr(1, line.size() - 2)) + ".";
      else if (equals != line.npos)
        set_key(c, table + std::string(trimmed(line.substr(0, equals))), trimmed(line.substr(equals + 1)));
      else
        throw UsageError(fmt::format("neither a table nor a key: {}", line));
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("line {}: {}", number, error.what()));
    }
  }
  return c;
}

}  // namespace softgrain
