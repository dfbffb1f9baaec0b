#include "softgrain/io/run/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/shared_loop.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/io/format/stored_scene.hpp"
#include "softgrain/io/run/verdict.hpp"
#include "softgrain/observe/columns.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// In the place of a signal: no signal's number.
constexpr int time_is_over = 1000;

/// "s000123.h5", wide enough for the last step.
std::string snapshot_name(std::int64_t step, std::int64_t last_step) {
  const std::size_t width = std::max<std::size_t>(6, std::to_string(last_step).size());
  return fmt::format("s{:0{}}.h5", step, width);
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

int RunRecorder::shares_done(const AnySimulation& simulation, int count) {
  constexpr double rounding = 1e-9;
  return static_cast<int>(std::floor(simulation.progress() * count + rounding));
}

/// 0: go on.
int RunRecorder::stop_wanted() const {
  if (const int signal = signals_.stop_signal(); signal != 0) return signal;
  return wall_seconds() - wall_before_ >= request_.stop_after ? time_is_over : 0;
}

bool RunRecorder::snapshot_is_due() const {
  const double every = request_.the_case.output.snapshot_every;
  return every > 0 && wall_seconds() - kept_at_ >= every;
}

/// On all ranks.
void RunRecorder::add_up_ranks() {
  Communicator& all = communicator();
  const SharingAccount account = all.account;
  record_.ranks = {.cpu_shared = over_ranks(account.cpu_shared),
                   .memory = over_ranks(static_cast<double>(peak_memory())),
                   .cpu_exchanges = all.sum(account.cpu_exchanges),
                   .cpu_all = all.sum(cpu_seconds())};
}

/// An error there is one of all ranks.
void RunRecorder::on_first_rank(const std::function<void()>& work) const {
  together(communicator().rank() == 0, work);
}

void RunRecorder::log(const std::string& text) {
  if (communicator().rank() != 0) return;
  if (!log_) log_.emplace(paths_.log_file());
  log_->append(fmt::format("{} {}\n", utc_now(), text));
  if (request_.verbose) progress_.message(text);
}

void RunRecorder::begin(AnySimulation& simulation) {
  add_up_ranks();
  on_first_rank([&] {
    write_record(simulation);  // first of all: run.json is what makes this directory a run's
    fs::create_directories(paths_.snapshot_folder());
    if (request_.the_case.output.vtk) fs::create_directories(paths_.vtk_folder());
    log(fmt::format("begin: {} steps planned", simulation.steps_planned()));
    write_file(paths_.case_file(), request_.case_text);
    series_.emplace(paths_.series_file());
  });
  keep(simulation, true, true);
}

bool RunRecorder::after_step(AnySimulation& simulation, const StepReport& step, RunReport& run) {
  record_.report = run;
  sums_.add(step);
  if (!step.converged && run.steps - run.steps_converged == 1)
    on_first_rank([&] {
      log(fmt::format(
          "warning: the solver did not converge in step {} (worst residual {:.1e}, limit {:.1e}); further "
          "steps are only counted",
          simulation.steps_done(), step.residual_max, step.residual_limit));
    });
  const bool last = simulation.finished();
  // what one rank is asked for, all do
  const bool asked_for_state = signals_.take_snapshot_request() || snapshot_is_due();
  const int asked = 2 * (last ? 0 : stop_wanted()) + (asked_for_state ? 1 : 0);
  const auto wanted = static_cast<int>(communicator().largest(asked));
  stop_ = wanted / 2;
  const bool row = last || shares_done(simulation, request_.the_case.output.samples) > rows_due_;
  const bool snapshot = wanted > 0 || last || simulation.at_turning_point() ||
                        shares_done(simulation, request_.the_case.output.snapshots) > snapshots_due_;
  if (row || snapshot) keep(simulation, row, snapshot);
  run.energy = record_.report.energy;
  progress_.update(simulation.progress(), last_row_);
  return stop_ == 0;
}

void RunRecorder::keep(AnySimulation& simulation, bool row, bool snapshot) {
  simulation.gather();
  if (row) {
    on_first_rank([&] { write_row(simulation); });
    simulation.begin_row();
    sums_ = {};
    rows_due_ = shares_done(simulation, request_.the_case.output.samples);
  }
  if (snapshot) {
    add_up_ranks();
    save(simulation);
    snapshots_due_ = shares_done(simulation, request_.the_case.output.snapshots);
    kept_at_ = wall_seconds();
  }
}

void RunRecorder::write_row(AnySimulation& simulation) {
  Observation now = simulation.observe();
  now.means = means_of(sums_, wall_seconds());
  record_.report.energy.add(now.energies);
  last_row_ = row_of(now);
  series_->write_row(last_row_);
}

/// On all ranks: each gives the particles of its grains, part after part, also where the first one fails.
void RunRecorder::save(AnySimulation& simulation) {
  RankError error;
  ParticleParts parts = simulation.particle_parts();
  int asked = 0;
  const auto ask = [&, rows = std::move(parts.rows)](int part) {
    ++asked;
    return rows(part);
  };
  parts.rows = ask;
  if (communicator().rank() == 0) error.catch_from([&] { write_state(simulation, parts); });
  while (asked < parts.count) error.catch_from([&] { ask(asked); });
  error.raise_first();
}

void RunRecorder::write_state(AnySimulation& simulation, const ParticleParts& parts) {
  series_->sync();  // the rows before a snapshot are on the disk when it is
  const fs::path path =
      paths_.snapshot_folder() / snapshot_name(simulation.steps_done(), simulation.steps_planned());
  write_snapshot(path,
                 {.case_text = request_.case_text,
                  .checkpoint = {.step = simulation.steps_done(), .time = simulation.time(), .arrays = {}},
                  .scene = parts.count > 0 ? simulation.scene_without_parts() : simulation.scene(),
                  .report = record_.report,
                  .sums = sums_,
                  .wall_seconds = wall_seconds(),
                  .cpu_seconds = cpu_before_ + record_.ranks.cpu_all},
                 {.particles = parts, .state = [&](StateVisitor& visit) { simulation.visit(visit); }});
  last_snapshot_ = path;
  if (request_.the_case.output.vtk) save_scene(simulation);
  log(fmt::format("snapshot {} at {:.1f} %", path.filename().string(), 100 * simulation.progress()));
  write_record(simulation);
}

/// Of the last snapshot.
void RunRecorder::save_scene(const AnySimulation& simulation) {
  const std::string label = snapshot_label(last_snapshot_);
  const StoredScene stored(last_snapshot_);
  write_scene(paths_.vtk_folder(), label, stored.scene(), stored.particles());
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
  record_.cpu_seconds = cpu_before_ + record_.ranks.cpu_all;
  write_file(paths_.run_file(), encode_run_record(record_));
}

int RunRecorder::end(const AnySimulation& simulation) {
  int exit_code = 0;
  add_up_ranks();
  on_first_rank([&] { exit_code = write_end(simulation); });
  return static_cast<int>(communicator().largest(exit_code));
}

int RunRecorder::write_end(const AnySimulation& simulation) {
  const int signal = stop_ == time_is_over ? 0 : stop_;
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
  if (communicator().rank() != 0) return;
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
  bool has_snapshots = false;
  together(communicator().rank() == 0, [&] {
    has_snapshots = request.resume && !list_snapshots(directory.paths()).empty();
    if (!has_snapshots) directory.clear();
  });
  const bool resuming = communicator().largest(has_snapshots ? 1 : 0) != 0;
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
