#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>

#include "choices.hpp"
#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/io/case/case_extension.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/case/checked_case.hpp"
#include "softgrain/io/case/units.hpp"
#include "softgrain/io/page/report_page.hpp"
#include "softgrain/io/run/resources.hpp"
#include "softgrain/io/run/run_origin.hpp"
#include "softgrain/io/run/run_recorder.hpp"
#include "softgrain/io/run/verdict.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// What run and resume have in common.
struct RunOptions {
  std::string directory;
  int threads = 0;  ///< 0: as many as threads() says
  std::string stop_after;
  ProgressStyle progress = ProgressStyle::automatic;
  bool quiet = false;
  bool verbose = false;
};

struct RunArguments {
  CaseArguments the_case;
  RunOptions options;
  std::string from;  ///< "RUN" or "RUN@STEP"
  bool resume = false;
  bool force = false;
};

void add_run_options(CLI::App& verb, RunOptions& options) {
  const std::map<std::string, ProgressStyle> styles{{"auto", ProgressStyle::automatic},
                                                    {"tty", ProgressStyle::tty},
                                                    {"plain", ProgressStyle::plain},
                                                    {"none", ProgressStyle::none}};
  verb.add_option("-j,--threads", options.threads, "threads (default: OMP_NUM_THREADS, or one per core)")
      ->check(at_least_one);
  verb.add_option("--stop-after", options.stop_after,
                  "wall time, as \"90 min\": then write a snapshot and exit with code 75")
      ->type_name("TIME");
  offer(verb.add_option("--progress", options.progress, "auto, tty, plain or none"),
        {"auto", "tty", "plain", "none"})
      ->transform(CLI::CheckedTransformer(styles).description(""))
      ->type_name("STYLE");
  auto* quiet = verb.add_flag("-q,--quiet", options.quiet, "print nothing but errors");
  verb.add_flag("-v,--verbose", options.verbose, "print the log as well")->excludes(quiet);
}

double seconds_of(const std::string& text) {
  if (text.empty()) return std::numeric_limits<double>::infinity();
  const double seconds = parse_quantity(text, {.length = 0, .mass = 0, .time = 1});
  require(seconds > 0, "--stop-after must be positive, got {}", text);
  return seconds;
}

/// What the user reads when the program is back, and what to do next.
std::string closing_words(const RunRecord& record, const Case& c, const RunPaths& paths, bool has_page) {
  std::string reached = verdict_of(record.report, record.path).words;
  for (const std::string& remedy : remedies_of(record.report, c))
    reached += "\nwhat may help against " + remedy;
  const std::string directory = paths.root.string();
  const auto page = has_page ? fmt::format("look at {} in a browser, or ", paths.report_file().string()) : "";
  const auto early =
      record.message.empty() ? "" : fmt::format("ended before the last strain: {}\n", record.message);
  if (record.state == "done")
    return fmt::format("{}{}\nresults in {}; next: {}softgrain plot {}\n", early, reached, directory, page,
                       directory);
  return fmt::format("stopped by {} at {:.1f} %: {}\nresults in {}; go on with: softgrain resume {}\n",
                     record.message, 100 * record.progress, reached, directory, directory);
}

RunRequest request_of(const RunOptions& options, bool resume) {
  RunRequest request;
  request.command = command_line();
  request.stop_after = seconds_of(options.stop_after);
  request.verbose = options.verbose;
  request.resume = resume;
  return request;
}

/// Ranks on one host share its cores, unless the user has shared them out.
int threads_of_rank() {
  return std::getenv("OMP_NUM_THREADS") != nullptr ? threads() : threads() / communicator().ranks_on_host();
}

/// Ranks on one host share its memory.
void require_memory_and_disk(const Case& the_case, const RunPaths& paths) {
  Estimate needed = estimate(the_case);
  const double on_all = needed.memory - needed.shared_memory;
  needed.memory = needed.shared_memory + communicator().ranks_on_host() * on_all;
  require_resources(needed, available_resources(paths.root));
}

/// from: the state to begin with, if any.
void carry_out(const RunRequest& request, const RunDirectory& directory, const RunOptions& options,
               const std::vector<std::string>& notes, const OriginState* from = nullptr) {
  SignalWatch signals;
  set_threads(options.threads > 0 ? options.threads : threads_of_rank());
  const auto simulation = create_any_simulation(request.the_case);
  if (from != nullptr) begin_from(*simulation, *from, request.the_case);
  RunOutcome outcome;
  {
    const bool quiet = options.quiet || communicator().rank() != 0;
    Progress progress(quiet ? ProgressStyle::none : options.progress);
    if (!quiet) progress.message("results go to " + directory.paths().root.string());
    if (!quiet && !options.verbose && !directory.caution().empty()) progress.message(directory.caution());
    if (!quiet)
      for (const std::string& note : notes) progress.message(note);
    outcome = record_run(*simulation, directory, request, progress, signals);
  }
  if (communicator().rank() != 0) {
    if (outcome.exit_code != 0) throw ExitCode{outcome.exit_code};
    return;
  }
  const RunPaths& paths = directory.paths();
  const bool page = request.the_case.output.report && outcome.record.state == "done";
  if (page) write_report({paths.root}, paths.report_file());
  if (!options.quiet) print_result(closing_words(outcome.record, request.the_case, paths, page));
  if (options.quiet && outcome.exit_code == exit_doubtful)
    print_error(verdict_of(outcome.record.report, outcome.record.path).words);
  if (outcome.exit_code != 0) throw ExitCode{outcome.exit_code};
}

/// run.json is a run's sign; where somebody removed it, the snapshots still hold all that going on needs.
bool is_begun(const RunPaths& paths) {
  return fs::exists(paths.run_file()) || !list_snapshots(paths).empty();
}

/// "squeeze_run" beside "squeeze.toml".
fs::path default_directory(const fs::path& case_file) {
  return case_file.parent_path() / (case_file.stem().string() + "_run");
}

void refuse_another_case(const RunRequest& request, const RunPaths& paths, const std::string& name) {
  if (request.case_before == request.case_text) return;
  const std::string why =
      why_no_extension(parse_case(request.case_before, paths.case_file().string()), request.the_case);
  require(
      why.empty(),
      "{} is not the case that {} was begun with: {}; `softgrain resume {}` goes on with the stored one, -o "
      "begins another run",
      name, paths.root.string(), why, paths.root.string());
}

void run_case(const RunArguments& arguments) {
  const CaseArguments& source = arguments.the_case;
  RunRequest request = request_of(arguments.options, arguments.resume);
  const CaseReading reading = read_case_with_notes(source.path, source.sets);
  request.the_case = reading.the_case;
  request.case_text = resolved_case_text(request.the_case);
  const RunPaths paths{arguments.options.directory.empty() ? default_directory(source.path)
                                                           : fs::path(arguments.options.directory)};
  std::error_code no_such_file;
  require(arguments.resume || !fs::equivalent(source.path, paths.case_file(), no_such_file),
          "{} lies in the run's directory and would be overwritten; choose another with -o", source.path);
  const bool going_on = arguments.resume && is_begun(paths);
  if (going_on && fs::exists(paths.case_file())) {  // not when the disk was full from the beginning
    request.case_before = read_file(paths.case_file());
    refuse_another_case(request, paths, source.path);
  }
  check_case(reading);  // before a large sample is prepared, and before there is a directory
  const bool keep = arguments.force || going_on;
  if (!keep) require_memory_and_disk(request.the_case, paths);
  const auto directory = RunDirectory::take(
      paths.root, keep ? RunDirectory::IfNotEmpty::keep : RunDirectory::IfNotEmpty::refuse);
  carry_out(request, *directory, arguments.options, notes_of(reading));
}

/// "RUN_on" beside a run from which another begins.
fs::path directory_beside(const fs::path& run) {
  const fs::path root = run.lexically_normal();
  const fs::path named = root.has_filename() ? root : root.parent_path();
  return named.string() + "_on";
}

/// A new run from a state of another one, with a case of its own or that one's, and what `--set` changes of
/// it.
void run_from(const RunArguments& arguments) {
  const OriginState origin = read_origin(arguments.from);
  RunRequest request = request_of(arguments.options, false);
  const std::string& own = arguments.the_case.path;
  const CaseReading reading =
      read_case_with_notes(own.empty() ? origin.paths.case_file().string() : own, arguments.the_case.sets);
  request.the_case = reading.the_case;
  request.case_text = resolved_case_text(request.the_case);
  request.origins = origin.origins;
  check_case(reading);
  const fs::path beside = own.empty() ? directory_beside(origin.paths.root) : default_directory(own);
  const RunPaths paths{arguments.options.directory.empty() ? beside : fs::path(arguments.options.directory)};
  if (!arguments.force) require_memory_and_disk(request.the_case, paths);
  const auto directory = RunDirectory::take(
      paths.root, arguments.force ? RunDirectory::IfNotEmpty::keep : RunDirectory::IfNotEmpty::refuse);
  carry_out(request, *directory, arguments.options, notes_of(reading), &origin);
}

Case case_to_resume(const std::string& text, const RunPaths& paths) {
  try {
    return parse_case(text, paths.case_file().string());
  } catch (const CaseFileError& error) {
    throw CaseFileError(fmt::format(
        "{}\nthis case meant something else to the version that began the run: resume it with that "
        "version, or begin it anew; info, plot and report still show it",
        error.what()));
  }
}

void resume_run(const RunOptions& options) {
  const RunPaths paths{options.directory};
  require(is_begun(paths), "{} is not a run's directory: it has neither run.json nor snapshots",
          options.directory);
  require(fs::exists(paths.case_file()),
          "{} has no case.toml; `softgrain run CASE -o {} --resume` with the case that it was begun with "
          "writes it again",
          options.directory, options.directory);
  RunRequest request = request_of(options, true);
  const auto directory = RunDirectory::take(paths.root, RunDirectory::IfNotEmpty::keep);
  request.case_text = request.case_before = read_file(paths.case_file());
  request.the_case = case_to_resume(request.case_text, paths);
  carry_out(request, *directory, options, notes_of({request.the_case, {}, {}}));
}

}  // namespace

void add_run_verb(CLI::App& app) {
  auto* run = app.add_subcommand("run", "Carry out a case; its results go to a directory");
  auto arguments = std::make_shared<RunArguments>();
  add_case_arguments(*run, arguments->the_case);
  run->get_option("CASE")->required(false);
  run->add_option("-o,--output", arguments->options.directory,
                  "directory (default: CASE without .toml, with _run)")
      ->check(
          [](const std::string& name) { return name.empty() ? "must be a directory's name, got \"\"" : ""; })
      ->type_name("DIR");
  auto* resume = run->add_flag("--resume", arguments->resume,
                               "go on from the newest intact snapshot, if there is one; also to a later end");
  run->add_option(
         "--from", arguments->from,
         "begin from the last state of a run, or RUN@STEP, with CASE or its own case, and what --set "
         "changes")
      ->type_name("RUN")
      ->excludes(resume);
  run->add_flag("--force", arguments->force,
                "replace an earlier run's results; begin even where memory or disk seem too small")
      ->excludes(resume);
  add_run_options(*run, arguments->options);
  run->footer(
      "Examples:\n"
      "  softgrain run squeeze/case.toml                    into squeeze/case_run\n"
      "  softgrain run case.toml --set contact.wall_friction=0.3 -o friction -j 4\n"
      "  softgrain run case.toml -o out --resume --set loading.max_strain=0.5      a finished run goes "
      "further\n"
      "  softgrain run --from out@4000 --set contact.friction=0.3 -o rough         other friction from step "
      "4000\n"
      "  softgrain run shear.toml --from out                              other stages for the same grains\n"
      "  softgrain run case.toml -o out --resume --stop-after \"23 h\"    in a queue: exit code 75 asks to "
      "come again\n"
      "\nCtrl-C: finish the step, write a snapshot, exit 130. SIGTERM, SIGUSR2, SIGHUP: the same, exit 75. "
      "SIGUSR1:\n"
      "write a snapshot and go on.\n"
      "\nExit code 5: the run came to its end, but its verdict says not to trust it, or that it did not "
      "reach "
      "all\nthat the case asks.");
  run->callback([arguments] {
    require(!arguments->from.empty() || !arguments->the_case.path.empty(),
            "run needs a case, or --from RUN: softgrain run CASE");
    arguments->from.empty() ? run_case(*arguments) : run_from(*arguments);
  });

  auto* again = app.add_subcommand("resume", "Go on with a run that was stopped or killed");
  auto options = std::make_shared<RunOptions>();
  again->add_option("DIR", options->directory, "a run's directory")->required();
  add_run_options(*again, *options);
  again->footer("Example:\n  softgrain resume squeeze/case_run");
  again->callback([options] { resume_run(*options); });
}

}  // namespace softgrain
