#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace softgrain {

struct Case;
struct CaseReading;

/// Thrown by a verb's callback to end the program with an exit code of its own, without a message: 130 after
/// SIGINT, 75 after SIGTERM (requeue me). Errors are exceptions of core/error.hpp; plain return is exit code
/// 0.
struct ExitCode {
  int code;
};

/// What every verb that reads a case takes: `CASE [--set key=value]...`.
struct CaseArguments {
  std::string path;
  std::vector<std::string> sets;
};
void add_case_arguments(CLI::App& verb, CaseArguments& arguments);

/// Lets an option take a directory made by `new`, or a file's name without .toml.
void complete_case_path_of(CLI::Option& option);

/// A check of CLI11 for what is counted: "" for a whole number from 1 on, else what is wrong.
std::string at_least_one(const std::string& word);

/// What a user should know who runs a valid case, each "note: ...": keys without effect, cautions of its law.
std::vector<std::string> notes_of(const CaseReading& reading);

// One verb each: adds a subcommand whose callback does the work after the whole command line has been parsed.
// Results go to stdout, progress and log to stderr.
void add_new_verb(CLI::App& app);
void add_check_verb(CLI::App& app);
void add_schema_verb(CLI::App& app);
void add_doctor_verb(CLI::App& app);
void add_bench_verb(CLI::App& app);
void add_run_verb(CLI::App& app);  // run and resume
void add_report_verb(CLI::App& app);
void add_export_verb(CLI::App& app);
void add_info_verb(CLI::App& app);
void add_solve_verb(CLI::App& app);
void add_law_verb(CLI::App& app);
void add_completion_verb(CLI::App& app);

}  // namespace softgrain
