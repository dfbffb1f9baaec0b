#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "softgrain/experiment/sample.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_forms.hpp"
#include "softgrain/io/case/case_relations.hpp"
#include "softgrain/io/case/case_schema.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/schema.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;

namespace {

std::string_view bits(std::string_view word) { return word; }
std::vector<std::uint64_t> bits(double value) { return {std::bit_cast<std::uint64_t>(value)}; }
std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> all;
  for (const double value : values) all.push_back(std::bit_cast<std::uint64_t>(value));
  return all;
}
template <class T>
T bits(const T& value) {
  return value;
}

void check_equal(Case a, Case b) {
  for (const Key& key : case_keys())
    std::visit([&](auto member) { CHECK_MESSAGE(bits(member(a)) == bits(member(b)), key.name); }, key.member);
}

Case unusual_case() {
  Case c;
  c.grain.radius = 0.1 + 0.2;
  c.grain.density = 1.0 / 3;
  c.bpm.attraction = 1e-22;
  c.bpm.primaries = 301;
  c.contact.friction = -0.0;
  c.contact.wall_friction = 5e-324;
  c.contact.activation = Activation::closed_at_mid_step;
  c.contact.push_out = std::nextafter(0.1, 1);
  c.loading.unload_at = {0.1 * 3, 1.0 / 3};
  c.time.step = 0.7e-6;
  c.sample.seed = 9007199254740993;  // not a double
  c.sample.diameters = {1e-3, 0.1 + 0.2};
  c.sample.numbers = {1.0 / 3, 2};
  c.output.vtk = false;
  return c;
}

}  // namespace

TEST_CASE("the resolved case reads back bit for bit") {
  for (const Case& c : {Case{}, unusual_case()})
    check_equal(parse_case(resolved_case_text(c), "resolved.toml"), c);
}

TEST_CASE("the commented case reads back bit for bit") {
  for (const Case& c : {Case{}, unusual_case()})
    check_equal(parse_case(commented_case_text(c, Keys::all), "case.toml"), c);
}

TEST_CASE("every template is a valid case") {
  for (const CaseTemplate& start : case_templates())
    check_equal(parse_case(commented_case_text(start.content(), Keys::that_act), start.name),
                start.content());
}

TEST_CASE("a resolved case with placed grains reads back bit for bit") {
  Case c;
  c.experiment.loading = LoadingPath::compaction;
  c.sample.placed = {{{1e-3 / 3, 0.1 + 0.2}, 1e-3 / 3, -0.7}, {{0.01, 0.02}, 2e-3, 0}};
  c = complete_sample(c);
  check_equal(parse_case(resolved_case_text(c), "resolved.toml"), c);
  CHECK(nlohmann::json::parse(case_json(c))["sample"]["placed"][1][2] == 2e-3);
}

TEST_CASE("a new case has only the keys that act in it, unless all are asked for") {
  for (const CaseTemplate& start : case_templates()) {
    CAPTURE(start.name);
    const std::string some = commented_case_text(start.content(), Keys::that_act);
    const std::string all = commented_case_text(start.content(), Keys::all);
    CHECK(some.starts_with("#:schema ./case.schema.json\n"));
    for (const Key& key : case_keys()) {
      const std::string line = "\n" + key.short_name() + " = " + written_value(start.content(), key) + "\n";
      CHECK_MESSAGE(all.find(line) != std::string::npos, key.name);
      if (key.acts.covers(start.content())) CHECK_MESSAGE(some.find(line) != std::string::npos, key.name);
    }
    CHECK(some.size() < all.size());
    const bool bonded = start.content().experiment.model == GrainModel::bpm;
    CHECK((some.find("\n[bpm]\n") != std::string::npos) == bonded);
    CHECK((some.find("\n[mpm]\n") == std::string::npos) == bonded);
  }
}

TEST_CASE("the commented case is written as people write it") {
  const std::string text = commented_case_text(case_templates().front().content(), Keys::that_act);
  CHECK(text.find("radius = \"5 mm\"\n") != std::string::npos);
  CHECK(text.find("attraction = \"100 N/m\"\n") != std::string::npos);
  CHECK(text.find("unload_at = [0.1, 0.3]\n") != std::string::npos);
}

TEST_CASE("every key lies in a table of its own list, once, and its default is allowed") {
  std::set<std::string> tables, names;
  for (const TableOfKeys& table : case_tables()) tables.insert(table.name);
  for (const Key& key : case_keys()) {
    CHECK_MESSAGE(tables.contains(key.table()), key.name);
    CHECK_MESSAGE(names.insert(key.name).second, key.name);
    CHECK_MESSAGE(!key.text.empty(), key.name);
  }
  for (const Relation& relation : case_relations())
    for (const std::string& key : relation.keys) CHECK_MESSAGE(names.contains(key), key);
}

TEST_CASE("the JSON Schema knows every key of a case, and no other") {
  const auto schema = nlohmann::json::parse(case_json_schema());
  CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema["additionalProperties"] == false);
  std::set<std::string> known;
  for (const Key& key : case_keys()) known.insert(key.table() + "." + key.short_name());
  for (const OldKey& old : old_keys()) known.insert(old.name);
  for (const FormKey& form : form_keys())  // the first two parts of their names
    known.insert(form.name.substr(0, form.name.find('.', form.name.find('.') + 1)));
  std::set<std::string> described;
  for (const auto& [name, table] : schema["properties"].items()) {
    const auto& object = table["type"] == "array" ? table["items"] : table;
    CHECK(object["additionalProperties"] == false);
    for (const auto& [key, value] : object["properties"].items()) described.insert(name + "." + key);
  }
  CHECK(described == known);
  const auto& relaxation = schema["properties"]["solver"]["properties"]["relaxation"];
  CHECK(relaxation["anyOf"][0]["exclusiveMaximum"] == 2);
  CHECK(schema["properties"]["bpm"]["properties"]["primaries"]["type"] == "integer");
  CHECK(schema["properties"]["time"]["properties"]["step"]["anyOf"][2]["const"] == "auto");
  const auto& kind = schema["properties"]["kind"]["items"]["properties"];
  CHECK(kind["law"]["properties"]["young_modulus"]["anyOf"][0]["exclusiveMinimum"] == 0);
  CHECK(kind["diameter"]["anyOf"][1]["properties"]["median"].contains("anyOf"));  // a length, or a table
  CHECK(kind["shape"]["enum"] == nlohmann::json::array({"disk", "ellipse", "polygon", "outline", "surface"}));
}

TEST_CASE("the committed reference page is what the program writes") {
  const std::string committed = test::read_text(SOFTGRAIN_SOURCE_DIR "/docs/reference/case-file.md");
  CHECK_MESSAGE(committed == case_reference_page(),
                "run: softgrain schema --markdown > docs/reference/case-file.md");
}

TEST_CASE("the experiments' case files are valid") {
  CHECK_NOTHROW(read_case(SOFTGRAIN_SOURCE_DIR "/experiments/diametral_bpm/case.toml"));
}
