#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/io/case/case_kinds.hpp"
#include "softgrain/io/case/case_relations.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/form_reader.hpp"
#include "softgrain/io/case/shape_check.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/case/words.hpp"

namespace softgrain {
namespace {

constexpr std::string_view kind_prefix = "kind.";

/// A name that --set can tell from the keys of a kind.
bool is_name_of_kind(const std::string& name) {
  if (name.empty() || name == "wall" || name.find_first_of(".= \t") != std::string::npos) return false;
  return std::ranges::none_of(form_keys(), [&](const FormKey& form) {
    return form.name == fmt::format("kind.{}", name) || form.name.starts_with(fmt::format("kind.{}.", name));
  });
}

bool is_of_sizes(const FormKey& form) { return form.name.starts_with("kind.diameter"); }

}  // namespace

std::vector<std::string> FormReader::kind_names() const {
  if (kinds_.empty()) return {kind_name_};
  std::vector<std::string> names;
  for (const KindText& kind : kinds_) names.push_back(kind.name);
  return names;
}

void FormReader::keep_kind(const TomlValue::Table& table, Origin at) {
  KindText kind{.name = {}, .at = at, .entries = {}};
  for_each_entry("kind", table, -1, [&](const FormKey& form, const TomlValue& value, Origin origin) {
    const auto* text = std::get_if<std::string>(&value.content);
    if (form.name == "kind.name" && text != nullptr)
      kind.name = *text, kind.at = origin;
    else
      kind.entries.push_back({&form, value, origin});
  });
  if (!is_name_of_kind(kind.name))
    draft_.add(
        kind.at,
        fmt::format("kind.name: each of several [[kind]] needs a name of its own, in one word, that is "
                    "neither \"wall\" nor a key of a kind; got \"{}\"",
                    kind.name));
  else if (std::ranges::find(kinds_, kind.name, &KindText::name) != kinds_.end())
    draft_.add(kind.at, fmt::format("kind.name: two [[kind]] have the name '{}'", kind.name));
  kinds_.push_back(std::move(kind));
}

/// --set kind.NAME.key=value
bool FormReader::keep_key_of_kind(const std::string& name, const TomlValue& value, Origin origin) {
  const std::string rest = name.substr(kind_prefix.size()), kind_name = rest.substr(0, rest.find('.'));
  const auto kind = std::ranges::find(kinds_, kind_name, &KindText::name);
  if (kind == kinds_.end()) {
    draft_.add(origin, fmt::format("there are several [[kind]]: write kind.NAME.key=value, NAME one of {}",
                                   fmt::join(kind_names(), ", ")));
    return true;
  }
  const FormKey* form = find_form(fmt::format("kind{}", rest.substr(kind_name.size())));
  if (form == nullptr || form->name == "kind.name") return false;
  kind->entries.push_back({form, value, origin});
  return true;
}

/// Contact of a pair of several kinds.
void FormReader::add_pair(int walls, const std::vector<std::string>& sides, const PairNumbers& numbers) {
  const std::vector<std::string> names = kind_names();
  const auto number_of = [&](const std::string& side) {
    return side == "wall" ? Case::Pair::wall
                          : static_cast<int>(std::ranges::find(names, side) - names.begin());
  };
  Case::Pair pair{.kind = number_of(sides[0]), .other = number_of(sides[1])};
  for (const auto& [form, value, origin] : numbers) {
    const std::optional<double> given = number(*form, *value, origin);
    if (!given) return;
    (form->name == "pair.friction"         ? pair.friction
     : form->name == "pair.surface_energy" ? pair.surface_energy
                                           : pair.adhesion_range) = given;
  }
  if (walls == 1 && pair.kind == Case::Pair::wall) std::swap(pair.kind, pair.other);
  for (const Case::Pair& before : draft_.the_case.pairs)
    if ((before.kind == pair.kind && before.other == pair.other) ||
        (before.kind == pair.other && before.other == pair.kind))
      return draft_.add(numbers.front().origin, fmt::format("{}: two [[pair]] are between '{}' and '{}'",
                                                            numbers.front().form->name, sides[0], sides[1]));
  draft_.the_case.pairs.push_back(pair);
}

/// The kind as the short form describes one, in a draft of its own: what the file says for all kinds first.
void FormReader::finish_kind(KindText& text) {
  CaseDraft draft;
  draft.the_case = draft_.the_case;
  draft.sources = draft_.sources;
  draft.outline = draft_.outline;
  draft.the_case.kinds.clear();
  FormReader reader(draft);
  const bool placed = !draft_.the_case.sample.placed.empty();
  for (const auto& [form, value, origin] : text.entries) {
    if (placed && (is_of_sizes(*form) || form->name == "kind.number" || form->name == "kind.share"))
      draft.add(origin,
                fmt::format("{}: the places of the grains say their number and diameters: leave it out",
                            form->name));
    else if (form->name == "kind.share")
      text.share = reader.number(*form, value, origin).value_or(1);
    else
      reader.give(*form, value, origin);
    text.has_number = text.has_number || form->name == "kind.number";
  }
  reader.imply_law_of_sizes();
  reader.imply_shape();
  for (const Relation& relation : case_relations()) {
    const auto is_of_kind = [&](const std::string& key) { return is_key_of_kind(draft.the_case, key); };
    if (!draft.issues.empty() || !std::ranges::all_of(relation.keys, is_of_kind)) continue;
    const std::string message = relation.broken(draft.the_case);
    Origin at = text.at;
    for (const std::string& key : relation.keys)
      if (draft.origins.contains(key)) at = std::max(at, draft.origins[key]);
    if (!message.empty()) draft.add(at, fmt::format("kind '{}': {}", text.name, message));
  }
  if (draft.issues.empty()) check_shape(draft);
  for (const char* key : {"grain.outline", "grain.surface"})
    if (!draft.is_valid(key)) draft_.invalid.insert(key);
  std::vector<std::string> in_vain;
  for (const auto& [name, origin] : draft.origins) {
    const Key& key = *find_key(name);
    if (name != "sample.grains" && !key.acts.covers(draft.the_case) &&
        value_in_si(draft.the_case, key) != value_in_si(Case{}, key))
      in_vain.push_back(name);
  }
  for (const std::string& note : notes_on_effect(draft.the_case, in_vain))
    draft_.notes.push_back(fmt::format("{} (kind '{}')", note, text.name));
  for (Issue& issue : draft.issues) draft_.add(issue.origin, std::move(issue.message));
  Case& c = draft_.the_case;
  c.kinds.push_back(kind_of(draft.the_case));
  Case::Kind& kind = c.kinds.back();
  kind.name = text.name;
  if (kind.model != GrainModel::mpm) kind.law = {}, kind.material = {};
  if (const auto said = draft.origins.find("experiment.model"); said != draft.origins.end())
    draft_.origins.insert(*said);
}

/// Of kinds that do not say theirs: that of the file; else the one that another kind says, but rigid grains
/// are always said to be so.
GrainModel FormReader::model_of_silent_kinds() const {
  std::optional<GrainModel> model;
  if (draft_.origins.contains("experiment.model")) return draft_.the_case.experiment.model;
  for (const KindText& kind : kinds_)
    for (const auto& [form, value, origin] : kind.entries)
      if (const auto* word = std::get_if<std::string>(&value.content);
          form->name == "kind.model" && word != nullptr && (!model || *model == GrainModel::rigid))
        model = value_of<GrainModel>(*word);
  if (!model) return draft_.the_case.experiment.model;
  return *model == GrainModel::rigid ? GrainModel::mpm : *model;
}

/// All models mix, rigid kinds as disks (spheres) where there are bonded ones; the case is elastic, else
/// bonded, else rigid.
void FormReader::settle_models() {
  Case& c = draft_.the_case;
  const auto first = [&](GrainModel model) { return std::ranges::find(c.kinds, model, &Case::Kind::model); };
  const auto has = [&](GrainModel model) { return first(model) != c.kinds.end(); };
  const auto at = [&](const auto& kind) { return kinds_[kind - c.kinds.begin()].at; };
  if (has(GrainModel::bpm))
    for (auto kind = c.kinds.begin(); kind != c.kinds.end(); ++kind)
      if (kind->model != GrainModel::mpm && kind->grain.shape != ShapeOfGrain::disk)
        draft_.add(at(kind),
                   fmt::format("not yet: kind '{}': rigid grains among bonded ones come in other shapes with "
                               "a later version; today these are disks: leave kind.shape out",
                               kind->name));
  c.experiment.model = has(GrainModel::mpm)   ? GrainModel::mpm
                       : has(GrainModel::bpm) ? GrainModel::bpm
                                              : c.kinds.front().model;
}

/// Shares of area, in space of volume, become numbers of grains.
void FormReader::count_grains() {
  Case& c = draft_.the_case;
  const bool numbers = std::ranges::all_of(kinds_, &KindText::has_number);
  const bool shares = std::ranges::all_of(kinds_, [](const KindText& kind) { return kind.share > 0; });
  for (const KindText& kind : kinds_)
    if (numbers == shares || (numbers && kind.share > 0) || (shares && kind.has_number))
      return draft_.add(
          kind.at,
          "of several [[kind]] each has a number of grains, or each a share of the area of sample.grains "
          "grains: give all of them kind.number, or all of them kind.share");
  const int all = std::accumulate(c.kinds.begin(), c.kinds.end(), 0,
                                  [](int sum, const Case::Kind& kind) { return sum + kind.grains; });
  if (numbers) {
    if (const auto at = draft_.origins.find("sample.grains");
        at != draft_.origins.end() && c.sample.grains != all)
      draft_.add(at->second,
                 fmt::format("sample.grains = {}, but the numbers of all [[kind]] are together {}: leave "
                             "sample.grains out",
                             c.sample.grains, all));
    return;
  }
  std::vector<double> proportions;
  for (std::size_t k = 0; k < kinds_.size(); ++k)
    proportions.push_back(kinds_[k].share / (is_in_space(c)
                                                 ? mean_cube_diameter(diameter_law(c.kinds[k].sizes, 3))
                                                 : mean_square_diameter(diameter_law(c.kinds[k].sizes))));
  const std::vector<int> counts = counts_in_proportion(proportions, c.sample.grains);
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    c.kinds[k].grains = counts[k];
    if (counts[k] == 0)
      draft_.add(kinds_[k].at,
                 fmt::format(
                     "kind.share = {} of sample.grains = {} is less than a grain of the kind '{}': raise one "
                     "of them, or leave the kind out",
                     kinds_[k].share, c.sample.grains, kinds_[k].name));
  }
}

/// Numbers and diameters of placed grains are their own.
void FormReader::count_placed() {
  Case& c = draft_.the_case;
  for (Case::Kind& kind : c.kinds) {
    kind.grains = 0;
    kind.sizes = {};
  }
  for (const PlacedGrain& grain : c.sample.placed) {
    if (grain.kind >= static_cast<int>(c.kinds.size()))
      return draft_.add(
          draft_.origins["sample.placed"],
          fmt::format("sample.placed: a grain is of kind {}, but there are {} [[kind]]: kinds count "
                      "from 0",
                      grain.kind, c.kinds.size()));
    Case::Kind& kind = c.kinds[grain.kind];
    Case::Sizes& sizes = kind.sizes;
    const double diameter = 2 * grain.radius;
    sizes.smallest_diameter = kind.grains == 0 ? diameter : std::min(sizes.smallest_diameter, diameter);
    sizes.largest_diameter = kind.grains == 0 ? diameter : std::max(sizes.largest_diameter, diameter);
    ++kind.grains;
  }
  for (std::size_t k = 0; k < kinds_.size(); ++k)
    if (c.kinds[k].grains == 0)
      draft_.add(kinds_[k].at, fmt::format("no grain of the sample is of the kind '{}'", kinds_[k].name));
}

void FormReader::finish_kinds() {
  imply_shape();
  if (kinds_.empty()) {
    for (const PlacedGrain& grain : draft_.the_case.sample.placed)
      if (grain.kind != 0)
        return draft_.add(
            draft_.origins["sample.placed"],
            fmt::format("sample.placed: a grain is of kind {}, but there is one kind", grain.kind));
    return;
  }
  draft_.the_case.experiment.model = model_of_silent_kinds();
  for (KindText& kind : kinds_) finish_kind(kind);
  settle_models();
  if (!draft_.issues.empty()) return;
  draft_.the_case.sample.placed.empty() ? count_grains() : count_placed();
  Case& c = draft_.the_case;
  // what the short form says is the first kind's
  Case first = case_of_kind(c, 0);
  first.experiment.model = c.experiment.model;
  first.kinds = std::move(c.kinds);
  first.pairs = std::move(c.pairs);
  c = std::move(first);
}

}  // namespace softgrain
