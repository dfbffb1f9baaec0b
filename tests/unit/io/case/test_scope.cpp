#include <doctest/doctest.h>

#include <algorithm>

#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/schema.hpp"
#include "softgrain/io/case/toml_document.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

/// One of each kind, small.
std::vector<std::pair<std::string, std::string>> kinds() {
  const std::string few = "[sample]\ngrains = 3\npacking_fraction = 0.5\n[bpm]\nprimaries = 10\n";
  const std::string box = "[experiment]\nloading = 'compaction'\nmodel = ";
  return {{"bpm between walls", "[bpm]\nprimaries = 10\n"},
          {"bpm in a box", few + box + "'bpm'\n"},
          {"implicit", "[experiment]\nmodel = 'mpm'\n[mpm]\ncells = 4\n"},
          {"explicit", "[experiment]\nmodel = 'mpm'\n[mpm]\ncells = 4\nintegrator = 'explicit'\n"},
          {"lattice", "[experiment]\nmodel = 'mpm'\n[mpm]\ncells = 4\nformulation = 'updated_lagrangian'\n"},
          {"implicit lattice",
           "[experiment]\nmodel = 'mpm'\n[mpm]\ncells = 4\nformulation = 'updated_lagrangian'\n"
           "lattice_integrator = 'implicit'\n"},
          {"mpm in a box", few + box + "'mpm'\n[mpm]\ncells = 4\n"}};
}

/// Rows of the first steps, all numbers.
std::vector<double> rows(const Case& the_case) {
  const auto simulation = create_simulation(the_case);
  std::vector<double> numbers;
  for (int k = 0; k < 3; ++k) {
    simulation->step();
    for (const Quantity& quantity : test::next_row(*simulation)) numbers.push_back(quantity.value);
  }
  return numbers;
}

/// Another valid value of the key, as text.
std::string another_value(const Case& the_case, const Key& key) {
  if (const auto* enumerated = std::get_if<WordMember>(&key.member))
    for (const std::string& word : enumerated->words())
      if (word != enumerated->word(the_case)) return "'" + word + "'";
  for (const char* number : {"17", "3", "0.7", "0.03", "1", "2e-9", "[0.01]"}) {
    try {
      Case other = the_case;
      assign(other, key, parse_toml(std::string("value = ") + number).front().value);
      if (value_in_si(other, key) != value_in_si(the_case, key)) return number;
    } catch (const UsageError&) {
      // the next one
    }
  }
  return "";
}

}  // namespace

TEST_CASE("keys that are said to have no effect change no bit of the motion") {
  std::size_t silent = 0;
  for (const auto& [kind, text] : kinds()) {
    INFO(kind);
    const Case the_case = parse_case(text, kind);
    std::vector<std::string> all;
    for (const Key& key : case_keys()) {
      if (key.acts.covers(the_case)) continue;
      INFO(key.name);
      const std::string set = key.name + "=" + another_value(the_case, key);
      try {
        const CaseReading reading = parse_case_with_notes(text, kind, {set});
        CHECK(std::ranges::count(reading.without_effect, key.name) == 1);
        all.push_back(set);
      } catch (const CaseFileError&) {
        // refused: that is no silence either
      }
    }
    silent += all.size();
    CHECK(rows(parse_case(text, kind, all)) ==
          rows(the_case));  // together: one that acts shows among the others
  }
  CHECK(silent > 100);
}

TEST_CASE("a note names keys that do nothing, and where they would act") {
  const std::string text =
      "[experiment]\nmodel = 'mpm'\n[contact]\npush_out = 1\n[sample]\ngrains = 5\n"
      "[solver]\nmin_sweeps = 8\n";  // its default: no wish
  const CaseReading reading = parse_case_with_notes(text, "case.toml", {"solver.max_sweeps=50"});
  CHECK(reading.without_effect ==
        std::vector<std::string>{"contact.push_out", "solver.max_sweeps", "sample.grains"});
  CHECK(
      notes_on_effect(reading.the_case, reading.without_effect) ==
      std::vector<std::string>{
          "note: contact.push_out and solver.max_sweeps have no effect on mpm between walls: they act "
          "only on bpm",
          "note: sample.grains has no effect on mpm between walls: it acts only on random grains in a box"});
}

TEST_CASE("no template and no resolved case gives a key without effect") {
  for (const CaseTemplate& start : case_templates()) {
    CHECK(parse_case_with_notes(commented_case_text(start.content(), Keys::all), start.name)
              .without_effect.empty());
    CHECK(parse_case_with_notes(resolved_case_text(start.content()), start.name).without_effect.empty());
  }
}
