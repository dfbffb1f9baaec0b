#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/io/format/file.hpp"

namespace softgrain {

/// Where the files of a run lie, for whoever reads or writes them.
struct RunPaths {
  std::filesystem::path root;

  std::filesystem::path case_file() const { return root / "case.toml"; }
  std::filesystem::path run_file() const { return root / "run.json"; }
  std::filesystem::path series_file() const { return root / "series.csv"; }
  std::filesystem::path log_file() const { return root / "log.txt"; }
  std::filesystem::path collection_file() const { return root / "run.pvd"; }
  std::filesystem::path report_file() const { return root / "report.html"; }
  std::filesystem::path lock_file() const { return root / ".lock"; }
  std::filesystem::path snapshot_folder() const { return root / "snap"; }
  std::filesystem::path vtk_folder() const { return root / "vtk"; }
};

/// snap/s000123.h5: the state after 123 steps.
struct SnapshotFile {
  std::int64_t step = 0;
  std::filesystem::path path;
};

/// The restart points of a run, oldest first. Unchecked.
std::vector<SnapshotFile> list_snapshots(const RunPaths& paths);

/// "000123" for snap/s000123.h5.
std::string snapshot_label(const std::filesystem::path& snapshot);

/// A run's directory, made when missing, and ours alone until this object goes: a second run is refused
/// (UsageError, naming the other's process). Where no run was begun (no run.json), nothing of it stays. On a
/// file system without locks (flock) the directory is taken all the same, and caution() says so.
class RunDirectory {
 public:
  enum class IfNotEmpty { refuse, keep };
  RunDirectory(const std::filesystem::path& root, IfNotEmpty if_not_empty);
  /// Of several ranks the first one takes it, for all.
  static std::unique_ptr<RunDirectory> take(const std::filesystem::path& root, IfNotEmpty if_not_empty);
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;
  ~RunDirectory();

  const RunPaths& paths() const { return paths_; }

  /// "warning: ..." where a second run could not be refused; "" otherwise.
  const std::string& caution() const { return caution_; }

  /// Removes an earlier run's results and nothing else.
  void clear() const;

 private:
  explicit RunDirectory(const std::filesystem::path& root) : paths_{root} {}
  void lock();
  void leave_nothing() const;

  RunPaths paths_;
  std::vector<std::filesystem::path> made_;  ///< folders that were not there before, innermost first
  Descriptor lock_;
  std::string caution_;
};

/// Process that runs in the directory now; 0 for none, or where the file system has no locks.
int running_process(const RunPaths& paths);

}  // namespace softgrain
