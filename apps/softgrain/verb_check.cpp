#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/io/case_file.hpp"
#include "softgrain/io/case_text.hpp"
#include "softgrain/io/progress.hpp"
#include "softgrain/material/any_law.hpp"
#include "verbs.hpp"

namespace softgrain {

std::string caution_of(const Case& the_case) {
  if (the_case.experiment.model != "mpm") return "";
  const std::string_view caution = law_choice(the_case.mpm.law).caution;
  return caution.empty() ? "" : fmt::format("note: mpm.law: {}", caution);
}

namespace {

struct CheckOptions {
  CaseArguments arguments;
  bool json = false;
};

void print_json(const Case& the_case, const Estimate& estimate) {
  const nlohmann::ordered_json result{{"case", nlohmann::ordered_json::parse(case_json(the_case))},
                                      {"estimate",
                                       {{"particles", estimate.particles},
                                        {"contacts", estimate.contacts},
                                        {"steps", estimate.steps},
                                        {"memory_bytes", estimate.memory},
                                        {"disk_bytes", estimate.disk},
                                        {"hours", estimate.hours}}}};
  fmt::print("{}\n", result.dump(2));
}

void print_estimate(const Case& the_case, const Estimate& estimate) {
  const bool bpm = the_case.experiment.model == "bpm";
  const auto count = [](double number) { return grouped(std::llround(number)); };
  fmt::print(stderr,
             "{} {}, about {} contacts\n"
             "about {} time steps\n"
             "about {:.0f} MB of memory, {:.0f} MB of disk\n"
             "about {} on one thread\n",
             count(estimate.particles), bpm ? "primary particles" : "material points",
             count(estimate.contacts), count(estimate.steps), estimate.memory / 1e6, estimate.disk / 1e6,
             duration_text(3600 * estimate.hours));
}

void check(const CheckOptions& options) {
  const Case the_case = read_case(options.arguments.path, options.arguments.sets);
  const Estimate cost = estimate(the_case);
  if (options.json) return print_json(the_case, cost);
  fmt::print("{}", resolved_case_text(the_case));
  std::fflush(stdout);
  print_estimate(the_case, cost);
  if (const std::string caution = caution_of(the_case); !caution.empty()) fmt::print(stderr, "{}\n", caution);
}

}  // namespace

void add_check_verb(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "Check a case; print it resolved, and what it will cost");
  add_case_arguments(*verb, options->arguments);
  verb->add_flag("--json", options->json, "resolved case and estimate as JSON");
  verb->footer(
      "Examples:\n"
      "  softgrain check squeeze/case.toml\n"
      "  softgrain check squeeze/case.toml --set contact.friction=0.3 --set time.step=\"0.2 us\" > "
      "resolved.toml");
  verb->callback([options] { check(*options); });
}

}  // namespace softgrain
