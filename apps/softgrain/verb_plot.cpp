#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/core/version.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct PlotArguments {
  std::vector<std::string> runs;
  std::string output, format = "png", kind = "all";
  bool normalise = false;
};

const char* python() {
  const char* chosen = std::getenv("SOFTGRAIN_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

std::vector<std::string> command_of(const PlotArguments& arguments) {
  const std::string program = std::string(build_info().share_directory) + "/python/plot.py";
  std::vector<std::string> words{python(), program, "--format", arguments.format, "--kind", arguments.kind};
  if (!arguments.output.empty()) words.push_back("--output=" + arguments.output);
  if (arguments.normalise) words.emplace_back("--normalise");
  words.emplace_back("--");
  words.insert(words.end(), arguments.runs.begin(), arguments.runs.end());
  return words;
}

/// Becomes the Python program, so that its exit code and its signals are ours. Returns only to raise
/// UsageError.
void plot(const PlotArguments& arguments) {
  std::vector<std::string> words = command_of(arguments);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::fflush(nullptr);
  execvp(argv[0], argv.data());
  throw UsageError(
      fmt::format("cannot start {}: {}; `softgrain plot` needs Python: on Debian,\n"
                  "  apt install python3-matplotlib python3-h5py\n"
                  "SOFTGRAIN_PYTHON names another interpreter",
                  argv[0], std::strerror(errno)));
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
  verb->callback([arguments] { plot(*arguments); });
}

}  // namespace softgrain
