#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

namespace fs = std::filesystem;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

softgrain::test::ProcessResult call(const TemporaryDirectory& folder, std::vector<std::string> words) {
  words.insert(words.begin(), SOFTGRAIN_PROGRAM);
  return softgrain::test::run(words, {}, folder.path().string());
}

/// A packing of six elastic grains in "run".
void make_run(const TemporaryDirectory& folder, const std::vector<std::string>& more = {}) {
  const auto path = folder.file(
      "case.toml",
      "[experiment]\nmodel = \"mpm\"\nloading = \"compaction\"\n[sample]\ngrains = 6\npacking_fraction = "
      "0.4\n"
      "[mpm]\ncells = 4\n[loading]\nmax_strain = 0.05\nwall_velocity = \"5 m/s\"\n[output]\nsnapshots = 2\n"
      "report = false\n");
  std::vector<std::string> words{"run", path, "-o", "run", "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  const auto made = call(folder, words);
  REQUIRE_MESSAGE(made.exit_code == 0, made.err);
}

std::string last_snapshot(const TemporaryDirectory& folder) {
  const auto described = call(folder, {"info", "--json", "run"});
  return nlohmann::json::parse(described.out).at("snapshots").back();
}

}  // namespace

TEST_CASE("a packing is exported in every format that export lists") {
  const TemporaryDirectory folder;
  make_run(folder);
  for (const char* format : {"xyz", "lammps", "csv", "svg"}) {
    const auto exported = call(folder, {"export", "run", "--to", format});
    CHECK_MESSAGE(exported.exit_code == 0, exported.err);
    const std::string path = exported.out.substr(0, exported.out.find('\n'));
    CHECK(fs::file_size(folder.path() / path) > 500);
  }
  CHECK(call(folder, {"export", "run", "--to", "svg", "--frame", "-1", "-o", "end.svg"}).out == "end.svg\n");
  CHECK(read_text(folder.path() / "end.svg").find("</svg>") != std::string::npos);
  CHECK(call(folder, {"export", "run", "--to", "doc"}).exit_code == 2);
  CHECK(call(folder, {"export", "run", "--to", "csv", "--frame", "last"}).exit_code == 2);
  CHECK(call(folder, {"export", "run", "--to", "csv", "--frame", "99"}).exit_code == 2);
}

TEST_CASE("contacts of elastic grains are in their snapshots and in ParaView's files") {
  const TemporaryDirectory folder;
  make_run(folder, {"--set", "loading.max_strain=0.6"});
  const auto lines = softgrain::test::run(
      {"/bin/sh", "-c", "ls run/vtk/contacts_*.vtp | tail -1 | xargs grep -ao 'NumberOfLines=\"[0-9]*\"'"},
      {}, folder.path().string());
  const auto datasets = call(folder, {"info", "--json", last_snapshot(folder)}).out;
  for (const char* name : {"pair", "force", "total_force", "normal", "position"})
    CHECK(datasets.find("/scene/contacts/" + std::string(name)) != std::string::npos);
  CHECK(std::stoi(lines.out.substr(lines.out.find('"') + 1)) >= 6);
}

TEST_CASE("paraview gets a script that names the files of the run") {
  const TemporaryDirectory folder;
  make_run(folder);
  const auto written = call(folder, {"paraview", "run"});
  CHECK_MESSAGE(written.out == "run/paraview/scene.py\n", written.err);
  const std::string script = read_text(folder.path() / "run/paraview/scene.py");
  CHECK(script.find((folder.path() / "run/paraview").string()) != std::string::npos);
  CHECK(call(folder, {"paraview", "nothing"}).exit_code == 2);
}

TEST_CASE("the contact problem of a step is exported, and solve finds it as the step left it") {
  struct Model {
    const char *name, *settings;
  };
  for (const Model& model : {Model{"bpm", "[bpm]\nprimaries = 20\n"}, Model{"mpm", "[mpm]\ncells = 4\n"}}) {
    CAPTURE(model.name);
    const TemporaryDirectory folder;
    const auto path = folder.file(
        "case.toml",
        std::string("[experiment]\nmodel = \"") + model.name +
            "\"\nloading = \"compaction\"\n[sample]\ngrains = 6\npacking_fraction = 0.5\n" + model.settings +
            "[contact]\nfriction = 0.3\n[loading]\nmax_strain = 0.45\nwall_velocity = \"5 m/s\"\n"
            "[output]\nsnapshots = 4\nreport = false\n");
    const auto made = call(folder, {"run", path, "-o", "run", "--quiet"});
    REQUIRE_MESSAGE(made.exit_code == 0, made.err);
    const auto record = nlohmann::json::parse(read_text(folder.path() / "run/run.json"));
    const std::string step = std::to_string(9 * record.at("report").at("steps").get<int>() / 10);
    const auto exported = call(folder, {"export", "run", "--to", "fclib", "--step", step, "-o", "p.hdf5"});
    REQUIRE_MESSAGE(exported.exit_code == 0, exported.err);
    const double residual = std::stod(exported.out.substr(exported.out.find("residual ") + 9));
    const auto solved = call(folder, {"solve", "p.hdf5", "--json"});
    CHECK_MESSAGE(solved.exit_code == 0, solved.out);
    const auto json = nlohmann::json::parse(solved.out);
    CHECK(residual > 0);
    CHECK(json.at("contacts") > 10);
    CHECK(json.at("stored_residual").get<double>() == doctest::Approx(residual).epsilon(1e-10));
    CHECK(json.at("natural_map_residual") <= 1e-8);

    CHECK(call(folder, {"export", "run", "--to", "fclib"}).exit_code == 2);
    CHECK(call(folder, {"export", "run", "--to", "fclib", "--step", "0"}).exit_code == 2);
    CHECK(call(folder, {"export", "run", "--to", "csv", "--step", "3"}).exit_code == 2);
    const auto late = call(folder, {"export", "run", "--to", "fclib", "--step", "99999"});
    CHECK(late.exit_code == 2);
    CHECK(late.err.find("has no step 99999: it ended after") != std::string::npos);
  }
}
