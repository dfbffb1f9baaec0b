#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/words.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/run/progress.hpp"
#include "softgrain/io/run/run_directory.hpp"
#include "softgrain/io/run/run_json.hpp"
#include "softgrain/io/run/series_writer.hpp"
#include "softgrain/io/run/verdict.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

/// Pairs of a heading and what stands beside it.
using Lines = std::vector<std::pair<std::string, std::string>>;

std::string text_of(const std::string& title, const Lines& lines) {
  std::string text = title + "\n";
  for (const auto& [heading, words] : lines) text += fmt::format("{:<11}{}\n", heading, words);
  return text;
}

Json json_of(const std::vector<Quantity>& row) {
  Json json = Json::object();
  for (const Quantity& quantity : row)
    json[quantity.name] = {{"value", quantity.value}, {"unit", quantity.unit}};
  return json;
}

/// "diametral of bpm, 1750 primaries, friction 0, seed 1", "compaction of mpm, 20 grains of 3584 points,
/// ...".
std::string summary(const Case& c) {
  const std::string grain = is_mixed(c)     ? "points or of primaries"
                            : is_elastic(c) ? fmt::format("{} points", points_of_grain(c))
                            : is_rigid(c)   ? fmt::format("{} vertices", points_of_grain(c))
                                            : fmt::format("{} primaries", c.bpm.primaries);
  const std::string grains =
      c.experiment.loading == LoadingPath::diametral ? "" : fmt::format("{} grains of ", c.sample.grains);
  const bool one_bonded = is_bonded(c) && c.experiment.loading == LoadingPath::diametral;
  const double friction = one_bonded ? c.bpm.inner_friction : c.contact.friction;
  return fmt::format("{} of {}, {}{}, friction {}, seed {}", word_of(c.experiment.loading),
                     is_mixed(c) ? "mpm and bpm" : word_of(c.experiment.model), grains, grain, friction,
                     c.sample.seed);
}

/// "strain 0.1  wall_height 9 mm ...", a few to a line.
std::string words_of(const std::vector<Quantity>& row) {
  constexpr std::size_t line_length = 96;
  std::string text, line;
  for (const Quantity& quantity : row) {
    const auto word = fmt::format("{} {}", quantity.name, short_value(quantity));
    if (!line.empty() && line.size() + word.size() > line_length) {
      text += line + "\n           ";
      line.clear();
    }
    line += (line.empty() ? "" : "  ") + word;
  }
  return text + line;
}

/// run.json, and what has come of the run since.
Json describe_run(const RunPaths& paths) {
  Json run = Json::parse(read_file(paths.run_file()));
  const int process = running_process(paths);
  if (process != 0) run["process"] = process;
  if (process == 0 && run.at("state") == "running")
    run["state"] = fs::exists(paths.lock_file()) ? "killed" : "running or killed";  // no locks there
  if (const auto row = read_last_row(paths.series_file())) run["last_row"] = json_of(*row);
  run["snapshots"] = Json::array();
  for (const SnapshotFile& file : list_snapshots(paths)) run["snapshots"].push_back(file.path.string());
  return run;
}

std::string run_text(const Json& run, const RunPaths& paths) {
  const auto text = [&](const char* key) { return run.at(key).get<std::string>(); };
  Lines lines{
      {"case", summary(parse_recorded_case(read_file(paths.case_file()), paths.case_file().string()))},
      {"begun", fmt::format("{}, resumed {} times", text("started"), run.at("resumes").get<int>())},
      {"program", fmt::format("softgrain {} ({})", run.at("program").at("version").get<std::string>(),
                              run.at("program").at("commit").get<std::string>())},
      {"progress", fmt::format("{:.1f} %, step {} of {}, {} of wall time",
                               100 * run.at("progress").get<double>(), grouped(run.at("step")),
                               grouped(run.at("steps_planned")), duration_text(run.at("wall_seconds")))},
      {"verdict", text("verdict")},
  };
  if (!text("message").empty()) lines.emplace_back("message", text("message"));
  if (const auto row = read_last_row(paths.series_file())) lines.emplace_back("last row", words_of(*row));
  const auto& snapshots = run.at("snapshots");
  const std::string newest = snapshots.empty() ? "" : ", newest " + snapshots.back().get<std::string>();
  lines.emplace_back("snapshots", fmt::format("{}{}", snapshots.size(), newest));
  const bool running = run.contains("process");
  const auto process = running ? fmt::format(", process {}", run["process"].get<int>()) : "";
  return text_of(fmt::format("{}: a run, {}{}", paths.root.string(), text("state"), process), lines);
}

std::string info_of_run(const RunPaths& paths, bool as_json) {
  try {
    const Json run = describe_run(paths);
    return as_json ? run.dump(2) + "\n" : run_text(run, paths);
  } catch (const Json::exception& error) {
    throw IoError(fmt::format("{}: damaged: {}", paths.run_file().string(), error.what()));
  }
}

std::string info_of_snapshot(const fs::path& path, bool as_json) {
  const Snapshot snapshot = read_snapshot(path);
  const Case the_case = parse_recorded_case(snapshot.case_text, path.string());
  const auto hash = Hdf5Reader(path).text_attribute("content_hash");
  const Verdict verdict = verdict_of(snapshot.report);
  if (as_json) {
    Json json{{"format", "softgrain-snapshot"},          {"step", snapshot.checkpoint.step},
              {"time", snapshot.checkpoint.time},        {"content_hash", hash},
              {"wall_seconds", snapshot.wall_seconds},   {"verdict", verdict.words},
              {"datasets", Hdf5Reader(path).datasets()}, {"case", snapshot.case_text}};
    return json.dump(2) + "\n";
  }
  return text_of(fmt::format("{}: a snapshot, intact", path.string()),
                 {{"case", summary(the_case)},
                  {"step", fmt::format("{}, time {}", grouped(snapshot.checkpoint.step),
                                       short_value({"time", "s", snapshot.checkpoint.time}))},
                  {"verdict", verdict.words},
                  {"hash", hash}});
}

void show_info(const std::string& path, bool as_json) {
  require(fs::exists(path), "{} does not exist", path);
  const RunPaths paths{path};
  require(!fs::is_directory(path) || fs::exists(paths.run_file()),
          "{} is not a run's directory: it has no run.json", path);
  require(!path.ends_with(".toml"),
          "{} is a case, neither a run's directory nor a snapshot; `softgrain check {}` tells about it", path,
          path);
  print_result(fs::is_directory(path) ? info_of_run(paths, as_json) : info_of_snapshot(path, as_json));
}

/// Checks every snapshot against its hash; raises IoError when one is bad, or when there is none.
void verify_run(const std::string& directory) {
  require(fs::is_directory(directory), "{} is not a directory", directory);
  const auto snapshots = list_snapshots(RunPaths{directory});
  if (snapshots.empty()) throw IoError(directory + ": no snapshots");
  std::size_t bad = 0;
  for (const SnapshotFile& file : snapshots) {
    try {
      read_snapshot(file.path);
      print_result(fmt::format("{}: intact\n", file.path.string()));
    } catch (const IoError& error) {
      ++bad;
      print_result(fmt::format("{}\n", error.what()));
    }
  }
  if (bad > 0) throw IoError(fmt::format("{}: {} of {} snapshots are bad", directory, bad, snapshots.size()));
  print_result(fmt::format("{}: all {} snapshots are intact\n", directory, snapshots.size()));
}

}  // namespace

void add_info_verb(CLI::App& app) {
  struct InfoArguments {
    std::string path;
    bool json = false;
  };
  auto* info = app.add_subcommand("info", "Tell what a run's directory or a snapshot holds");
  auto arguments = std::make_shared<InfoArguments>();
  info->add_option("PATH", arguments->path, "a run's directory, or a snapshot (.h5)")->required();
  info->add_flag("--json", arguments->json, "for machines");
  info->footer("Example:\n  softgrain info squeeze/case_run");
  info->callback([arguments] { show_info(arguments->path, arguments->json); });

  auto* verify = app.add_subcommand("verify", "Check every snapshot of a run against its hash");
  auto directory = std::make_shared<std::string>();
  verify->add_option("DIR", *directory, "a run's directory")->required();
  verify->footer("Example:\n  softgrain verify squeeze/case_run");
  verify->callback([directory] { verify_run(*directory); });
}

}  // namespace softgrain
