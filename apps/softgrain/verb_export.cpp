#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "python_verbs.hpp"
#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/format/fclib.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/run/run_directory.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

struct FclibArguments {
  std::string run, file;
  std::int64_t step = 0;
};

/// A run as it was after a step: from the newest intact snapshot that is not younger, and on from there.
std::unique_ptr<Simulation> simulation_after(const RunPaths& paths, std::int64_t step) {
  auto simulation = create_simulation(read_case(paths.case_file().string()));
  auto snapshots = list_snapshots(paths);
  std::erase_if(snapshots, [&](const SnapshotFile& snapshot) { return snapshot.step > step; });
  for (bool restored = false; !restored; snapshots.pop_back()) {
    require(!snapshots.empty(), "{} has no intact snapshot at or before step {}",
            paths.snapshot_folder().string(), step);
    try {
      const Snapshot snapshot = read_snapshot(snapshots.back().path);
      require(snapshot.case_text == read_file(paths.case_file()),
              "{} is not the case that the run was begun with", paths.case_file().string());
      simulation->restore(snapshot.checkpoint);
      restored = true;
    } catch (const IoError& error) {
      print_error(fmt::format("warning: skipped a snapshot: {}", error.what()));
    }
  }
  while (simulation->steps_done() < step && !simulation->finished()) simulation->step();
  return simulation;
}

void export_contact_problem(const FclibArguments& arguments) {
  require(arguments.step >= 1, "--to fclib needs the step whose contact problem is wanted: --step N, from 1");
  const RunPaths paths{arguments.run};
  require(fs::exists(paths.run_file()), "{} is not a run's directory: it has no run.json", arguments.run);
  const auto simulation = simulation_after(paths, arguments.step - 1);
  require(simulation->steps_done() == arguments.step - 1 && !simulation->finished(),
          "{} has no step {}: it ended after {}", arguments.run, arguments.step, simulation->steps_done());
  const SolvedContactProblem solved = in_natural_units(simulation->step_and_catch_problem());
  require(solved.problem.contacts() > 0, "step {} has no contacts", arguments.step);

  fs::path file = arguments.file;
  if (file.empty()) {
    file = paths.root / "export" / fmt::format("step{:06}.hdf5", arguments.step);
    fs::create_directories(file.parent_path());
  }
  write_fclib(file, solved);
  print_result(fmt::format("{}: {} contacts, {} entries of W, residual {:.10e} of the step's own impulses\n",
                           file.string(), solved.problem.contacts(), solved.problem.W.size(),
                           assess_impulses(solved, 0).residual));
}

}  // namespace

void add_export_verb(CLI::App& app) {
  auto* verb = add_python_verb(app, "export");
  verb->callback([verb] {
    const bool fclib = verb->get_option("--to")->as<std::string>() == "fclib";
    const auto* step = verb->get_option("--step");
    require(fclib || step->count() == 0, "--step belongs to --to fclib; snapshots are chosen by --frame");
    if (!fclib) carry_out_in_python(*verb);
    require(verb->get_option("--frame")->count() == 0, "--to fclib takes --step, not --frame");
    const auto* file = verb->get_option("--output");
    export_contact_problem({.run = verb->get_option("RUN")->as<std::string>(),
                            .file = file->count() > 0 ? file->as<std::string>() : "",
                            .step = step->count() > 0 ? step->as<std::int64_t>() : 0});
  });
}

}  // namespace softgrain
