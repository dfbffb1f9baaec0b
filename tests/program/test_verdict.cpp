#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/program_runs.hpp"

using namespace softgrain::test;
using nlohmann::json;

namespace {

bool mentions(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

constexpr auto bonded_grain =
    "[bpm]\nprimaries = 30\n[loading]\nmax_strain = 0.01\nwall_velocity = '2 m/s'\n"
    "[output]\nsamples = 5\nsnapshots = 1\nreport = false\nvtk = false\n";

/// Four elastic grains that the top wall squeezes to less than 1 MPa.
constexpr auto elastic_box =
    "[experiment]\nmodel = 'mpm'\nloading = 'compaction'\n[mpm]\ncells = 3\n"
    "[sample]\ngrains = 4\npacking_fraction = 0.5\n[loading]\nwall_velocity = '2 m/s'\nmax_strain = 0.4\n"
    "[output]\nsamples = 5\nsnapshots = 1\nreport = false\nvtk = false\n";

json run_json(const Workshop& workshop, const std::string& run) {
  return json::parse(read_text(workshop.path(run) / "run.json"));
}

}  // namespace

TEST_CASE(
    "a run whose steps do not converge ends with exit code 5, and says so everywhere in the same words") {
  const Workshop workshop;
  workshop.file("case.toml", bonded_grain);
  const Words one_sweep{"--set=solver.min_sweeps=1", "--set=solver.max_sweeps=1",
                        "--set=solver.tolerance=1e-12"};
  Words words{"run", "case.toml", "-o", "out"};
  words.insert(words.end(), one_sweep.begin(), one_sweep.end());
  const ProcessResult result = workshop.softgrain(words);
  CHECK(result.exit_code == 5);
  const json record = run_json(workshop, "out");
  CHECK(record.at("state") == "done");
  REQUIRE(record.at("doubts").size() >= 1);
  CHECK(mentions(record.at("doubts")[0], "of the steps converged (least 50 %)"));
  const std::string verdict = record.at("verdict");
  CHECK(mentions(verdict, "; DO NOT TRUST IT: only "));
  CHECK(mentions(result.out, verdict));
  CHECK(mentions(workshop.softgrain({"info", "out"}).out, verdict));
  CHECK(json::parse(workshop.softgrain({"info", "--json", "out"}).out).at("verdict") == verdict);
  const auto snapshot = workshop.snapshots("out").back().string();
  CHECK(mentions(workshop.softgrain({"info", snapshot}).out, verdict));
  CHECK(workshop.softgrain({"resume", "out", "-q"}).exit_code == 5);  // nothing left to do: the same verdict
  CHECK(run_json(workshop, "out").at("verdict") == verdict);
}

TEST_CASE("--quiet keeps no doubt back") {
  const Workshop workshop;
  workshop.file("case.toml", bonded_grain);
  const ProcessResult good = workshop.softgrain({"run", "case.toml", "-o", "good", "-q"});
  CHECK(good.exit_code == 0);
  CHECK((good.out + good.err).empty());
  const ProcessResult bad =
      workshop.softgrain({"run", "case.toml", "-o", "bad", "-q", "--set=solver.max_sweeps=1",
                          "--set=solver.min_sweeps=1", "--set=solver.tolerance=1e-12"});
  CHECK(bad.exit_code == 5);
  CHECK(bad.out.empty());
  CHECK(mentions(bad.err, "DO NOT TRUST IT"));
}

TEST_CASE("the residual stands beside the limit that is applied to it") {
  const Workshop workshop;
  workshop.file("bpm.toml", bonded_grain);
  workshop.file("mpm.toml", elastic_box);
  REQUIRE(
      workshop.softgrain({"run", "bpm.toml", "-o", "bpm", "-q", "--set=solver.tolerance=2e-5"}).exit_code ==
      0);
  CHECK(run_json(workshop, "bpm").at("report").at("residual_limit") == doctest::Approx(16 * 2e-5));  // (22)
  REQUIRE(workshop.softgrain({"run", "mpm.toml", "-o", "mpm", "-q", "--set=mpm.tolerance=3e-4"}).exit_code ==
          0);
  const auto snapshot = workshop.snapshots("mpm").back().string();
  CHECK(mentions(workshop.softgrain({"info", snapshot}).out, "(limit 3e-04)"));
  CHECK(mentions(workshop.softgrain({"info", "mpm"}).out, "(limit 3e-04)"));
}

TEST_CASE("a stress that a run does not reach is said with the largest that it reached") {
  const Workshop workshop;
  workshop.file("case.toml", elastic_box);
  for (const std::string key : {"loading.hold_stress", "loading.max_stress"}) {
    CAPTURE(key);
    const auto run = [&](const std::string& stress) {
      return workshop.softgrain({"run", "case.toml", "-o", stress + key, "--set", key + "=" + stress, "--set",
                                 "loading.hold=20 ms", "--set", "loading.max_strain=0.8"});
    };
    const ProcessResult never = run("1 GPa");
    CHECK(never.exit_code == (key == "loading.hold_stress" ? 5 : 0));  // max_strain is an end of its own
    CHECK(mentions(never.out,
                   "; NOT REACHED: " + key + " of 1e+09 Pa was not reached: the largest stress was "));
    CHECK(run("10 kPa").exit_code == 0);
  }
}

TEST_CASE("check refuses what run would refuse, with the same words") {
  const Workshop workshop;
  workshop.file("case.toml", bonded_grain);
  workshop.file("box.toml", elastic_box);
  const std::vector<Words> refused{
      {"case.toml", "--set=contact.restitution=0.5"},
      {"case.toml", "--set=contact.restitution=0.5", "--set=bpm.primaries=6000"},  // of which a twin is tried
      {"case.toml", "--set=bpm.size_ratio=7"},
      {"case.toml", "--set=bpm.attraction=0"},
      {"box.toml", "--set=sample.packing_fraction=0.79", "--set=sample.aspect=90"},
      {"box.toml", "--set=experiment.model=bpm", "--set=contact.restitution=1", "--set=bpm.primaries=2000"},
  };
  for (const Words& words : refused) {
    CAPTURE(words.back());
    Words check{"check"}, run{"run", "-o", "out"};
    check.insert(check.end(), words.begin(), words.end());
    run.insert(run.end(), words.begin(), words.end());
    const ProcessResult checked = workshop.softgrain(check), ran = workshop.softgrain(run);
    CHECK(checked.exit_code == 2);
    CHECK(ran.exit_code == 2);
    CHECK(mentions(ran.err, checked.err));
  }
}

TEST_CASE("check says that bonded grains that fall are taken to rest") {
  const Workshop workshop;
  const std::string settle =
      "experiment.model = 'bpm'\nsample.grains = 4\nbpm.primaries = 20\n"
      "[[stage]]\nuntil = { rest = 1e-4, time = '1 ms' }\n";
  workshop.file("still.toml", settle);
  workshop.file("falls.toml", "box.gravity_y = -9.81\n" + settle);
  CHECK(mentions(workshop.softgrain({"check", "falls.toml"}).err, "a fall counts as rest"));
  CHECK_FALSE(mentions(workshop.softgrain({"check", "still.toml"}).err, "a fall counts as rest"));
}

TEST_CASE("check says that a stage that is repeated alone ends where its first turn did") {
  const Workshop workshop;
  const std::string press = "[[stage]]\nname = 'press'\nyy.velocity = '1 m/s'\nuntil.strain = 0.1\n",
                    note = "note: stage 'press': repeat has no effect, as the first turn leads to its end";
  workshop.file("alone.toml", press + "repeat = 3\n");
  workshop.file("once.toml", press);
  workshop.file("timed.toml", press + "until.time = '1 us'\nrepeat = 3\n");
  workshop.file("turns.toml", press +
                                  "[[stage]]\nyy.velocity = '-1 m/s'\nuntil.strain = 0.05\n"
                                  "repeat_from = 'press'\nrepeat = 3\n");
  CHECK(mentions(workshop.softgrain({"check", "alone.toml"}).err, note));
  for (const std::string name : {"once", "timed", "turns"}) {
    const ProcessResult checked = workshop.softgrain({"check", name + ".toml"});
    CHECK(checked.exit_code == 0);
    CHECK_FALSE(mentions(checked.err, "repeat has no effect"));
  }
}

TEST_CASE("check names keys without effect, the inertial number and the step, for people and for machines") {
  const Workshop workshop;
  workshop.file(
      "case.toml",
      "[experiment]\nmodel = 'mpm'\n[solver]\nmax_sweeps = 60\n[loading]\nwall_velocity = '1 mm/s'\n");
  const ProcessResult text = workshop.softgrain({"check", "case.toml"});
  CHECK(mentions(text.err,
                 "note: solver.max_sweeps has no effect on mpm between walls: it acts only on bpm\n"));
  CHECK(mentions(text.err, "inertial number about 9.9e-06 at 10 MPa, below 1e-3: quasi-static\n"));
  CHECK(mentions(text.err, "time step "));
  const json machine = json::parse(workshop.softgrain({"check", "case.toml", "--json"}).out);
  CHECK(machine.at("without_effect") == json{"solver.max_sweeps"});
  // v sqrt(rho/E) = 1e-3 sqrt(990/1e7)
  CHECK(machine.at("advice").at("inertial_number") == doctest::Approx(9.95e-6).epsilon(1e-3));
  const ProcessResult run =
      workshop.softgrain({"run", "case.toml", "--set=loading.max_strain=1e-3",
                          "--set=loading.wall_velocity=1 m/s", "--set=mpm.cells=4", "-o", "out"});
  const auto first = run.err.find("note: solver.max_sweeps");
  CHECK(first != std::string::npos);
  CHECK(run.err.find("note: solver.max_sweeps", first + 1) == std::string::npos);  // once
}
