#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

TEST_CASE("an empty case is the default case") {
  const Case read = parse_case("", "case.toml");
  CHECK(read.grain.radius == 5e-3);
  CHECK(read.bpm.primaries == 1750);
  CHECK(read.experiment.model == GrainModel::bpm);
}

TEST_CASE("a case is read in SI, quantities and plain numbers alike") {
  const Case read = parse_case(R"(
[grain]
radius = "4 mm"
density = 1000
[bpm]
primaries = 300
attraction = "0.2 kN/m"
[loading]
unload_at = [0.05, "10 %"]
[time]
step = "0.1 us"
[output]
vtk = false
)",
                               "case.toml");
  CHECK(read.grain.radius == 4e-3);
  CHECK(read.grain.density == 1000);
  CHECK(read.bpm.primaries == 300);
  CHECK(read.bpm.attraction == 200);
  CHECK(read.loading.unload_at == std::vector{0.05, 0.1});
  CHECK(read.time.step == 1e-7);
  CHECK_FALSE(read.output.vtk);
}

TEST_CASE("all errors come at once, sorted by line, each with its line of the file") {
  CHECK(
      refusal("[time]\nstep = \"1 parsec\"\n[grain]\ndensty = \"990 kg/m^3\"\n[loading]\n\twall_velocity = "
              "\"2 m\"\n") ==
      "case.toml:2:8: error: time.step: unknown unit 'parsec'; units are m, g, s, Hz, N, Pa, J, W, bar (and "
      "with "
      "prefixes, as in mm or kPa), min, h, %, rad, deg\n"
      "    2 | step = \"1 parsec\"\n"
      "      |        ^\n"
      "case.toml:4:1: error: unknown key 'grain.densty'; did you mean 'grain.density'?\n"
      "    4 | densty = \"990 kg/m^3\"\n"
      "      | ^\n"
      "case.toml:6:18: error: loading.wall_velocity: unit 'm' has the wrong dimension for a velocity [m/s]\n"
      "    6 | \twall_velocity = \"2 m\"\n"
      "      | \t                ^\n"
      "3 errors; nothing was run");
}

TEST_CASE("a line that is no TOML does not hide the other errors") {
  const std::string text =
      refusal("[grain]\nradius = 5 mm\ndensity = -1\n[time]\nstep = 1e-7\nstep = 2e-7\n");
  CHECK(mentions(text,
                 "case.toml:2:12: error: words and quantities stand in quotation marks: radius = \"5 mm\""));
  CHECK(mentions(text, "case.toml:3:11: error: grain.density = -1 is out of range"));
  CHECK(mentions(text, "case.toml:6:8: error: given twice"));
  CHECK(mentions(text, "3 errors; nothing was run"));
}

TEST_CASE("unknown keys and tables come with the nearest that exists") {
  CHECK(mentions(refusal("[loadng]\n"), "unknown table 'loadng'; did you mean 'loading'?"));
  CHECK(mentions(refusal("radius = 1\n"), "unknown key 'radius'; did you mean 'grain.radius'?"));
  CHECK(mentions(refusal("[bpm]\nfriction = 1\n"),
                 "unknown key 'bpm.friction'; did you mean 'contact.friction'?"));
  CHECK(mentions(refusal("grain = 1\n"), "'grain' is a table: write [grain]"));
  CHECK(mentions(refusal("[[grain]]\n"), "'grain' is a table: write [grain]"));
  CHECK(mentions(refusal("[contact]\nactivation = \"anticipate\"\n"), "did you mean 'anticipated'?"));
}

TEST_CASE("a value of the wrong type is refused, with what the key takes") {
  CHECK(mentions(refusal("bpm.primaries = 1.5"), "bpm.primaries takes a whole number, as in 1750; got 1.5"));
  CHECK(mentions(refusal("bpm.primaries = \"300\""), "takes a whole number"));
  CHECK(
      mentions(refusal("", {"sample.seed=99999999999999999999"}),
               "sample.seed = 99999999999999999999 is out of range: it must be at most 9223372036854775807"));
  CHECK(mentions(refusal("sample.file = ''"), "sample.file takes a text in quotes, which is not empty"));
  CHECK(mentions(refusal("grain.radius = true"), "grain.radius takes a length, as in \"5 mm\"; got true"));
  CHECK(mentions(refusal("output.vtk = 1"), "output.vtk takes true or false"));
  CHECK(mentions(refusal("loading.unload_at = 0.1"), "takes a list of plain numbers"));
  CHECK(mentions(refusal("loading.unload_at = [[0.1]]"), "got a list"));
  CHECK(mentions(refusal("contact.activation = 1"), "takes one of"));
  CHECK(mentions(refusal("grain.radius.x = 1"), "got a table"));
  CHECK(mentions(refusal("grain.radius = 1979-05-27"), "got a date or time"));
  CHECK(mentions(refusal("contact.friction = nan"), "must be finite"));
  CHECK(mentions(refusal("contact.friction = inf"), "must be finite"));
}

TEST_CASE("a value out of range is refused, with the range and the default") {
  CHECK(mentions(refusal("grain.radius = 0"),
                 "grain.radius = 0 is out of range: it must be > 0; the default is \"5 mm\""));
  CHECK(mentions(refusal("contact.restitution = 1.5"), "it must be in [0, 1]"));
  CHECK(mentions(refusal("solver.relaxation = 2"), "it must be in (0, 2)"));
  CHECK(mentions(refusal("solver.max_sweeps = 3000000000"), "it must be at most 2147483647"));
  CHECK(mentions(refusal("sample.seed = -1"), "it must be >= 0"));
  CHECK(mentions(refusal("loading.unload_at = [0.1, -0.2]"), "loading.unload_at = -0.2 is out of range"));
  CHECK(refusal("contact.restitution = 1\ncontact.activation = \"closed_at_mid_step\"").empty());
  CHECK(mentions(refusal("bpm.size_ratio = 4.01"), "it must be in [1, 4]"));
  CHECK(mentions(refusal("bpm.attraction = 0"), "it must be > 0"));
  CHECK(refusal("sample.seed = 9223372036854775807").empty());
}

TEST_CASE("keys that do not fit together are refused where the last of them stands") {
  CHECK(mentions(refusal("loading.unload_at = [0.3, 0.1]"),
                 "case.toml:1:9: error: loading.unload_at must be ascending"));
  CHECK(
      mentions(refusal("loading.unload_at = [0.1, 0.3]\nloading.max_strain = 0.2"), "0.3 is not below 0.2"));
  CHECK(mentions(refusal("loading.unload_at = [0.1, 0.3]\nloading.unload_by = 0.1"), "0.1 is not below 0.1"));
  CHECK(mentions(refusal("solver.min_sweeps = 100\nsolver.max_sweeps = 99"),
                 "case.toml:2:8: error: solver.min_sweeps"));
  CHECK(mentions(refusal("time.step = 1e-300"), "too many"));
  CHECK(mentions(refusal("time.step = \"4 us\""),
                 "time.step 4e-06 s is longer than the critical step of the bonds"));
  CHECK(refusal("experiment.model = \"mpm\"\ntime.step = \"4 us\"").empty());
  CHECK(mentions(refusal("contact.restitution = 0.5"), "contact.restitution 0.5 needs contact.activation"));
  CHECK(refusal("experiment.model = \"mpm\"\ncontact.restitution = 0.5").empty());
  CHECK(mentions(refusal("experiment.model = \"mpm\"\nmpm.time_step = 1e-300"), "too many"));
  CHECK(mentions(refusal("experiment.loading = \"compaction\"\nloading.max_packing_fraction = 0.7"),
                 "0.7 is not above 0.7"));
  CHECK(refusal("loading.max_packing_fraction = 0.7").empty());  // of a packing only
  CHECK(mentions(refusal("sample.smallest_diameter = \"3 mm\""), "0.003 m is above 0.0024 m"));
  CHECK(refusal("experiment.loading = \"compaction\"\nexperiment.model = \"mpm\"\nloading.max_strain = 0.2")
            .empty());
  CHECK(refusal("loading.unload_at = []\nloading.max_strain = 0.05").empty());
  CHECK(mentions(refusal("solver.max_sweeps = -1\nsolver.min_sweeps = 60"),
                 "1 error;"));  // 60 > 50 is not judged
}

TEST_CASE("what a bonded case may say can be run, at both ends of each range") {
  const std::vector<std::string> small{"bpm.primaries=7", "bpm.library=1", "loading.max_strain=0.05",
                                       "loading.unload_at=[]"};
  for (const char* loading : {"diametral", "compaction"})
    for (const char* set :
         {"bpm.primaries=7", "bpm.size_ratio=1", "bpm.size_ratio=4", "bpm.attraction=1e-9",
          "bpm.cohesive_pressure=1e-3", "bpm.exponent=1", "bpm.inner_friction=10", "contact.push_out=0",
          "contact.push_out=1", "contact.activation=closed_at_mid_step",
          "contact.activation=closed_at_end_of_step", "solver.relaxation=1.99", "loading.max_overlap=0.05",
          "loading.wall_velocity=1e3"}) {
      CAPTURE(set);
      std::vector<std::string> sets = small;
      sets.insert(sets.end(), {"sample.grains=3", "sample.packing_fraction=0.5",
                               "experiment.loading=" + std::string(loading), set});
      CHECK_NOTHROW(create_simulation(parse_case("", "case.toml", sets)));
    }
}

TEST_CASE("--set goes the same way as the file, comes after it, and is named in errors") {
  const Case read = parse_case(
      "time.step = \"0.1 us\"", "case.toml",
      {"time.step=0.05 us", "loading.unload_at=[0.2]", "bpm.primaries=300", "sample.seed=1", "sample.seed=2",
       "contact.activation=closed_at_mid_step", "grain.radius = \"4 mm\"", "output.vtk=false"});
  CHECK(read.time.step == 0.05e-6);
  CHECK(read.loading.unload_at == std::vector{0.2});
  CHECK(read.bpm.primaries == 300);
  CHECK(read.sample.seed == 2);
  CHECK(read.contact.activation == Activation::closed_at_mid_step);
  CHECK(read.grain.radius == 4e-3);
  CHECK_FALSE(read.output.vtk);
  CHECK(
      refusal("", {"time.stp=1"}) ==
      "--set time.stp=1: error: unknown key 'time.stp'; did you mean 'time.step'?\n1 error; nothing was run");
  CHECK(mentions(refusal("", {"time.step"}), "--set time.step: error: expected key=value"));
  CHECK(mentions(refusal("", {"time.step=5 m"}), "wrong dimension for a time"));
  CHECK(mentions(refusal("", {"bpm.primaries=3\ntime.step=1"}), "--set bpm.primaries"));
  CHECK(mentions(refusal("loading.unload_at = [0.3]", {"loading.max_strain=0.2"}),
                 "--set loading.max_strain=0.2: error: loading.unload_at"));
}

TEST_CASE("a flood of errors stops after a hundred") {
  std::string text;
  for (int i = 0; i < 50000; ++i) text += "a" + std::to_string(i) + " = 1\n";
  CHECK(mentions(refusal(text), "\n100 errors"));
}

TEST_CASE("a file that cannot be read is the user's mistake") {
  const test::TemporaryDirectory directory;
  CHECK_THROWS_AS(read_case((directory.path() / "none.toml").string()), UsageError);
  CHECK_THROWS_AS(read_case(directory.path().string()), UsageError);
  CHECK_THROWS_AS(read_case("/dev/zero"), UsageError);
  const std::string large = directory.file("large.toml", "");
  std::filesystem::resize_file(large, std::uintmax_t{1} << 35);  // 32 GB of nothing: must not be read
  CHECK_THROWS_AS(read_case(large), UsageError);
  CHECK(read_case(directory.file("case.toml", "grain.radius = 1")).grain.radius == 1);
}
