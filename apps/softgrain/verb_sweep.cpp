#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "python_program.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct SweepArguments {
  CaseArguments the_case;
  std::vector<std::string> varied, columns;
  std::string output;
  int jobs = 0;    ///< 0: one per core
  int index = -1;  ///< -1: all runs
  bool list = false, slurm = false, snakemake = false;
};

std::vector<std::string> words_of(const SweepArguments& arguments) {
  std::vector<std::string> words{"--output=" + arguments.output};
  for (const std::string& word : arguments.the_case.sets) words.push_back("--set=" + word);
  for (const std::string& word : arguments.varied) words.push_back("--vary=" + word);
  for (const std::string& name : arguments.columns) words.push_back("--column=" + name);
  if (arguments.jobs > 0) words.push_back("--jobs=" + std::to_string(arguments.jobs));
  if (arguments.index >= 0) words.push_back("--index=" + std::to_string(arguments.index));
  if (arguments.list) words.emplace_back("--list");
  if (arguments.slurm) words.emplace_back("--slurm");
  if (arguments.snakemake) words.emplace_back("--snakemake");
  words.emplace_back("--");
  words.push_back(arguments.the_case.path);
  return words;
}

void add_sweep_options(CLI::App& verb, SweepArguments& arguments) {
  add_case_arguments(verb, arguments.the_case);
  verb.add_option("--vary", arguments.varied, "a key and its values: 0,0.1,0.5 or 1..5; may be repeated")
      ->type_name("KEY=VALUES")
      ->allow_extra_args(false)
      ->required();
  verb.add_option("-o,--output", arguments.output, "directory: DIR/runs/NAME, DIR/results.csv, DIR/sweep.png")
      ->type_name("DIR")
      ->required();
  verb.add_option("-j,--jobs", arguments.jobs, "runs at a time (default: one per core)")->check(at_least_one);
  verb.add_option("--column", arguments.columns,
                  "column of series.csv for the table and the figure; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  auto* list = verb.add_flag("--list", arguments.list, "number the runs, and run nothing");
  auto* index = verb.add_option("--index", arguments.index, "carry out one run of the list, for job arrays")
                    ->check(CLI::NonNegativeNumber);
  auto* slurm = verb.add_flag("--slurm", arguments.slurm, "write DIR/array.sh for sbatch, and run nothing");
  auto* snakemake = verb.add_flag("--snakemake", arguments.snakemake, "write DIR/Snakefile, and run nothing");
  list->excludes(index)->excludes(slurm)->excludes(snakemake);
  index->excludes(slurm)->excludes(snakemake);
  slurm->excludes(snakemake);
}

}  // namespace

void add_sweep_verb(CLI::App& app) {
  auto* verb = app.add_subcommand("sweep", "Run a case with some of its values varied; sum the runs up");
  auto arguments = std::make_shared<SweepArguments>();
  add_sweep_options(*verb, *arguments);
  verb->footer(
      "Examples:\n"
      "  softgrain sweep case.toml --vary contact.friction=0,0.1,0.5 --vary sample.seed=1..5 -o friction -j "
      "2\n"
      "  softgrain sweep case.toml --vary sample.seed=1..100 -o seeds --slurm    then: sbatch "
      "seeds/array.sh\n"
      "\nCalled again it does what is not done yet. A run that fails does not stop the others: exit code "
      "3;\n5 if "
      "all are done, but some not to be trusted.\n"
      "Needs Python with NumPy, for the figure Matplotlib and h5py: /usr/bin/python3, or what "
      "SOFTGRAIN_PYTHON names.");
  verb->callback([arguments] { become_python("sweep", words_of(*arguments)); });
}

}  // namespace softgrain
