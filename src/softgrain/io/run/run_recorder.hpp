#pragma once
#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/run.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/format/vtp_writer.hpp"
#include "softgrain/io/run/progress.hpp"
#include "softgrain/io/run/run_directory.hpp"
#include "softgrain/io/run/run_json.hpp"
#include "softgrain/io/run/series_writer.hpp"
#include "softgrain/io/run/signals.hpp"

namespace softgrain {

/// What is asked of a run besides its physics.
struct RunRequest {
  Case the_case;
  std::string case_text;             ///< the resolved case, as stored
  std::string case_before;           ///< what case.toml of a run that goes on held; empty for no such file
  std::vector<std::string> command;  ///< the command line
  std::vector<RunOrigin> origins;    ///< that the simulation was begun from, the newest first
  bool resume = false;  ///< from the newest intact snapshot; from the beginning when there is none
  double stop_after = std::numeric_limits<double>::infinity();  ///< wall time [s]
  bool verbose = false;                                         ///< the log goes to stderr too
};

/// Fills a run's directory while the run goes; of several ranks the first one does. Rows of series.csv depend
/// on the simulation's progress alone, so that a resumed run writes the same: one whenever
/// floor(progress * samples) grows. A snapshot is due whenever floor(progress * snapshots) grows, the load
/// turns, or output.snapshot_every has passed by the clock. The first and the last state bring both.
class RunRecorder final : public Recorder {
 public:
  RunRecorder(const RunPaths& paths, RunRequest request, Progress& progress, SignalWatch& signals);

  /// A line of log.txt.
  void log(const std::string& text);
  /// Writes the first state.
  void begin(AnySimulation& simulation);
  /// Restores the newest snapshot that is intact and returns the report up to it; says which ones it skipped
  /// and why. A run that has ended goes further if the case is an extension (why_no_extension) of the one it
  /// was begun with, from the snapshot before its end. Raises IoError when none is intact.
  RunReport resume(AnySimulation& simulation);
  bool after_step(AnySimulation& simulation, const StepReport& step, RunReport& run) override;

  /// Ends the run as done, or as stopped before its end; returns the program's exit code.
  int end(const AnySimulation& simulation);
  /// Ends it as failed; a full disk is no further error.
  void fail(const std::string& message);

  const RunRecord& record() const { return record_; }
  /// The last snapshot that is safely on the disk; empty for none.
  const std::filesystem::path& last_snapshot() const { return last_snapshot_; }

 private:
  double wall_seconds() const;
  /// How many of `count` even shares of the run are over.
  static int shares_done(const AnySimulation& simulation, int count);
  int stop_wanted() const;
  /// By the clock.
  bool snapshot_is_due() const;
  void add_up_ranks();
  void on_first_rank(const std::function<void()>& work) const;
  void drop_old_end();
  Snapshot newest_intact_snapshot();
  void keep(AnySimulation& simulation, bool row, bool snapshot);
  Snapshot snapshot_to_resume();
  Snapshot checked_snapshot();
  int write_end(const AnySimulation& simulation);
  void write_row(AnySimulation& simulation);
  void save(AnySimulation& simulation);
  void write_state(AnySimulation& simulation, const ParticleParts& parts);
  void save_scene(const AnySimulation& simulation);
  void write_record(const AnySimulation& simulation);

  RunPaths paths_;
  RunRequest request_;
  Progress& progress_;
  SignalWatch& signals_;
  std::optional<AppendFile> log_;
  std::optional<SeriesWriter> series_;
  RunRecord record_;
  StepSums sums_;
  std::vector<Quantity> last_row_;
  std::vector<Frame> frames_;
  std::filesystem::path last_snapshot_;
  int stop_ = 0;           ///< the signal that ended the run on all ranks, or time_is_over
  int rows_due_ = 0;       ///< floor(progress * samples) at the last row
  int snapshots_due_ = 0;  ///< the same for snapshots
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double wall_before_ = 0;  ///< of the parts before this one [s]
  double cpu_before_ = 0;   ///< [s]
  double kept_at_ = 0;      ///< wall time of the last snapshot, of all parts [s]
};

/// How a run ended.
struct RunOutcome {
  int exit_code = 0;
  RunRecord record;
};

/// Runs the simulation to its end, or until it is asked to stop, with everything written to the directory. A
/// run that breaks down leaves state "failed" in run.json; its error is raised again, with the last good
/// snapshot named.
RunOutcome record_run(AnySimulation& simulation, const RunDirectory& directory, const RunRequest& request,
                      Progress& progress, SignalWatch& signals);

}  // namespace softgrain
