// The command line program: parses the arguments, calls one verb, turns its outcome into an exit code.
#include <fmt/core.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "python_verbs.hpp"
#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/version.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace fs = std::filesystem;

std::string at_least_one(const std::string& word) {
  int count = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, count);
  return error == std::errc{} && stop == end && count >= 1
             ? ""
             : fmt::format("must be a whole number, at least 1, got {}", word);
}

namespace {

/// `new` makes a directory: its name, or a file's without .toml, will do.
std::string complete_case_path(std::string& path) {
  std::error_code unknown;
  if (const fs::path inside = fs::path(path) / "case.toml";
      fs::is_directory(path, unknown) && fs::exists(inside, unknown))
    path = inside.string();
  else if (!fs::exists(path, unknown) && fs::exists(path + ".toml", unknown))
    path += ".toml";
  return "";
}

}  // namespace

void complete_case_path_of(CLI::Option& option) { option.transform(CLI::Validator(complete_case_path, "")); }

void add_case_arguments(CLI::App& verb, CaseArguments& arguments) {
  auto* path =
      verb.add_option("CASE", arguments.path, "case file, as written by `softgrain new`")->required();
  complete_case_path_of(*path);
  verb.add_option("--set", arguments.sets, "key=value: replaces one value of the case; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

namespace {

enum : int { success = 0, our_bug = 1, usage = 2, numerical = 3, input_output = 4 };

void add_verbs(CLI::App& app) {
  add_new_verb(app);
  add_check_verb(app);
  add_run_verb(app);
  add_python_verb(app, "sweep");
  add_python_verb(app, "reproduce");
  add_python_verb(app, "plot");
  add_python_verb(app, "movie");
  add_python_verb(app, "methods");
  add_python_verb(app, "compare");
  add_python_verb(app, "fit");
  add_report_verb(app);
  add_export_verb(app);
  add_python_verb(app, "voronoi");
  add_python_verb(app, "paraview");
  add_info_verb(app);
  add_solve_verb(app);
  add_law_verb(app);
  add_schema_verb(app);
  add_doctor_verb(app);
  add_bench_verb(app);
  add_completion_verb(app);
}

/// The verb that was named on the command line, or the program itself when there is none.
CLI::App& chosen_verb(CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : *chosen.front();
}

std::vector<std::string> verb_names(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> option_names(CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// What is wrong with the command line, in one sentence, with the nearest word that would have been right.
std::string explain(CLI::App& app, const CLI::ParseError& error) {
  CLI::App& verb = chosen_verb(app);
  const bool has_verb = &verb != &app;
  const auto unexpected = verb.remaining();
  if (unexpected.empty())
    return has_verb ? error.what()
                    : fmt::format("no verb given; one of: {}", fmt::join(verb_names(app), ", "));
  const std::string& word = unexpected.front();
  if (word.starts_with('-')) {
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("unknown option '{}'{}", name, did_you_mean(name, option_names(verb)));
  }
  if (!has_verb) return fmt::format("unknown verb '{}'{}", word, did_you_mean(word, verb_names(app)));
  return fmt::format("unexpected argument '{}'", word);
}

int refuse_command_line(CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {  // --help, --version: stdout, exit code 0
    app.exit(error);
    check_stdout();
    return success;
  }
  const CLI::App& verb = chosen_verb(app);
  const std::string name = &verb == &app ? "softgrain" : "softgrain " + verb.get_name();
  print_error(fmt::format("error: {}\ntry '{} --help'", explain(app, error), name));
  return usage;
}

/// -o=x would make a directory named "=x".
void refuse_equals_after_letter(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word.size() < 3 || word[0] != '-' || word[1] == '-' || word[2] != '=') continue;
    throw UsageError(fmt::format("'{}': no '=' after a single letter; write {} {}", word, word.substr(0, 2),
                                 word.substr(3)));
  }
}

/// Verbs of which ranks share the work.
void refuse_ranks_without_work(const CLI::App& verb) {
  constexpr std::array<std::string_view, 3> shared{"run", "resume", "bench"};
  require(communicator().ranks() == 1 || std::ranges::count(shared, verb.get_name()) > 0,
          "'{}' is no work for {} ranks: only {} are", verb.get_name(), communicator().ranks(),
          fmt::join(shared, ", "));
}

int run_program(int argc, char** argv) {
  refuse_equals_after_letter(argc, argv);
  CLI::App app{"Simulation of soft granular matter", "softgrain"};
  const BuildInfo build = build_info();
  app.set_version_flag("--version", fmt::format("softgrain {} ({})", build.version, build.commit));
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  softgrain new squeeze                  writes squeeze/case.toml, commented\n"
      "  softgrain check squeeze/case.toml      what it would do and what it would cost\n"
      "\nExit codes: 0 done, 1 our bug, 2 usage or invalid case, 3 numerical failure, 4 input/output,\nor "
      "memory, 5 done, but not to be trusted or short of what the case asks, 75 and 130 stopped by a "
      "signal.");
  add_verbs(app);
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    verb->parse_complete_callback([verb] { refuse_ranks_without_work(*verb); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refuse_command_line(app, error);
  }
  check_stdout();
  return success;
}

/// Without asking for memory.
[[noreturn]] void leave_without_memory() {
  std::fputs("error: out of memory; `softgrain check CASE` tells what a run needs\n", stderr);
  _exit(input_output);
}

/// Memory may run out in a destructor (nlohmann::json's asks for some), where nothing can be caught.
[[noreturn]] void on_terminate() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    leave_without_memory();
  } catch (...) {
    // our bug
  }
  std::abort();
}

/// Memory that was given back stays with the process. By default the kernel maps and clears it anew for each
/// large array: half of the time of a snapshot of a million points. Arrays of 32 MB and more are given back:
/// of 10 000 spheres a snapshot would leave 1.5 GB behind.
void keep_memory() {
  constexpr int large = 32 << 20;  // [bytes], the most that the C library takes
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

/// The first of several ranks speaks for all.
void begin_ranks([[maybe_unused]] int& argc, [[maybe_unused]] char**& argv) {
#ifdef SOFTGRAIN_MPI
  use_communicator(mpi_communicator(argc, argv));
  if (communicator().rank() != 0 && std::freopen("/dev/null", "w", stdout) == nullptr)
    throw IoError("cannot open /dev/null");
#endif
}

int outcome_of(int argc, char** argv, std::string& error_text) {
  try {
    return run_program(argc, argv);
  } catch (const ExitCode& exit) {
    return exit.code;
  } catch (const CaseFileError& error) {
    error_text = error.what();
    return usage;
  } catch (const UsageError& error) {
    error_text = fmt::format("error: {}", error.what());
    return usage;
  } catch (const NumericalError& error) {
    error_text = fmt::format("error: {}", error.what());
    return numerical;
  } catch (const IoError& error) {
    error_text = fmt::format("error: {}", error.what());
    return input_output;
  } catch (const std::system_error& error) {  // the file system's, and fmt's when stdout is full
    error_text = fmt::format("error: {}", error.what());
    return input_output;
  } catch (const std::bad_alloc&) {
    leave_without_memory();
  } catch (const std::exception& error) {
    error_text = fmt::format("error: {}\nthis is a bug, please report", error.what());
    return our_bug;
  }
}

}  // namespace
}  // namespace softgrain

int main(int argc, char** argv) {
  using namespace softgrain;
  keep_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error of the write, not the end
  std::set_terminate(on_terminate);
  begin_ranks(argc, argv);
  std::string error_text;
  const int exit_code = outcome_of(argc, argv, error_text);
  const bool all_here = communicator().wait_for_all();
  if (!error_text.empty() && (communicator().rank() == 0 || !all_here)) print_error(error_text);
  communicator().leave(all_here, exit_code);
  return exit_code;
}
