#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "python_program.hpp"
#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case_file.hpp"
#include "softgrain/io/fclib.hpp"
#include "softgrain/io/run_directory.hpp"
#include "softgrain/io/snapshot.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

struct ExportArguments {
  std::string run, format, frame, file;
  std::int64_t step = 0;
};

std::vector<std::string> words_of(const ExportArguments& arguments) {
  std::vector<std::string> words{"--to=" + arguments.format};
  if (!arguments.frame.empty()) words.push_back("--frame=" + arguments.frame);
  if (!arguments.file.empty()) words.push_back("--output=" + arguments.file);
  words.emplace_back("--");
  words.push_back(arguments.run);
  return words;
}

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

void export_contact_problem(const ExportArguments& arguments) {
  require(arguments.step >= 1, "--to fclib needs the step whose contact problem is wanted: --step N, from 1");
  require(arguments.frame.empty(), "--to fclib takes --step, not --frame");
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
  auto* verb = app.add_subcommand("export", "Write snapshots for other programs");
  auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("RUN", arguments->run, "a run's directory")->required();
  verb->add_option("--to", arguments->format, "xyz, lammps, csv, svg or fclib")
      ->check(CLI::IsMember({"xyz", "lammps", "csv", "svg", "fclib"}).description(""))
      ->type_name("FORMAT")
      ->required();
  verb->add_option("--frame", arguments->frame,
                   "snapshot, from 0, or from the end: -1 (default: all; csv and svg: the last)")
      ->check(CLI::TypeValidator<int>().description(""))
      ->type_name("N");
  verb->add_option("--step", arguments->step, "of the run, from 1: whose contact problem fclib writes")
      ->type_name("N");
  verb->add_option("-o,--output", arguments->file, "where it goes (default: RUN/export/NAME)")
      ->type_name("FILE");
  verb->footer(
      "Examples:\n"
      "  softgrain export squeeze/case_run --to xyz          all frames, extended XYZ: opens in OVITO\n"
      "  softgrain export squeeze/case_run --to svg --frame -1 -o end.svg\n"
      "  softgrain export squeeze/case_run --to fclib --step 400   what that step had to solve; "
      "`softgrain solve` reads it\n"
      "\nxyz, lammps: particles with radius, grain and pressure. csv: all fields of the particles. svg: a "
      "picture.\n"
      "fclib: W, q and mu of one step, made again from the snapshot before it.\n"
      "All but fclib need Python with NumPy and h5py: /usr/bin/python3, or what SOFTGRAIN_PYTHON names.");
  verb->callback([arguments] {
    if (arguments->format == "fclib") return export_contact_problem(*arguments);
    require(arguments->step == 0, "--step belongs to --to fclib; snapshots are chosen by --frame");
    become_python("export", words_of(*arguments));
  });
}

}  // namespace softgrain
