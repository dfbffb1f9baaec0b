#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "softgrain/core/communicator.hpp"
#include "softgrain/experiment/run.hpp"

namespace softgrain {

/// The state of another run that a run was begun from.
struct RunOrigin {
  std::string directory;             ///< of that run
  std::string snapshot;              ///< "s000123.h5"
  std::string content_hash;          ///< of that snapshot
  std::vector<std::string> command;  ///< that began that run
};

/// How ranks shared a run: of this process and those beside it, not of earlier parts.
struct RankRecord {
  OverRanks cpu_shared;      ///< CPU time in shared loops [s]
  OverRanks memory;          ///< the most that a rank has held so far [bytes]
  double cpu_exchanges = 0;  ///< of all ranks, waiting included [s]
  double cpu_all = 0;        ///< of all ranks together [s]
};

/// What run.json tells about a run: where it came from, how far it is, and what it reached.
struct RunRecord {
  std::string state = "running";     ///< running, done, stopped (can be resumed), failed
  std::string message;               ///< why it stopped or failed
  std::vector<std::string> command;  ///< the command line that began it
  std::string started;               ///< UTC, "2025-11-22T00:49:12Z"
  std::int64_t resumes = 0;          ///< how often it was resumed
  std::int64_t seed = 0;
  std::int64_t step = 0;
  std::int64_t steps_planned = 0;
  double time = 0;          ///< [s] simulated
  double progress = 0;      ///< [0, 1]
  double wall_seconds = 0;  ///< of all resumed parts together
  double cpu_seconds = 0;
  std::vector<RunOrigin> origins;  ///< that it was begun from, the newest first; none: from its case
  RankRecord ranks;
  RunReport report;
  LoadingOutcome path;  ///< of a run that is done
};

/// The text of run.json: the record, its verdict, and what ran it (program, libraries, machine, threads,
/// memory).
std::string encode_run_record(const RunRecord& record);

/// What a resumed run takes over from the one before. Raises IoError when the file is not a run.json.
RunRecord read_run_record(const std::filesystem::path& path);

/// The command line of this process.
std::vector<std::string> command_line();

/// Now, UTC, "2025-11-22T00:49:12Z".
std::string utc_now();

/// CPU time of this process so far [s].
double cpu_seconds();
/// The most memory that this process has held so far [bytes].
std::int64_t peak_memory();

}  // namespace softgrain
