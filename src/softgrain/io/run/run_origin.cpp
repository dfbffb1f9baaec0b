#include "softgrain/io/run/run_origin.hpp"

#include <algorithm>
#include <filesystem>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_extension.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/format/hdf5_file.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// "0, 50, 100, ..., 400"
std::string steps_text(const std::vector<SnapshotFile>& files) {
  std::string text;
  for (const SnapshotFile& file : files) text += fmt::format("{}{}", text.empty() ? "" : ", ", file.step);
  return text;
}

fs::path snapshot_named(const RunPaths& paths, const std::string& name) {
  const std::vector<SnapshotFile> files = list_snapshots(paths);
  require(!files.empty(), "{} holds no snapshot: it is no run's directory, or was tidied up",
          paths.root.string());
  if (name.empty()) return files.back().path;
  for (const SnapshotFile& file : files)
    if (file.path.filename() == name || std::to_string(file.step) == name) return file.path;
  throw UsageError(fmt::format("{} has no snapshot '{}'; write {}@STEP with one of the steps {}",
                               paths.root.string(), name, paths.root.string(), steps_text(files)));
}

}  // namespace

OriginState read_origin(const std::string& text) {
  std::string directory = text, name;
  if (const std::size_t at = text.rfind('@'); at != std::string::npos && !fs::exists(text)) {
    directory = text.substr(0, at);
    name = text.substr(at + 1);
  }
  OriginState state{.paths = {directory}, .snapshot = {}, .origins = {}};
  require(fs::is_directory(directory), "there is no run's directory {}", directory);
  require(fs::exists(state.paths.case_file()), "{} has no case.toml: it is no run's directory", directory);
  const fs::path file = snapshot_named(state.paths, name);
  state.snapshot = read_snapshot(file);
  RunRecord record;
  if (fs::exists(state.paths.run_file())) record = read_run_record(state.paths.run_file());
  state.origins = {{fs::absolute(directory).lexically_normal().string(), file.filename().string(),
                    Hdf5Reader(file).text_attribute("content_hash"), record.command}};
  state.origins.insert(state.origins.end(), record.origins.begin(), record.origins.end());
  return state;
}

void begin_from(AnySimulation& simulation, const OriginState& origin, const Case& the_case) {
  try {
    simulation.begin_from(origin.snapshot.checkpoint);
  } catch (const IoError&) {
    const std::string name = origin.paths.case_file().string();
    const std::string why = why_other_grains(parse_recorded_case(origin.snapshot.case_text, name), the_case);
    if (why.empty()) throw;
    throw UsageError(fmt::format("--from takes the grains of {} as they are: {}; change it back",
                                 origin.paths.root.string(), why));
  }
}

}  // namespace softgrain
