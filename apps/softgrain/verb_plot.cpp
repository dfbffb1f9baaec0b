#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "python_program.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct PlotArguments {
  std::vector<std::string> runs;
  std::string output, format = "png", kind = "all";
  bool normalise = false;
};

std::vector<std::string> words_of(const PlotArguments& arguments) {
  std::vector<std::string> words{"--format", arguments.format, "--kind", arguments.kind};
  if (!arguments.output.empty()) words.push_back("--output=" + arguments.output);
  if (arguments.normalise) words.emplace_back("--normalise");
  words.emplace_back("--");
  words.insert(words.end(), arguments.runs.begin(), arguments.runs.end());
  return words;
}

}  // namespace

void add_plot_verb(CLI::App& app) {
  auto* verb = app.add_subcommand("plot", "draw the figures of one run, or of several runs in one curve");
  auto arguments = std::make_shared<PlotArguments>();
  verb->add_option("DIR", arguments->runs, "directories of runs")->required();
  verb->add_option("-o,--output", arguments->output,
                   "where the figures go (default: DIR/figures; ./figures for several runs)")
      ->type_name("DIR");
  verb->add_option("--format", arguments->format, "png, svg or pdf")
      ->check(CLI::IsMember({"png", "svg", "pdf"}).description(""))
      ->type_name("FORMAT");
  verb->add_option("--kind", arguments->kind, "curve, grain, diagnostics or all")
      ->check(CLI::IsMember({"curve", "grain", "diagnostics", "all"}).description(""))
      ->type_name("KIND");
  verb->add_flag("--normalise", arguments->normalise, "stress over the characteristic stress F0/<a0>");
  verb->footer(
      "Examples:\n"
      "  softgrain plot squeeze/case_run                     into squeeze/case_run/figures\n"
      "  softgrain plot slow fast --kind curve --format svg  two runs in one curve\n"
      "\nNeeds Python with Matplotlib and h5py: /usr/bin/python3, or what SOFTGRAIN_PYTHON names.");
  verb->callback([arguments] { become_python("plot", words_of(*arguments)); });
}

}  // namespace softgrain
