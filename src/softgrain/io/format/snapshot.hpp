#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "softgrain/experiment/run.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// What the steps since the last row of series.csv did: the sums behind its means.
struct StepSums {
  std::int64_t steps = 0;
  std::int64_t sweeps = 0;
  double residual_mean = 0;  ///< sum over the steps of their mean residual [-]
  double residual_max = 0;   ///< worst of all [-]
  double overlap_mean = 0;   ///< sum over the steps of their mean overlap, over the mean primary radius [-]
  double overlap_max = 0;    ///< worst of all, over the mean primary radius [-]

  void add(const StepReport& step);
};

/// All that one restart point holds. A run resumed from it goes on bit for bit as if it had never stopped;
/// what depends on the machine is kept apart in the last two numbers, outside the content hash.
struct Snapshot {
  std::string case_text;  ///< the resolved case
  Checkpoint checkpoint;
  Scene scene;       ///< for plots; not needed to resume
  RunReport report;  ///< of the whole run so far
  StepSums sums;     ///< of the row of series.csv that is not written yet
  double wall_seconds = 0;
  double cpu_seconds = 0;
};

/// The bytes of an HDF5 file (docs/format.md) with a hash of its contents in it and a hash of all bytes
/// behind it. `name` stands for it in messages.
std::string encode_snapshot(Snapshot snapshot, const std::string& name);

/// The inverse. Raises IoError when the bytes are not exactly what `encode_snapshot` wrote: cut short,
/// altered, of another format.
Snapshot decode_snapshot(std::string_view bytes, const std::string& name);

/// What a snapshot holds besides, of which there is never more than a part in memory: particles of the scene,
/// and arrays of the checkpoint, one after the other as a visitor sees them.
struct SnapshotStreams {
  ParticleParts particles{};
  std::function<void(StateVisitor&)> state{};
};

/// Writes the file so that it appears under its name only after it has been read back and found intact.
void write_snapshot(const std::filesystem::path& path, Snapshot snapshot,
                    const SnapshotStreams& streams = {});

/// All, or what a run needs to go on: without the scene, which is checked all the same.
enum class SnapshotParts { all, to_go_on };
Snapshot read_snapshot(const std::filesystem::path& path, SnapshotParts wanted = SnapshotParts::all);

/// Its time [s], without unpacking the rest.
double snapshot_time(const std::filesystem::path& path);

}  // namespace softgrain
