#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

namespace fs = std::filesystem;
using softgrain::test::ProcessResult;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

ProcessResult softgrain_program(std::vector<std::string> arguments, const std::string& directory = "") {
  arguments.insert(arguments.begin(), SOFTGRAIN_PROGRAM);
  return softgrain::test::run(arguments, {}, directory);
}

bool mentions(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

}  // namespace

TEST_CASE("--version prints one line on stdout") {
  const auto result = softgrain_program({"--version"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.starts_with("softgrain 0."));
  CHECK(std::count(result.out.begin(), result.out.end(), '\n') == 1);
  CHECK(result.err.empty());
}

TEST_CASE("--help names the verbs, and every verb has an example") {
  const auto result = softgrain_program({"--help"});
  CHECK(result.exit_code == 0);
  for (const std::string verb : {"new", "check", "schema", "doctor", "bench"}) {
    CHECK(mentions(result.out, "  " + verb + " "));
    const auto help = softgrain_program({verb, "--help"});
    CHECK(help.exit_code == 0);
    CHECK(mentions(help.out, "softgrain " + verb));
    CHECK(mentions(help.out, "Example"));
  }
}

TEST_CASE("a wrong command line ends with exit code 2, the nearest word, and an empty stdout") {
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } mistakes[] = {
      {{}, "no verb given; one of: new, check"},
      {{"chek"}, "unknown verb 'chek'; did you mean 'check'?"},
      {{"check"}, "CASE is required"},
      {{"check", "case.toml", "--sett", "a=1"}, "unknown option '--sett'; did you mean '--set'?"},
      {{"check", "case.toml", "other.toml"}, "unexpected argument 'other.toml'"},
      {{"check", "case.toml", "--set"}, "--set"},
      {{"check", "none.toml"}, "none.toml"},
      {{"new", "a", "--template", "diametral-bmp"}, "did you mean 'diametral-bpm'?"},
      {{"--verson"}, "unknown option '--verson'; did you mean '--version'?"},
  };
  const TemporaryDirectory directory;
  for (const auto& [arguments, message] : mistakes) {
    const auto result = softgrain_program(arguments, directory.path().string());
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK_MESSAGE(mentions(result.err, message), result.err);
  }
  CHECK(std::filesystem::is_empty(directory.path()));
}

TEST_CASE("a wrong value on the command line is answered in a line that helps") {
  const softgrain::test::TemporaryDirectory folder;
  const std::string here = folder.path().string();
  folder.file("case.toml", "");
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } mistakes[] = {
      {{"run", "case.toml", "-j", "0"}, "must be a whole number, at least 1, got 0\n"},
      {{"run", "case.toml", "-j", "abc"}, "must be a whole number, at least 1, got abc\n"},
      {{"sweep", "case.toml", "--vary", "sample.seed=1", "-o", "x", "-j", "0"}, "at least 1, got 0\n"},
      {{"run", "case.toml", "-o=x"}, "'-o=x': no '=' after a single letter; write -o x\n"},
      {{"new", "x", "--template", "isotropic"}, "\none of: diametral-bpm, "},
      {{"check", "case.toml", "--set", "sample.seed=1.0"}, "takes a whole number, as in 1; got 1.0\n"},
      {{"check", "case.toml", "--set", "contact.friction=0,5"}, "decimal comma"},
      {{"info", "case.toml"}, "case.toml is a case, neither"},
  };
  for (const auto& mistake : mistakes) {
    CAPTURE(mistake.message);
    const auto result = softgrain_program(mistake.arguments, here);
    CHECK(result.exit_code == 2);
    CHECK_MESSAGE(mentions(result.err, mistake.message), result.err);
    CHECK(result.err.size() < 400);
  }
  CHECK_FALSE(fs::exists(folder.path() / "=x"));
}

TEST_CASE("what people write who do not know TOML is answered with how it is written") {
  const softgrain::test::TemporaryDirectory folder;
  const std::pair<std::string, std::string> slips[] = {
      {"[experiment]\nmodel = mpm\n", "words and quantities stand in quotation marks: model = \"mpm\""},
      {"[grain]\nradius = 5 mm\n", "words and quantities stand in quotation marks: radius = \"5 mm\""},
      {"[experiment]\nmodel = \u201cmpm\u201d\n", "are not those of a keyboard"},
      {"x", "expected 'key = value', got 'x'"},
      {"[sample]\nseed =\n", "a value is missing behind 'seed ='"},
      {"[sample]\nseed = 1\nseed = 2\n", "given twice"},
  };
  for (const auto& [text, message] : slips) {
    const std::string file = folder.file("case.toml", text);
    const auto result = softgrain_program({"check", file});
    CHECK(result.exit_code == 2);
    CHECK_MESSAGE(mentions(result.err, message), result.err);
  }
}

TEST_CASE("the directory that new made is a case, and so is a file's name without .toml") {
  const softgrain::test::TemporaryDirectory folder;
  const std::string here = folder.path().string();
  CHECK(softgrain_program({"new", "squeeze"}, here).exit_code == 0);
  CHECK(softgrain_program({"check", "squeeze"}, here).exit_code == 0);
  CHECK(softgrain_program({"check", "squeeze/case"}, here).exit_code == 0);
  CHECK(
      softgrain_program({"run", "squeeze", "-q", "--stop-after", "1 ms", "--set", "bpm.primaries=100"}, here)
          .exit_code == 75);
  CHECK(fs::exists(folder.path() / "squeeze/case_run/run.json"));
}

TEST_CASE("new writes a case that check accepts, and never overwrites one") {
  const TemporaryDirectory directory;
  const std::string here = directory.path().string();
  const auto made = softgrain_program({"new", "squeeze"}, here);
  CHECK(made.exit_code == 0);
  CHECK(made.out == "squeeze/case.toml\n");
  const std::string text = read_text(directory.path() / "squeeze/case.toml");
  CHECK(mentions(text, "radius = \"5 mm\""));
  CHECK(text.starts_with("#:schema ./case.schema.json\n"));
  CHECK(read_text(directory.path() / "squeeze/case.schema.json") == softgrain_program({"schema"}, here).out);
  CHECK_FALSE(mentions(text, "\n[mpm]\n"));
  CHECK(softgrain_program({"new", "whole", "--all"}, here).exit_code == 0);
  CHECK(mentions(read_text(directory.path() / "whole/case.toml"), "\n[mpm]\n"));
  const auto checked = softgrain_program({"check", "squeeze/case.toml"}, here);
  CHECK(checked.exit_code == 0);
  CHECK(softgrain_program({"check", "whole/case.toml"}, here).out == checked.out);
  directory.file("squeeze/case.toml", "mine");
  const auto again = softgrain_program({"new", "squeeze"}, here);
  CHECK(again.exit_code == 2);
  CHECK(mentions(again.err, "exists already"));
  CHECK(read_text(directory.path() / "squeeze/case.toml") == "mine");
}

TEST_CASE("new says 4 when the directory cannot be made") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("file", "");
  CHECK(softgrain_program({"new", file + "/below"}).exit_code == 4);
}

TEST_CASE("check prints the resolved case on stdout and the estimate on stderr") {
  const TemporaryDirectory directory;
  const std::string path = directory.file("case.toml", "[grain]\nradius = \"4 mm\"\n");
  const auto first =
      softgrain_program({"check", path, "--set", "time.step=0.1 us", "--set", "bpm.primaries=300"});
  CHECK(first.exit_code == 0);
  CHECK(mentions(first.out, "radius = 0.004  # m\n"));
  CHECK(mentions(first.out, "step = 1e-7  # s\n"));
  CHECK(mentions(first.err, "300 primary particles"));
  CHECK(mentions(first.err, "time steps"));
  const auto second = softgrain_program({"check", directory.file("resolved.toml", first.out)});
  CHECK(second.out == first.out);
}

TEST_CASE("check warns of walls that are as fast as sound in the grains") {
  const TemporaryDirectory directory;
  for (const auto& [speed, warns] : {std::pair{"0.1 m/s", false}, {"2 m/s", true}}) {
    const auto result = softgrain_program(
        {"check",
         directory.file("case.toml", "[experiment]\nmodel = \"mpm\"\n[mpm]\nyoung_modulus = \"1 kPa\"\n"),
         "--set", std::string("loading.wall_velocity=\"") + speed + "\""});
    CHECK(result.exit_code == 0);
    CHECK(mentions(result.err, "times the speed of pressure waves in the grains") == warns);
  }
}

TEST_CASE("check --json gives the case and the estimate to machines") {
  const TemporaryDirectory directory;
  const auto result =
      softgrain_program({"check", directory.file("case.toml", "grain.radius = 0.004"), "--json"});
  CHECK(result.exit_code == 0);
  const auto json = nlohmann::json::parse(result.out);
  CHECK(json["case"]["grain"]["radius"] == 0.004);
  CHECK(json["estimate"]["particles"] == 1750);
  CHECK(json["estimate"]["steps"] > 1000);
}

TEST_CASE("an invalid case gives all errors on stderr, exit code 2 and nothing else") {
  const TemporaryDirectory directory;
  directory.file("case.toml", "[grain]\ndensty = \"990 kg/m^3\"\nradius = \"5 s\"\n");
  const auto result = softgrain_program({"check", "case.toml"}, directory.path().string());
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK(result.err ==
        "case.toml:2:1: error: unknown key 'grain.densty'; did you mean 'grain.density'?\n"
        "    2 | densty = \"990 kg/m^3\"\n"
        "      | ^\n"
        "case.toml:3:10: error: grain.radius: unit 's' has the wrong dimension for a length [m]\n"
        "    3 | radius = \"5 s\"\n"
        "      |          ^\n"
        "2 errors; nothing was run\n");
}

TEST_CASE("a hostile case file ends with exit code 2") {
  const TemporaryDirectory directory;
  using namespace std::string_literals;
  for (const std::string& text :
       {"[\0"s, "\xff\xfe\0\0"s, "\u03bc = 0.5"s, std::string(100000, '['), std::string(2'000'000, ' ')}) {
    const auto result = softgrain_program({"check", directory.file("case.toml", text)});
    CHECK(result.exit_code == 2);
    CHECK(mentions(result.err, "error"));
  }
}

TEST_CASE("schema prints JSON, and with --markdown the committed page") {
  const auto result = softgrain_program({"schema"});
  CHECK(result.exit_code == 0);
  CHECK(nlohmann::json::parse(result.out)["properties"].contains("grain"));
  CHECK(softgrain_program({"schema", "--markdown"}).out.starts_with("# Case file"));
}

TEST_CASE("doctor says what it finds, to people and to machines") {
  const auto people = softgrain_program({"doctor"});
  CHECK(people.exit_code == 0);
  CHECK(mentions(people.out, "hdf5"));
  const auto json = nlohmann::json::parse(softgrain_program({"doctor", "--json"}).out);
  CHECK(json["version"]["ok"] == true);
  CHECK(json["hdf5"]["value"].get<std::string>().starts_with("1."));
}

TEST_CASE("bench measures three small compactions") {
  const auto json = nlohmann::json::parse(softgrain_program({"bench", "--rounds", "1", "--json"}).out);
  REQUIRE(json.size() == 3);
  for (const auto& row : json) {
    CHECK(row["cpu_seconds"] > 0);
    CHECK(row["steps"] > 50);
    CHECK(row["sweeps_per_step"] > 1);
  }
}

TEST_CASE("doctor says whether simulations in Python are possible") {
  const auto json = nlohmann::json::parse(softgrain_program({"doctor", "--json"}).out);
  const fs::path package = fs::path(SOFTGRAIN_PROGRAM).parent_path() / "python/softgrain";
  const bool built =
      fs::exists(package) && std::ranges::any_of(fs::directory_iterator(package), [](const auto& file) {
        return file.path().filename().string().starts_with("_core");
      });
  CHECK(json["python module"]["ok"] == built);
  if (built) CHECK(json["python module"]["value"].get<std::string>().starts_with(package.string()));
  const auto without = nlohmann::json::parse(
      softgrain::test::run({SOFTGRAIN_PROGRAM, "doctor", "--json"}, {{"SOFTGRAIN_PYTHON", "/bin/false"}})
          .out);
  CHECK(without["python module"]["ok"] == false);
  CHECK(without["python module"]["value"] == "not there");
}

TEST_CASE("a full stdout is an input/output failure, exit code 4") {
  for (const std::string verb : {" schema", " doctor"}) {  // more and less than stdout's buffer
    const auto result = softgrain::test::run({"/bin/sh", "-c", SOFTGRAIN_PROGRAM + verb + " > /dev/full"});
    CHECK(result.exit_code == 4);
  }
}
