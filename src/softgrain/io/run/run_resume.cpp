#include <utility>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_extension.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/run/run_recorder.hpp"

// How a run goes on.

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// The frames of ParaView's collection that belong to earlier snapshots.
std::vector<Frame> frames_before(std::int64_t step, const RunPaths& paths) {
  std::vector<Frame> frames;
  for (const SnapshotFile& file : list_snapshots(paths)) {
    if (file.step >= step) break;
    try {
      frames.push_back({snapshot_time(file.path), snapshot_label(file.path)});
    } catch (const IoError&) {
      // A damaged one: `softgrain verify` tells.
    }
  }
  return frames;
}

}  // namespace

/// Without its scene.
Snapshot RunRecorder::newest_intact_snapshot() {
  auto files = list_snapshots(paths_);
  std::vector<fs::path> damaged;
  for (; !files.empty(); files.pop_back()) {
    try {
      Snapshot snapshot = read_snapshot(files.back().path, SnapshotParts::to_go_on);
      last_snapshot_ = files.back().path;
      for (const fs::path& path : damaged) fs::rename(path, path.string() + ".damaged");
      return snapshot;
    } catch (const IoError& error) {
      const auto message = fmt::format("skipped a snapshot: {}", error.what());
      log(message);
      if (!request_.verbose) progress_.message(message);
      damaged.push_back(files.back().path);
    }
  }
  throw IoError(
      fmt::format("{}: none of {} snapshots is intact", paths_.snapshot_folder().string(), damaged.size()));
}

/// The last step before an end is cut to end there. A run that goes further begins before it, and so has the
/// bits of one that had the later end from the start.
void RunRecorder::drop_old_end() {
  const auto files = list_snapshots(paths_);
  if (files.size() < 2 || !fs::exists(paths_.run_file())) return;
  const RunRecord before = read_run_record(paths_.run_file());
  if (before.state == "done" && before.step == files.back().step) fs::remove(files.back().path);
}

/// On all ranks.
Snapshot RunRecorder::snapshot_to_resume() {
  Snapshot snapshot;
  on_first_rank([&] { snapshot = checked_snapshot(); });
  last_snapshot_ = told(last_snapshot_.string(), 0);
  together(communicator().rank() != 0,
           [&] { snapshot = read_snapshot(last_snapshot_, SnapshotParts::to_go_on); });
  return snapshot;
}

Snapshot RunRecorder::checked_snapshot() {
  if (!request_.case_before.empty() && request_.case_before != request_.case_text) drop_old_end();
  Snapshot snapshot = newest_intact_snapshot();
  if (snapshot.case_text != request_.case_text) {
    const Case begun = parse_case(snapshot.case_text, last_snapshot_.string());
    const std::string why = why_no_extension(begun, request_.the_case);
    require(why.empty(), "{} is not the case that the run was begun with: {}", paths_.case_file().string(),
            why);
  }
  return snapshot;
}

RunReport RunRecorder::resume(AnySimulation& simulation) {
  const Snapshot snapshot = snapshot_to_resume();
  simulation.restore(snapshot.checkpoint);
  record_.report = snapshot.report;
  sums_ = snapshot.sums;
  wall_before_ = kept_at_ = snapshot.wall_seconds;
  cpu_before_ = snapshot.cpu_seconds;
  rows_due_ = shares_done(simulation, request_.the_case.output.samples);
  snapshots_due_ = shares_done(simulation, request_.the_case.output.snapshots);
  add_up_ranks();
  on_first_rank([&] {
    if (fs::exists(paths_.run_file())) {
      const RunRecord before = read_run_record(paths_.run_file());
      record_.command = before.command;
      record_.origins = before.origins;
      record_.started = before.started;
      record_.resumes = before.resumes + 1;
    }
    rewind_series(paths_.series_file(), snapshot.checkpoint.step);
    series_.emplace(paths_.series_file());
    last_row_ = read_last_row(paths_.series_file()).value_or(std::vector<Quantity>{});
    log(fmt::format("resume at step {} from {}", snapshot.checkpoint.step, last_snapshot_.string()));
    frames_ = frames_before(snapshot.checkpoint.step, paths_);
    if (request_.case_before != request_.case_text) write_file(paths_.case_file(), request_.case_text);
    if (request_.the_case.output.vtk) {
      fs::create_directories(paths_.vtk_folder());
      save_scene(simulation);
    }
    write_record(simulation);
  });
  return snapshot.report;
}

}  // namespace softgrain
