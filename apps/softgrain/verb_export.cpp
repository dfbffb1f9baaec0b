#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "python_program.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct ExportArguments {
  std::string run, format, frame, file;
};

std::vector<std::string> words_of(const ExportArguments& arguments) {
  std::vector<std::string> words{"--to=" + arguments.format};
  if (!arguments.frame.empty()) words.push_back("--frame=" + arguments.frame);
  if (!arguments.file.empty()) words.push_back("--output=" + arguments.file);
  words.emplace_back("--");
  words.push_back(arguments.run);
  return words;
}

}  // namespace

void add_export_verb(CLI::App& app) {
  auto* verb = app.add_subcommand("export", "Write snapshots for other programs");
  auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("RUN", arguments->run, "a run's directory")->required();
  verb->add_option("--to", arguments->format, "xyz, lammps, csv or svg")
      ->check(CLI::IsMember({"xyz", "lammps", "csv", "svg"}).description(""))
      ->type_name("FORMAT")
      ->required();
  verb->add_option("--frame", arguments->frame,
                   "snapshot, from 0, or from the end: -1 (default: all; csv and svg: the last)")
      ->check(CLI::TypeValidator<int>().description(""))
      ->type_name("N");
  verb->add_option("-o,--output", arguments->file, "where it goes (default: RUN/export/NAME)")
      ->type_name("FILE");
  verb->footer(
      "Examples:\n"
      "  softgrain export squeeze/case_run --to xyz          all frames, extended XYZ: opens in OVITO\n"
      "  softgrain export squeeze/case_run --to svg --frame -1 -o end.svg\n"
      "\nxyz, lammps: particles with radius, grain and pressure. csv: all fields of the particles. svg: a "
      "picture.\n"
      "Needs Python with NumPy and h5py: /usr/bin/python3, or what SOFTGRAIN_PYTHON names.");
  verb->callback([arguments] { become_python("export", words_of(*arguments)); });
}

}  // namespace softgrain
