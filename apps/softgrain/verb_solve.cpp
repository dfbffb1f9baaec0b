#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "choices.hpp"
#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/format/fclib.hpp"
#include "verbs.hpp"

namespace softgrain {
namespace {

constexpr int not_converged = 3;

struct SolveOptions {
  std::string path, output;
  std::string method = "auto";
  ContactProblemOptions solver;
  bool json = false;
};

const char* name_of(ContactMethod method) { return method == ContactMethod::nlgs ? "nlgs" : "nesterov"; }

struct Outcome {
  ContactProblem problem;
  std::optional<double> stored_residual;  ///< of the file's own solution, if it has impulses
  ContactSolution solution;
  double cpu_seconds = 0;  ///< of solving, without reading
};

void print_json(const SolveOptions& options, const Outcome& outcome) {
  nlohmann::ordered_json result{{"file", options.path},
                                {"method", name_of(outcome.solution.method)},
                                {"contacts", outcome.problem.contacts()},
                                {"dimension", outcome.problem.dimension},
                                {"sweeps", outcome.solution.sweeps},
                                {"natural_map_residual", outcome.solution.residual},
                                {"energy", outcome.solution.energy},
                                {"cpu_seconds", outcome.cpu_seconds},
                                {"converged", outcome.solution.converged},
                                {"tolerance", options.solver.tolerance}};
  if (outcome.stored_residual) result["stored_residual"] = *outcome.stored_residual;
  fmt::print("{}\n", result.dump(2));
}

void print_table(const SolveOptions& options, const Outcome& outcome) {
  const ContactSolution& solution = outcome.solution;
  fmt::print(
      "problem   {}: {} contacts in {}D\n"
      "method    {}, {} {}\n"
      "residual  {:.3g} ({} {:g}): natural map over |q|\n"
      "energy    {:.12g}: p.W p / 2 + q.p\n"
      "time      {:.3g} CPU s\n",
      options.path, outcome.problem.contacts(), outcome.problem.dimension, name_of(solution.method),
      solution.sweeps, solution.method == ContactMethod::nlgs ? "sweeps" : "iterations", solution.residual,
      solution.converged ? "converged to" : "NOT converged to", options.solver.tolerance, solution.energy,
      outcome.cpu_seconds);
  if (outcome.stored_residual)
    fmt::print("stored    residual {:.10e} of the solution in the file\n", *outcome.stored_residual);
}

void solve(SolveOptions& options) {
  require(options.solver.tolerance >= 0, "--tolerance must be >= 0, got {}", options.solver.tolerance);
  options.solver.method = options.method == "auto"   ? ContactMethod::automatic
                          : options.method == "nlgs" ? ContactMethod::nlgs
                                                     : ContactMethod::nesterov;
  require(options.output.empty() || !std::filesystem::exists(options.output) ||
              !std::filesystem::equivalent(options.output, options.path),
          "--output {} is the problem itself; give another file", options.output);
  Outcome outcome;
  FclibFile file = read_fclib(options.path);
  outcome.problem = std::move(file.problem);
  if (std::ranges::any_of(file.stored_impulse, [](double p) { return p != 0; }))
    outcome.stored_residual = assess_impulses({outcome.problem, file.stored_impulse}, 0).residual;
  const std::clock_t start = std::clock();
  outcome.solution = solve_contact_problem(outcome.problem, options.solver);
  outcome.cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (!options.output.empty())
    write_fclib(options.output, {.problem = outcome.problem, .impulse = outcome.solution.impulse});
  options.json ? print_json(options, outcome) : print_table(options, outcome);
  if (!outcome.solution.converged) throw ExitCode{not_converged};
}

}  // namespace

void add_solve_verb(CLI::App& app) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App* verb = app.add_subcommand("solve", "Solve a frictional contact problem in FCLIB's HDF5 format");
  verb->add_option("FILE", options->path, "local (W, q, mu) or global (M, H, f, w, mu) problem")->required();
  verb->add_option(
      "-o,--output", options->output,
      "HDF5 file for the problem, local, and its solution: impulses solution/r, velocities solution/u");
  auto* method = verb->add_option("--method", options->method,
                                  "nesterov, nlgs, or auto: both by turns until one converges");
  take_one_of(method, {"auto", "nesterov", "nlgs"})->capture_default_str();
  verb->add_option("--tolerance", options->solver.tolerance, "on the natural-map residual over |q|")
      ->capture_default_str();
  verb->add_option("--max-sweeps", options->solver.max_sweeps, "sweeps of nlgs, iterations of nesterov, each")
      ->check(CLI::Range(0, 2000000000))
      ->capture_default_str();
  verb->add_flag("--json", options->json, "one JSON object on stdout");
  verb->footer(
      "Exit code 3: not converged; the best that was found is printed and written all the same.\n"
      "Examples:\n"
      "  softgrain solve problem.hdf5\n"
      "  softgrain solve problem.hdf5 -o solution.hdf5      r and u of all contacts, for h5py: "
      "f[\"solution/r\"][:]\n"
      "  softgrain solve problem.hdf5 --method nlgs --tolerance 1e-5 --json");
  verb->callback([options] { solve(*options); });
}

}  // namespace softgrain
