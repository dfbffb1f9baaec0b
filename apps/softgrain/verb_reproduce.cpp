#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "python_program.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct ReproduceArguments {
  std::string figure = "all", scale = "quick", output;
  int jobs = 0;
};

[[noreturn]] void reproduce(const ReproduceArguments& arguments) {
  std::vector<std::string> words{arguments.figure, "--scale", arguments.scale,
                                 "--output=" + arguments.output};
  if (arguments.jobs > 0) words.push_back("--jobs=" + std::to_string(arguments.jobs));
  become_python("reproduce", std::move(words));
}

}  // namespace

void add_reproduce_verb(CLI::App& app) {
  auto* verb = app.add_subcommand(
      "reproduce", "Make the paper's figures, and hold each of its statements against the runs");
  auto arguments = std::make_shared<ReproduceArguments>();
  verb->add_option("FIGURE", arguments->figure, "fig1, fig2, fig3, fig4 or all")
      ->check(CLI::IsMember({"fig1", "fig2", "fig3", "fig4", "all"}).description(""))
      ->capture_default_str();
  verb->add_option("--scale", arguments->scale,
                   "quick: 20 grains, three seeds, a minute; paper: its full size, ten minutes")
      ->check(CLI::IsMember({"quick", "paper"}).description(""))
      ->capture_default_str();
  verb->add_option("-o,--output", arguments->output, "where runs, figures and verdicts go")
      ->required()
      ->type_name("DIR");
  verb->add_option("-j,--jobs", arguments->jobs, "runs at a time (default: one for each processor)")
      ->check(at_least_one)
      ->type_name("N");
  verb->footer(
      "Writes DIR/fig1.png .. fig4.png, pictures of the packings, the curves as CSV, verdicts.md and "
      "verdicts.json,\n"
      "and the runs below DIR/runs. Called again, it goes on with the runs that are missing. Exit code 5: a "
      "run "
      "is not\nto be trusted.\n\n"
      "Examples:\n"
      "  softgrain reproduce all -o out/paper\n"
      "  softgrain reproduce fig3 --scale paper -o out/full --jobs 2\n"
      "\nNeeds Python with Matplotlib and h5py: /usr/bin/python3, or what SOFTGRAIN_PYTHON names.");
  verb->callback([arguments] { reproduce(*arguments); });
}

}  // namespace softgrain
