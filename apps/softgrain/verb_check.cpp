#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "softgrain/experiment/adhesion_of_case.hpp"
#include "softgrain/experiment/advice.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/ranks_estimate.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/case/checked_case.hpp"
#include "softgrain/io/case/scope.hpp"
#include "softgrain/io/run/progress.hpp"
#include "softgrain/material/any_law.hpp"
#include "verbs.hpp"

namespace softgrain {

std::vector<std::string> notes_of(const CaseReading& reading) {
  std::vector<std::string> notes = reading.notes;
  for (std::string& note : notes_on_effect(reading.the_case, reading.without_effect))
    notes.push_back(std::move(note));
  const auto& stages = reading.the_case.stages;
  for (std::size_t number = 0; number < stages.size(); ++number)
    if (stages[number].repeats_in_vain())
      notes.push_back(
          fmt::format("note: {}: repeat has no effect, as the first turn leads to its end; give "
                      "until.time, or repeat_from a stage that leads back",
                      stages[number].title(number)));
  const Case::Box& box = reading.the_case.box;
  const bool falls = box.gravity_x != 0 || box.gravity_y != 0 || box.gravity_z != 0;
  for (std::size_t number = 0; number < stages.size() && falls && is_bonded(reading.the_case); ++number)
    if (stages[number].until.rest)
      notes.push_back(
          fmt::format("note: {}: bonded grains store so much by their attraction that a fall counts as rest; "
                      "end it by until.time alone",
                      stages[number].title(number)));
  if (!is_elastic(reading.the_case)) return notes;
  const std::string_view caution = law_choice(reading.the_case.mpm.law).caution;
  if (!caution.empty()) notes.push_back(fmt::format("note: mpm.law: {}", caution));
  return notes;
}

namespace {

/// Elastic grains in space do not adhere.
AdhesionAdvice adhesion_advice(const Case& the_case) {
  Case adhering = the_case;
  if (!is_bonded(the_case) && is_in_space(the_case)) adhering.contact = {};
  return advise_on_adhesion(adhering);
}

struct CheckOptions {
  CaseArguments arguments;
  int ranks = 1;
  bool json = false;
};

/// A number where JSON has one: infinity is null.
nlohmann::ordered_json finite(double number) {
  return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json(nullptr);
}

void print_json(const CaseReading& reading, const Estimate& estimate, const Advice& advice, int ranks) {
  const AdhesionAdvice adhesion = adhesion_advice(reading.the_case);
  const RanksEstimate together = estimate_on_ranks(reading.the_case, estimate, ranks);
  const nlohmann::ordered_json result{{"case", nlohmann::ordered_json::parse(case_json(reading.the_case))},
                                      {"estimate",
                                       {{"particles", estimate.particles},
                                        {"contacts", estimate.contacts},
                                        {"steps", estimate.steps},
                                        {"memory_bytes", estimate.memory},
                                        {"disk_bytes", estimate.disk},
                                        {"hours", estimate.hours}}},
                                      {"ranks",
                                       {{"count", ranks},
                                        {"useful", together.useful},
                                        {"hours", together.hours},
                                        {"memory_bytes_each", together.memory}}},
                                      {"advice",
                                       {{"time_step", advice.time_step},
                                        {"longest_step", finite(advice.longest_step)},
                                        {"inertial_number", advice.inertial_number},
                                        {"stress", advice.stress},
                                        {"blow", advice.blow},
                                        {"mach", advice.mach},
                                        {"hold", finite(advice.hold)},
                                        {"cohesive_zone", finite(adhesion.zone)}}},
                                      {"without_effect", reading.without_effect},
                                      {"notes", notes_of(reading)}};
  fmt::print("{}\n", result.dump(2));
}

void print_estimate(const Case& the_case, const Estimate& estimate) {
  const bool bpm = is_bonded(the_case);
  const auto count = [](double number) { return grouped(std::llround(number)); };
  fmt::print(stderr,
             "{} {}, about {} contacts\n"
             "about {} time steps\n"
             "about {:.0f} MB of memory, {:.0f} MB of disk\n"
             "about {} on one thread\n",
             count(estimate.particles),
             is_mixed(the_case) ? "primary particles and material points"
             : bpm              ? "primary particles"
                                : "material points",
             count(estimate.contacts), count(estimate.steps), estimate.memory / 1e6, estimate.disk / 1e6,
             duration_text(3600 * estimate.hours));
}

void print_estimate_on_ranks(const Case& the_case, const Estimate& alone, int ranks) {
  const RanksEstimate together = estimate_on_ranks(the_case, alone, ranks);
  fmt::print(stderr, "about {} on {} ranks of softgrain-mpi, by a model, with {:.0f} MB in the first\n",
             duration_text(3600 * together.hours), ranks, together.memory / 1e6);
  if (together.useful < ranks)
    fmt::print(stderr, "note: only {} of the ranks have work: {}\n", together.useful,
               together.useful > 1 ? "elastic grains are shared in batches of eight, bonded ones one by one"
                                   : "nothing of this case is shared");
}

/// Of AdhesionAdvice: segments in a cohesive zone, radii in a range.
constexpr double least_zone = 2, least_reach = 5;

void print_advice_on_adhesion(const Case& the_case) {
  const AdhesionAdvice advice = adhesion_advice(the_case);
  if (advice.zone < least_zone)
    fmt::print(
        stderr,
        "warning: where surfaces part, the zone that attracts spans {:.1g} vertices of the outline, and "
        "they hold or let go vertex by vertex: raise contact.adhesion_range or mpm.cells\n",
        advice.zone);
  if (advice.reach < least_reach)
    fmt::print(
        stderr,
        "warning: surfaces attract each other up to {:.2g} of the smallest radius, as far as the shape "
        "of the grains tells: lower contact.adhesion_range or the surface energy\n",
        1 / advice.reach);
}

/// Of Advice::blow, for grains that are pressed.
constexpr double most_of_a_blow = 0.1;

/// Of Advice::mach, for grains that are not crushed by the first wave.
constexpr double most_of_mach = 0.3;

/// Of Advice::imbalance, for what springs back to be right.
constexpr double most_of_an_imbalance = 0.03;

/// "below 1e-3, quasi-static".
std::string_view word_for(double inertial_number) {
  if (inertial_number < 1.0001e-3) return "below 1e-3: quasi-static";
  return inertial_number < 1e-1 ? "above 1e-3: inertia tells" : "above 0.1: a blow";
}

void print_advice(const Advice& advice, double newton_tolerance) {
  const auto text = [](double value, const char* unit) { return short_value({"", unit, value}); };
  fmt::print(stderr, "time step {}", text(advice.time_step, "s"));
  if (std::isfinite(advice.longest_step))
    fmt::print(stderr, ", {:.2g} of the longest stable one", advice.time_step / advice.longest_step);
  if (advice.inertial_number > 0)
    fmt::print(stderr, "\ninertial number about {:.1e} at {}, {}\n", advice.inertial_number,
               text(advice.stress, "Pa"), word_for(advice.inertial_number));
  else
    fmt::print(stderr, "\ninertial number 0: no wall moves\n");
  if (advice.blow > most_of_a_blow)
    fmt::print(stderr,
               "warning: walls at this speed strike with rho c v = {:.2g} times the yield stress, and points "
               "may turn inside out: lower loading.wall_velocity to below {:.1g} of what it is\n",
               advice.blow, most_of_a_blow / advice.blow);
  if (advice.mach > most_of_mach)
    fmt::print(
        stderr,
        "warning: the walls move at {:.2g} times the speed of pressure waves in the grains, and points "
        "may turn inside out: lower loading.wall_velocity to below {:.1g} of what it is\n",
        advice.mach, most_of_mach / advice.mach);
  if (advice.imbalance > most_of_an_imbalance)
    fmt::print(
        stderr,
        "warning: mpm.tolerance leaves stresses of about {:.2g} times the yield stress unbalanced, and "
        "what springs back may be wrong: lower it to {:.0e}\n",
        advice.imbalance, newton_tolerance * most_of_an_imbalance / advice.imbalance / 3);
  if (advice.hold < Advice::least_hold)
    fmt::print(
        stderr,
        "warning: a stress is kept for {:.2g} times as long as a wave takes through the box, and judged from "
        "half of that on, while walls may still come in: keep it for {:.1g} times as long\n",
        advice.hold, std::ceil(Advice::least_hold / advice.hold));
  if (advice.time_step > advice.longest_step)
    fmt::print(stderr,
               "warning: the time step is {:.2g} times the longest stable one, {}: take that, or less\n",
               advice.time_step / advice.longest_step, text(advice.longest_step, "s"));
}

void check(const CheckOptions& options) {
  const CaseReading reading = read_case_with_notes(options.arguments.path, options.arguments.sets);
  const Case& the_case = reading.the_case;
  check_case(reading);
  const Estimate cost = estimate(the_case);
  const Advice advice = advise(the_case);
  if (options.json) return print_json(reading, cost, advice, options.ranks);
  fmt::print("{}", resolved_case_text(the_case));
  std::fflush(stdout);
  print_estimate(the_case, cost);
  if (options.ranks > 1) print_estimate_on_ranks(the_case, cost, options.ranks);
  print_advice(advice, the_case.mpm.tolerance);
  print_advice_on_adhesion(the_case);
  for (const std::string& note : notes_of(reading)) fmt::print(stderr, "{}\n", note);
}

}  // namespace

void add_check_verb(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "Check a case; print it resolved, and what it will cost");
  add_case_arguments(*verb, options->arguments);
  verb->add_option("--ranks", options->ranks, "what so many ranks of softgrain-mpi would take")
      ->check(CLI::Range(1, 1000000));
  verb->add_flag("--json", options->json, "resolved case and estimate as JSON");
  verb->footer(
      "Examples:\n"
      "  softgrain check squeeze/case.toml\n"
      "  softgrain check squeeze/case.toml --set contact.wall_friction=0.3 --set time.step=\"0.2 us\" > "
      "resolved.toml");
  verb->callback([options] { check(*options); });
}

}  // namespace softgrain
