#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::read_text;
using softgrain::test::run;
using softgrain::test::TemporaryDirectory;

namespace {

using Words = std::vector<std::string>;

struct Workshop {
  TemporaryDirectory folder;

  softgrain::test::ProcessResult program(Words words) const {
    words.insert(words.begin(), SOFTGRAIN_PROGRAM);
    return run(words, {}, folder.path().string());
  }
  /// Compacts a few grains to a strain of 0.2.
  void compact(const std::string& model) const {
    folder.file("case.toml",
                "[experiment]\nmodel = \"" + model +
                    "\"\nloading = \"compaction\"\n[sample]\ngrains = 5\npacking_fraction = 0.6\n"
                    "[bpm]\nprimaries = 20\n[mpm]\ncells = 3\n[loading]\nmax_strain = 0.2\n"
                    "unload_at = []\nwall_velocity = \"2 m/s\"\n"
                    "[output]\nsamples = 4\nsnapshots = 4\nreport = false\nvtk = false\n");
    const auto made = program({"run", "case.toml", "-q", "-o", "first"});
    REQUIRE_MESSAGE(made.exit_code == 0, made.err);
  }
  std::map<std::string, double> row(const std::string& run_name, bool last) const {
    std::istringstream series(read_text(folder.path() / run_name / "series.csv"));
    std::string header, line, values;
    std::getline(series, header);
    std::getline(series, values);
    while (last && std::getline(series, line)) values = line;
    std::map<std::string, double> row;
    std::istringstream names(header), numbers(values);
    for (std::string name, number; std::getline(names, name, ',') && std::getline(numbers, number, ',');)
      row[name.substr(0, name.find('['))] = std::stod(number);
    return row;
  }
};

}  // namespace

TEST_CASE("a run begins from a state of another: strains, stress and energies go on, time begins anew") {
  for (const std::string model : {"mpm", "bpm"}) {
    CAPTURE(model);
    const Workshop workshop;
    workshop.compact(model);
    const auto made = workshop.program({"run", "--from", "first", "--set", "loading.max_strain=0.25", "--set",
                                        "contact.friction=0.4", "-q", "-o", "second"});
    REQUIRE_MESSAGE(made.exit_code % 5 == 0, made.err);
    const auto before = workshop.row("first", true), start = workshop.row("second", false),
               end = workshop.row("second", true);
    CHECK(start.at("step") == 0);
    CHECK(start.at("time") == 0);
    for (const char* kept : {"strain", "wall_height", "kinetic_energy", "wall_work", "dissipation", "z"})
      CHECK(start.at(kept) == doctest::Approx(before.at(kept)).epsilon(1e-12));
    CHECK(end.at("strain") == doctest::Approx(0.25).epsilon(1e-9));
    CHECK(end.at("wall_work") > before.at("wall_work"));
    CHECK(std::abs(end.at("energy_error")) < 0.02 * end.at("wall_work"));
    const auto json = nlohmann::json::parse(read_text(workshop.folder.path() / "second/run.json"));
    REQUIRE(json.at("begun_from").size() == 1);
    CHECK(json.at("begun_from")[0].at("directory").get<std::string>().ends_with("/first"));
    CHECK(json.at("begun_from")[0].at("content_hash").get<std::string>().size() == 32);
  }
}

TEST_CASE("a run that began from another lets go, is resumed with the same bits, and knows all before it") {
  const Workshop workshop;
  workshop.compact("mpm");
  const Words back{
      "run", "--from", "first", "--set", "loading.max_strain=0.18", "--set", "output.snapshots=3",
      "-q",  "-o"};
  const auto into = [&](const std::string& name, Words more) {
    Words words = back;
    words.push_back(name);
    words.insert(words.end(), more.begin(), more.end());
    return workshop.program(words).exit_code;
  };
  CHECK(into("whole", {}) == 0);
  CHECK(workshop.row("whole", true).at("strain") == doctest::Approx(0.18).epsilon(1e-9));
  CHECK(workshop.row("whole", true).at("wall_height") > workshop.row("whole", false).at("wall_height"));
  CHECK(into("parts", {"--stop-after", "1 us"}) == 75);
  CHECK(workshop.program({"resume", "parts", "-q"}).exit_code == 0);
  const auto whole = workshop.row("whole", true), parts = workshop.row("parts", true);
  for (const auto& [name, value] : whole)
    if (name != "wall_seconds") CHECK_MESSAGE(parts.at(name) == value, name);
  CHECK(workshop.program({"run", "--from", "parts", "--set", "loading.max_strain=0.2", "-q", "-o", "third"})
            .exit_code == 0);
  const auto json = nlohmann::json::parse(read_text(workshop.folder.path() / "third/run.json"));
  REQUIRE(json.at("begun_from").size() == 2);
  CHECK(json.at("begun_from")[1].at("directory").get<std::string>().ends_with("/first"));
}

TEST_CASE("a case of its own gives another run's grains other stages") {
  const Workshop workshop;
  workshop.compact("mpm");
  std::string own = read_text(workshop.folder.path() / "first/case.toml");
  own.replace(own.find("loading = \"compaction\""), 22, "loading = \"stages\"");
  workshop.folder.file("own.toml", own + "\n[[stage]]\ntop = { velocity = -1.0 }\nuntil = { time = 5e-5 }\n");
  const auto made = workshop.program({"run", "own.toml", "--from", "first", "-q"});
  CAPTURE(made.err);
  CHECK(made.exit_code == 0);
  CHECK(workshop.row("own_run", false).at("wall_height") == workshop.row("first", true).at("wall_height"));
  CHECK(workshop.row("own_run", true).at("wall_height") ==
        doctest::Approx(workshop.row("first", true).at("wall_height") + 5e-5).epsilon(1e-6));
}

TEST_CASE("a state that is not there, or is of other grains, is refused and leaves nothing") {
  const Workshop workshop;
  workshop.compact("mpm");
  const auto missing = workshop.program({"run", "--from", "first@7", "-q", "-o", "second"});
  CHECK(missing.exit_code == 2);
  CHECK(missing.err.find("has no snapshot '7'; write first@STEP with one of the steps 0, ") !=
        std::string::npos);
  const auto none = workshop.program({"run", "--from", "nowhere", "-q", "-o", "second"});
  CHECK(none.exit_code == 2);
  const auto other =
      workshop.program({"run", "--from", "first", "--set", "mpm.cells=4", "-q", "-o", "second"});
  CHECK(other.exit_code == 2);
  CHECK(other.err.find("--from takes the grains of first as they are: mpm.cells was 3, not 4") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(workshop.folder.path() / "second"));
  CHECK(workshop.program({"run"}).exit_code == 2);
}
