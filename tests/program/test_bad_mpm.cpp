#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

namespace fs = std::filesystem;
using softgrain::test::ProcessResult;
using softgrain::test::TemporaryDirectory;

namespace {

constexpr auto box =
    "[experiment]\nloading = \"compaction\"\nmodel = \"mpm\"\n[mpm]\ncells = 4\n[sample]\ngrains = 10\n"
    "[loading]\nwall_velocity = \"5 m/s\"\nunload_at = []\nmax_strain = 0.3\n"
    "[output]\nvtk = false\nreport = false\n";

/// Runs the box of soft grains with the settings in `directory`/out.
ProcessResult run_box(const TemporaryDirectory& directory, const std::vector<std::string>& settings) {
  directory.file("box.toml", box);
  std::vector<std::string> command{SOFTGRAIN_PROGRAM, "run", "box.toml", "-o", "out", "--quiet"};
  for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
  return softgrain::test::run(command, {}, directory.path().string());
}

}  // namespace

TEST_CASE("soft grains that cannot be are refused with the key, the value and what would do") {
  struct Mistake {
    std::string setting, value, remedy;
  };
  for (const auto& [setting, value, remedy] : std::vector<Mistake>{
           {"mpm.young_modulus=\"-1 MPa\"", "\"-1 MPa\"", "it must be > 0; the default is \"10 MPa\""},
           {"mpm.poisson_ratio=0.5", "0.5", "it must be in (-1, 0.5)"},
           {"mpm.poisson_ratio=0.7", "0.7", "it must be in (-1, 0.5)"},
           {"mpm.cells=1", "1", "it must be in [2, 200]"},
           {"mpm.tolerance=10", "10", "it must be in (0, 0.01]; the default is 0.0001"},
           {"mpm.law=\"rubber\"", "'rubber'", "takes one of \"neo_hookean\""},
           {"mpm.integrator=\"newmark\"", "'newmark'", "takes one of \"implicit\", \"explicit\""},
           {"sample.packing_fraction=0.9", "0.9", "it must be in (0, 0.8)"},
           {"sample.packing_fraction=0.79", "0.79", "the largest fraction found for them is 0.7"},
       }) {
    const TemporaryDirectory directory;
    const ProcessResult result = run_box(directory, {setting});
    CAPTURE(setting);
    CAPTURE(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err.find(setting.substr(0, setting.find('='))) != std::string::npos);
    CHECK(result.err.find(value) != std::string::npos);
    CHECK(result.err.find(remedy) != std::string::npos);
    CHECK_FALSE(fs::exists(directory.path() / "out" / "run.json"));
  }
}

TEST_CASE("what a lattice does not have is refused with the key and what would do") {
  const TemporaryDirectory directory;
  const std::string lattice = "mpm.formulation=\"updated_lagrangian\"";
  for (const auto& [settings, remedy] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"experiment.loading=\"biaxial\"", "loading.confining_stress=\"0.1 MPa\""},
            "it needs experiment.loading \"diametral\", \"compaction\", \"isotropic\""},
           {{"loading.hold_stress=\"0.1 MPa\"", "loading.hold=\"1 ms\""}, "leave out loading.hold_stress"},
           {{"box.x=\"periodic\"", "box.y=\"periodic\""}, "needs walls: leave out box.x"},
       }) {
    std::vector<std::string> all{lattice};
    all.insert(all.end(), settings.begin(), settings.end());
    const ProcessResult result = run_box(directory, all);
    CAPTURE(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err.find("mpm.formulation") != std::string::npos);
    CHECK(result.err.find(remedy) != std::string::npos);
  }
  const ProcessResult implicit = run_box(directory, {lattice, "mpm.lattice_integrator=\"implicit\"",
                                                     "time.step=\"2 us\"", "loading.max_strain=0.01"});
  CAPTURE(implicit.err);
  CHECK(implicit.exit_code == 0);
}

TEST_CASE("an explicit step beyond the stable one is refused, with the stable one and the remedy") {
  const TemporaryDirectory directory;
  const std::string explicit_ = "mpm.integrator=\"explicit\"",
                    lagrangian = "mpm.formulation=\"updated_lagrangian\"";
  for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
           {explicit_, "time.step=\"1.2 us\""},
           {explicit_, "time.step=\"10 ms\""},
           {lagrangian, "experiment.loading=\"diametral\"", "time.step=\"30 us\""},
       }) {
    const ProcessResult result = run_box(directory, settings);
    CAPTURE(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err.find("time.step ") != std::string::npos);
    CHECK(result.err.find("is beyond the longest stable step of an explicit run of this case, ") !=
          std::string::npos);
    CHECK(result.err.find("give at most that, or \"auto\"") != std::string::npos);
    CHECK_FALSE(fs::exists(directory.path() / "out" / "run.json"));
  }
}

TEST_CASE(
    "a top wall that is too fast for an explicit step ends with exit code 3, its name and an intact "
    "snapshot") {
  const TemporaryDirectory directory;
  const ProcessResult result =
      run_box(directory, {"mpm.integrator=\"explicit\"", "loading.wall_velocity=\"1e5 m/s\""});
  CAPTURE(result.err);
  CHECK(result.exit_code == 3);
  CHECK(result.err.find("wall 1 moves by ") != std::string::npos);
  CHECK(result.err.find("use a smaller time step or a slower wall") != std::string::npos);
  CHECK(result.err.find("the last good state is out/snap/s0000") != std::string::npos);
  const ProcessResult verified =
      softgrain::test::run({SOFTGRAIN_PROGRAM, "verify", "out"}, {}, directory.path().string());
  CHECK(verified.exit_code == 0);
  CHECK(verified.out.find("snapshots are intact") != std::string::npos);
}

TEST_CASE("whoever chooses a law that fails in packings is told so") {
  const TemporaryDirectory folder;
  const std::string named = folder.path() / "case";
  REQUIRE(softgrain::test::run({SOFTGRAIN_PROGRAM, "new", named, "--template", "compaction-mpm"}).exit_code ==
          0);
  const std::vector<std::string> check{SOFTGRAIN_PROGRAM, "check", named + "/case.toml"};
  CHECK(softgrain::test::run(check).err.find("note:") == std::string::npos);
  std::vector<std::string> other = check;
  other.insert(other.end(), {"--set", "mpm.law=st_venant_kirchhoff"});
  CHECK(softgrain::test::run(other).err.find("note: mpm.law: st_venant_kirchhoff softens") !=
        std::string::npos);
}
