#include "softgrain/io/run/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/io/case/case_extension.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/run/verdict.hpp"
#include "softgrain/observe/columns.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// How many of `count` even shares of the run are over.
int shares_done(const AnySimulation& simulation, int count) {
  constexpr double rounding = 1e-9;
  return static_cast<int>(std::floor(simulation.progress() * count + rounding));
}

/// "s000123.h5", wide enough for the last step.
std::string snapshot_name(std::int64_t step, std::int64_t last_step) {
  const std::size_t width = std::max<std::size_t>(6, std::to_string(last_step).size());
  return fmt::format("s{:0{}}.h5", step, width);
}

/// "000123" for snap/s000123.h5.
std::string label_of(const fs::path& snapshot) { return snapshot.stem().string().substr(1); }

/// The frames of ParaView's collection that belong to earlier snapshots.
std::vector<Frame> frames_before(std::int64_t step, const RunPaths& paths) {
  std::vector<Frame> frames;
  for (const SnapshotFile& file : list_snapshots(paths)) {
    if (file.step >= step) break;
    try {
      frames.push_back({snapshot_time(file.path), label_of(file.path)});
    } catch (const IoError&) {
      // A damaged one: `softgrain verify` tells.
    }
  }
  return frames;
}

/// Over the steps since the last row.
StepMeans means_of(const StepSums& sums, double wall_seconds) {
  const double steps = static_cast<double>(std::max<std::int64_t>(sums.steps, 1));
  return {.sweeps = static_cast<double>(sums.sweeps) / steps,
          .residual_mean = sums.residual_mean / steps,
          .residual_max = sums.residual_max,
          .overlap_mean = sums.overlap_mean / steps,
          .overlap_max = sums.overlap_max,
          .wall_seconds = wall_seconds};
}

}  // namespace

RunRecorder::RunRecorder(const RunPaths& paths, RunRequest request, Progress& progress, SignalWatch& signals)
    : paths_(paths), request_(std::move(request)), progress_(progress), signals_(signals) {
  record_.command = request_.command;
  record_.origins = request_.origins;
  record_.started = utc_now();
  record_.seed = request_.the_case.sample.seed;
  record_.report.energy.scale = least_energy(request_.the_case);
}

double RunRecorder::wall_seconds() const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  return wall_before_ + elapsed.count();
}

bool RunRecorder::stop_wanted() const {
  return signals_.stop_signal() != 0 || wall_seconds() - wall_before_ >= request_.stop_after;
}

void RunRecorder::log(const std::string& text) {
  if (!log_) log_.emplace(paths_.log_file());
  log_->append(fmt::format("{} {}\n", utc_now(), text));
  if (request_.verbose) progress_.message(text);
}

void RunRecorder::begin(AnySimulation& simulation) {
  write_record(simulation);  // first of all: run.json is what makes this directory a run's
  fs::create_directories(paths_.snapshot_folder());
  if (request_.the_case.output.vtk) fs::create_directories(paths_.vtk_folder());
  log(fmt::format("begin: {} steps planned", simulation.steps_planned()));
  write_file(paths_.case_file(), request_.case_text);
  series_.emplace(paths_.series_file());
  write_row(simulation);
  save(simulation);
}

Snapshot RunRecorder::newest_intact_snapshot() {
  auto files = list_snapshots(paths_);
  std::vector<fs::path> damaged;
  for (; !files.empty(); files.pop_back()) {
    try {
      Snapshot snapshot = read_snapshot(files.back().path);
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

RunReport RunRecorder::resume(AnySimulation& simulation) {
  const bool same_case =
      !fs::exists(paths_.case_file()) || read_file(paths_.case_file()) == request_.case_text;
  if (!same_case) drop_old_end();
  const Snapshot snapshot = newest_intact_snapshot();
  if (snapshot.case_text != request_.case_text) {
    const Case begun = parse_case(snapshot.case_text, last_snapshot_.string());
    const std::string why = why_no_extension(begun, request_.the_case);
    require(why.empty(), "{} is not the case that the run was begun with: {}", paths_.case_file().string(),
            why);
  }
  simulation.restore(snapshot.checkpoint);
  if (fs::exists(paths_.run_file())) {
    const RunRecord before = read_run_record(paths_.run_file());
    record_.command = before.command;
    record_.origins = before.origins;
    record_.started = before.started;
    record_.resumes = before.resumes + 1;
  }
  record_.report = snapshot.report;
  sums_ = snapshot.sums;
  wall_before_ = snapshot.wall_seconds;
  cpu_before_ = snapshot.cpu_seconds;
  rows_due_ = shares_done(simulation, request_.the_case.output.samples);
  snapshots_due_ = shares_done(simulation, request_.the_case.output.snapshots);
  rewind_series(paths_.series_file(), snapshot.checkpoint.step);
  series_.emplace(paths_.series_file());
  last_row_ = read_last_row(paths_.series_file()).value_or(std::vector<Quantity>{});
  log(fmt::format("resume at step {} from {}", snapshot.checkpoint.step, last_snapshot_.string()));
  frames_ = frames_before(snapshot.checkpoint.step, paths_);
  if (request_.the_case.output.vtk) fs::create_directories(paths_.vtk_folder());
  if (!same_case || !fs::exists(paths_.case_file())) write_file(paths_.case_file(), request_.case_text);
  save_scene(simulation, snapshot.scene);
  write_record(simulation);
  return snapshot.report;
}

bool RunRecorder::after_step(AnySimulation& simulation, const StepReport& step, RunReport& run) {
  record_.report = run;
  sums_.add(step);
  if (!step.converged && run.steps - run.steps_converged == 1)
    log(fmt::format(
        "warning: the solver did not converge in step {} (worst residual {:.1e}, limit {:.1e}); further "
        "steps are only counted",
        simulation.steps_done(), step.residual_max, step.residual_limit));
  const bool last = simulation.finished();
  const bool stop = !last && stop_wanted();
  if (last || shares_done(simulation, request_.the_case.output.samples) > rows_due_) write_row(simulation);
  const bool snapshot_due = simulation.at_turning_point() ||
                            shares_done(simulation, request_.the_case.output.snapshots) > snapshots_due_;
  if (signals_.take_snapshot_request() || last || stop || snapshot_due) save(simulation);
  run.energy = record_.report.energy;
  progress_.update(simulation.progress(), last_row_);
  return !stop;
}

void RunRecorder::write_row(AnySimulation& simulation) {
  Observation now = simulation.observe();
  simulation.begin_row();
  now.means = means_of(sums_, wall_seconds());
  record_.report.energy.add(now.energies);
  last_row_ = row_of(now);
  series_->write_row(last_row_);
  sums_ = {};
  rows_due_ = shares_done(simulation, request_.the_case.output.samples);
}

void RunRecorder::save(const AnySimulation& simulation) {
  series_->sync();  // the rows before a snapshot are on the disk when it is
  const fs::path path =
      paths_.snapshot_folder() / snapshot_name(simulation.steps_done(), simulation.steps_planned());
  const Scene scene = simulation.scene();
  write_snapshot(path, {.case_text = request_.case_text,
                        .checkpoint = simulation.checkpoint(),
                        .scene = scene,
                        .report = record_.report,
                        .sums = sums_,
                        .wall_seconds = wall_seconds(),
                        .cpu_seconds = cpu_before_ + cpu_seconds()});
  last_snapshot_ = path;
  snapshots_due_ = shares_done(simulation, request_.the_case.output.snapshots);
  save_scene(simulation, scene);
  log(fmt::format("snapshot {} at {:.1f} %", path.filename().string(), 100 * simulation.progress()));
  write_record(simulation);
}

void RunRecorder::save_scene(const AnySimulation& simulation, const Scene& scene) {
  if (!request_.the_case.output.vtk) return;
  const std::string label = label_of(last_snapshot_);
  write_scene(paths_.vtk_folder(), label, scene);
  frames_.push_back({simulation.time(), label});
  write_file(paths_.collection_file(),
             pvd_text(frames_, paths_.vtk_folder().filename().string(), is_in_space(request_.the_case)),
             Survives::kill);
}

void RunRecorder::write_record(const AnySimulation& simulation) {
  record_.step = simulation.steps_done();
  record_.steps_planned = simulation.steps_planned();
  record_.time = simulation.time();
  record_.progress = simulation.progress();
  record_.wall_seconds = wall_seconds();
  record_.cpu_seconds = cpu_before_ + cpu_seconds();
  write_file(paths_.run_file(), encode_run_record(record_));
}

int RunRecorder::end(const AnySimulation& simulation) {
  const int signal = signals_.stop_signal();
  const bool done = simulation.finished();
  record_.state = done ? "done" : "stopped";
  record_.message = done ? simulation.early_end() : signal != 0 ? signal_name(signal) : "time limit";
  if (done) record_.path = simulation.outcome();
  write_record(simulation);
  const Verdict verdict = verdict_of(record_.report, record_.path);
  const std::string early = record_.message.empty() ? "" : " before the last strain: " + record_.message;
  log(fmt::format("{}: {}", done ? "done" + early : "stopped by " + record_.message, verdict.words));
  if (done) return verdict.doubts.empty() ? 0 : exit_doubtful;
  return signal != 0 ? exit_code_of(signal) : exit_requeue;
}

void RunRecorder::fail(const std::string& message) {
  record_.state = "failed";
  record_.message = message;
  record_.wall_seconds = wall_seconds();
  try {
    write_file(paths_.run_file(), encode_run_record(record_));
    log("failed: " + message);
  } catch (const IoError&) {
    // The disk may be what failed; the caller raises the first error.
  }
}

RunOutcome record_run(AnySimulation& simulation, const RunDirectory& directory, const RunRequest& request,
                      Progress& progress, SignalWatch& signals) {
  const bool resuming = request.resume && !list_snapshots(directory.paths()).empty();
  if (!resuming) directory.clear();
  signals.defer();
  RunRecorder recorder(directory.paths(), request, progress, signals);
  if (resuming) recorder.resume(simulation);  // outside: a run that cannot be resumed stays as it was
  try {
    if (!resuming) recorder.begin(simulation);
    if (!directory.caution().empty()) recorder.log(directory.caution());
    run(simulation, recorder, recorder.record().report);
    const int exit_code = recorder.end(simulation);
    return {exit_code, recorder.record()};
  } catch (const NumericalError& error) {
    const auto message =
        fmt::format("{}\nthe last good state is {}", error.what(), recorder.last_snapshot().string());
    recorder.fail(message);
    throw NumericalError(message);
  } catch (const std::exception& error) {
    recorder.fail(error.what());
    throw;
  }
}

}  // namespace softgrain
