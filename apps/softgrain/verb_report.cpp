#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/io/page/report_page.hpp"
#include "softgrain/io/run/run_directory.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

struct ReportArguments {
  std::vector<std::string> runs;
  std::string page;
};

void report(const ReportArguments& arguments) {
  const std::vector<fs::path> runs(arguments.runs.begin(), arguments.runs.end());
  const fs::path beside = runs.size() == 1 ? RunPaths{runs.front()}.report_file() : fs::path("report.html");
  const fs::path page = arguments.page.empty() ? beside : fs::path(arguments.page);
  for (const std::string& warning : write_report(runs, page)) print_error("warning: left out: " + warning);
  print_result(
      fmt::format("{}: {:.2f} MB\n", page.string(), 1e-6 * static_cast<double>(fs::file_size(page))));
}

}  // namespace

void add_report_verb(CLI::App& app) {
  auto* verb = app.add_subcommand("report", "Write one page of one or several runs, to look at in a browser");
  auto arguments = std::make_shared<ReportArguments>();
  verb->add_option("RUN", arguments->runs, "directories of runs")->required();
  verb->add_option("-o,--output", arguments->page,
                   "the page (default: RUN/report.html; ./report.html for several runs)")
      ->type_name("FILE");
  verb->footer(
      "Examples:\n"
      "  softgrain report squeeze/case_run                   squeeze/case_run/report.html\n"
      "  softgrain report soft hard -o compare.html          both in the same plots\n"
      "\nThe page needs nothing but a browser: no network, no server. `softgrain run` writes it too.");
  verb->callback([arguments] { report(*arguments); });
}

}  // namespace softgrain
