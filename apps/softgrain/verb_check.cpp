#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/io/case_file.hpp"
#include "softgrain/io/case_text.hpp"
#include "verbs.hpp"

namespace softgrain {
namespace {

struct CheckOptions {
  CaseArguments arguments;
  bool json = false;
};

void print_json(const Case& the_case, const Estimate& estimate) {
  const nlohmann::ordered_json result{{"case", nlohmann::ordered_json::parse(case_json(the_case))},
                                      {"estimate",
                                       {{"primaries", estimate.primaries},
                                        {"contacts", estimate.contacts},
                                        {"steps", estimate.steps},
                                        {"memory_bytes", estimate.memory},
                                        {"hours", estimate.hours}}}};
  fmt::print("{}\n", result.dump(2));
}

void print_estimate(const Estimate& estimate) {
  fmt::print(stderr,
             "{} primary particles, about {} contacts\n"
             "{} time steps\n"
             "about {:.0f} MB of memory\n"
             "at most {:.2g} h on one thread (every step with all sweeps)\n",
             estimate.primaries, estimate.contacts, estimate.steps, estimate.memory / 1e6, estimate.hours);
}

void check(const CheckOptions& options) {
  const Case the_case = read_case(options.arguments.path, options.arguments.sets);
  const Estimate cost = estimate(the_case);
  if (options.json) return print_json(the_case, cost);
  fmt::print("{}", resolved_case_text(the_case));
  std::fflush(stdout);
  print_estimate(cost);
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
