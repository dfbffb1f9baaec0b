#include "softgrain/io/run/run_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// 123 for "s000123.h5".
std::optional<std::int64_t> step_of(const std::string& name) {
  if (!name.starts_with('s') || !name.ends_with(".h5")) return std::nullopt;
  std::int64_t step = 0;
  const char* end = name.data() + name.size() - 3;
  const auto [stop, error] = std::from_chars(name.data() + 1, end, step);
  if (error != std::errc{} || stop != end || step < 0) return std::nullopt;
  return step;
}

std::vector<fs::path> entries(const fs::path& folder) {
  if (!fs::is_directory(folder)) return {};
  return {fs::begin(fs::directory_iterator(folder)), fs::end(fs::directory_iterator())};
}

/// Files that a killed run had not finished.
void remove_unfinished(const RunPaths& paths) {
  for (const fs::path& folder : {paths.root, paths.snapshot_folder(), paths.vtk_folder()})
    for (const fs::path& file : entries(folder))
      if (file.extension() == ".tmp") fs::remove(file);
}

void refuse_if_in_use(const RunPaths& paths, bool in_use, int process) {
  require(!in_use, "{} is in use by another run, process {}", paths.root.string(), process);
}

void refuse_if_not_empty(const RunPaths& paths) {
  const auto files = entries(paths.root);
  const fs::path begun = paths.run_file().string() + ".tmp";
  // all that a run leaves which was killed at its very start, or as it began anew
  const bool empty = std::all_of(files.begin(), files.end(), [&](const fs::path& file) {
    const bool folder = file == paths.snapshot_folder() || file == paths.vtk_folder();
    return file == paths.lock_file() || file == begun || (folder && fs::is_empty(file));
  });
  require(empty, "{} is not empty; --resume goes on with the run in it, --force begins it anew",
          paths.root.string());
}

enum class Lock { ours, of_another, impossible };

/// Not every file system has locks: those of clusters are often mounted without, and say so in many ways.
Lock try_lock(const Descriptor& file, int kind) {
  int result = 0;
  do result = ::flock(file.number(), kind | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result == 0) return Lock::ours;
  return errno == EWOULDBLOCK ? Lock::of_another : Lock::impossible;
}

int process_named_in(const Descriptor& file) {
  char text[16] = {};
  const ssize_t size = ::pread(file.number(), text, sizeof text, 0);
  int process = 0;
  std::from_chars(text, text + std::max<ssize_t>(size, 0), process);
  return process;
}

}  // namespace

std::vector<SnapshotFile> list_snapshots(const RunPaths& paths) {
  std::vector<SnapshotFile> snapshots;
  for (const fs::path& path : entries(paths.snapshot_folder()))
    if (const auto step = step_of(path.filename().string())) snapshots.push_back({*step, path});
  std::sort(snapshots.begin(), snapshots.end(),
            [](const SnapshotFile& a, const SnapshotFile& b) { return a.step < b.step; });
  return snapshots;
}

std::string snapshot_label(const fs::path& snapshot) { return snapshot.stem().string().substr(1); }

std::unique_ptr<RunDirectory> RunDirectory::take(const fs::path& root, IfNotEmpty if_not_empty) {
  std::unique_ptr<RunDirectory> directory;
  together(communicator().rank() == 0,
           [&] { directory = std::make_unique<RunDirectory>(root, if_not_empty); });
  if (directory == nullptr) directory.reset(new RunDirectory(root));
  return directory;
}

// By way of another constructor, so that the destructor tidies up after a refusal.
RunDirectory::RunDirectory(const fs::path& root, IfNotEmpty if_not_empty) : RunDirectory(root) {
  require(!fs::exists(root) || fs::is_directory(root), "{} is not a directory", root.string());
  for (fs::path folder = root; !folder.empty() && !fs::exists(folder); folder = folder.parent_path())
    made_.push_back(folder);
  std::error_code error;
  fs::create_directories(root, error);
  if (error) throw IoError(fmt::format("{}: cannot create: {}", root.string(), error.message()));
  const int other = running_process(paths_);
  refuse_if_in_use(paths_, other != 0, other);
  if (if_not_empty == IfNotEmpty::refuse)
    refuse_if_not_empty(paths_);  // before a lock file of ours lies there
  lock();
  remove_unfinished(paths_);
}

RunDirectory::~RunDirectory() {
  if (std::error_code unknown; !fs::exists(paths_.run_file(), unknown)) leave_nothing();
}

void RunDirectory::leave_nothing() const {
  std::error_code ignored;  // what is not empty stays
  if (lock_.number() >= 0) fs::remove(paths_.lock_file(), ignored);
  for (const fs::path& folder : made_) fs::remove(folder, ignored);
}

void RunDirectory::lock() {
  Descriptor file = open_file(paths_.lock_file(), O_RDWR | O_CREAT);
  const Lock lock = try_lock(file, LOCK_EX);
  if (lock == Lock::impossible) {
    caution_ = fmt::format(
        "warning: {} cannot be locked ({}): see yourself that no second run writes there at the same time",
        paths_.root.string(), std::strerror(errno));
    std::error_code ignored;
    fs::remove(paths_.lock_file(), ignored);
    return;
  }
  struct stat status {};
  const bool ours = lock == Lock::ours && ::fstat(file.number(), &status) == 0 &&
                    status.st_nlink > 0;  // 0: removed by the run that had it
  refuse_if_in_use(paths_, !ours, process_named_in(file));
  lock_ = std::move(file);
  const std::string process = fmt::format("{}\n", ::getpid());
  if (::ftruncate(lock_.number(), 0) != 0 ||
      ::pwrite(lock_.number(), process.data(), process.size(), 0) != static_cast<ssize_t>(process.size()))
    throw IoError(fmt::format("{}: cannot write: {}", paths_.lock_file().string(), std::strerror(errno)));
}

void RunDirectory::clear() const {
  for (const fs::path& file : {paths_.case_file(), paths_.series_file(), paths_.log_file(),
                               paths_.collection_file(), paths_.report_file()})
    fs::remove(file);
  for (const SnapshotFile& snapshot : list_snapshots(paths_)) fs::remove(snapshot.path);
  for (const fs::path& file : entries(paths_.snapshot_folder()))
    if (file.extension() == ".damaged") fs::remove(file);
  for (const fs::path& file : entries(paths_.vtk_folder()))
    if (file.extension() == ".vtp") fs::remove(file);
  fs::remove(paths_.run_file());  // last: with it, what is left is still a run's
}

int running_process(const RunPaths& paths) {
  if (!fs::exists(paths.lock_file())) return 0;
  const Descriptor file = open_file(paths.lock_file(), O_RDONLY);
  return try_lock(file, LOCK_SH) == Lock::of_another ? process_named_in(file) : 0;
}

}  // namespace softgrain
