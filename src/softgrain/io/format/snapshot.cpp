#include "softgrain/io/format/snapshot.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/core/version.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/format/snapshot_groups.hpp"
#include "softgrain/io/format/snapshot_hashes.hpp"

namespace softgrain {

namespace {

constexpr std::string_view format_name = "softgrain-snapshot";
constexpr std::int64_t format_version = 1;

/// Absolute path in the file -> dataset.
using Datasets = std::map<std::string, Array>;

/// Of these 0.1.0 before its release knew nothing.
constexpr std::array<std::string_view, 3> later_totals{"residual_limit", "energy_error", "energy_scale"};

/// The datasets of /run: the same list writes and reads them.
template <class Report, class Sums, class Visit>
void for_each_total(Report& report, Sums& sums, Visit&& visit) {
  visit("steps", report.steps);
  visit("steps_converged", report.steps_converged);
  visit("sweeps", report.sweeps);
  visit("residual_max", report.residual_max);
  visit("residual_limit", report.residual_limit);
  visit("overlap_max", report.overlap_max);
  visit("energy_error", report.energy.error);
  visit("energy_scale", report.energy.scale);
  visit("row_steps", sums.steps);
  visit("row_sweeps", sums.sweeps);
  visit("row_residual_mean", sums.residual_mean);
  visit("row_residual_max", sums.residual_max);
  visit("row_overlap_mean", sums.overlap_mean);
  visit("row_overlap_max", sums.overlap_max);
}

Datasets datasets_of(Snapshot snapshot) {
  Datasets datasets;
  const auto add = [&](const std::string& group, std::map<std::string, Array>& arrays) {
    for (auto& [name, array] : arrays) datasets[group + name] = std::move(array);
  };
  add(checkpoint_group, snapshot.checkpoint.arrays);
  add(particle_group, snapshot.scene.particles);
  add(contact_group, snapshot.scene.contacts);
  add(outline_group, snapshot.scene.outlines);
  add(surface_group, snapshot.scene.surface);
  datasets[walls_path] = {4, snapshot.scene.wall_segments};
  const std::vector<double>& cell = snapshot.scene.cell;
  if (!cell.empty()) datasets[cell_path] = {cell.size() == 4 ? 2U : 3U, cell};
  for_each_total(snapshot.report, snapshot.sums, [&](const char* name, const auto& value) {
    datasets[run_group + name] = {1, std::vector{value}};
  });
  return datasets;
}

/// Takes out the arrays of one group, by their names in it.
std::map<std::string, Array> arrays_of(Datasets& datasets, const std::string& group) {
  std::map<std::string, Array> arrays;
  for (auto at = datasets.lower_bound(group); at != datasets.end() && at->first.starts_with(group); ++at)
    arrays[at->first.substr(group.size())] = std::move(at->second);
  return arrays;
}

/// Distributes datasets whose hash is right; what is missing then was written by another program.
Snapshot snapshot_of(Datasets datasets, const std::string& name, SnapshotParts wanted) {
  Snapshot snapshot;
  try {
    snapshot.checkpoint.arrays = arrays_of(datasets, checkpoint_group);
    snapshot.scene.particles = arrays_of(datasets, particle_group);
    snapshot.scene.contacts = arrays_of(datasets, contact_group);
    snapshot.scene.outlines = arrays_of(datasets, outline_group);
    snapshot.scene.surface = arrays_of(datasets, surface_group);
    if (wanted == SnapshotParts::all)
      snapshot.scene.wall_segments = std::get<std::vector<double>>(datasets.at(walls_path).values);
    if (const auto cell = datasets.find(cell_path); cell != datasets.end())
      snapshot.scene.cell = std::get<std::vector<double>>(cell->second.values);
    for_each_total(snapshot.report, snapshot.sums, [&]<class T>(std::string_view total, T& value) {
      const bool is_late = std::ranges::find(later_totals, total) != later_totals.end();
      if (is_late && !datasets.contains(run_group + std::string(total))) return;
      value = std::get<std::vector<T>>(datasets.at(run_group + std::string(total)).values).at(0);
    });
  } catch (const std::logic_error&) {  // at
    throw IoError(fmt::format("{}: a dataset is missing", name));
  } catch (const std::bad_variant_access&) {
    throw IoError(fmt::format("{}: a dataset has the wrong type", name));
  }
  return snapshot;
}

void check_format(const Hdf5Reader& file, const std::string& name) {
  if (file.text_attribute("format") != format_name)
    throw IoError(fmt::format("{}: not a {}", name, format_name));
  const auto version = file.integer_attribute("version");
  if (version != format_version)
    throw IoError(
        fmt::format("{}: snapshot of version {}; this program reads {}", name, version, format_version));
  if (file.integer_attribute("complete") != 1)
    throw IoError(fmt::format("{}: snapshot is not complete", name));
}

/// Raises std::bad_alloc here, where it is caught, if there is no room for what the HDF5 library will need:
/// it may crash where it runs out of memory.
void require_room(std::size_t open_datasets) {
  constexpr std::size_t of_dataset = 2 << 20;  // a chunk in its cache, and on its way through the checksum
  std::string room;
  room.reserve((open_datasets + 1) * of_dataset);
}

}  // namespace

void StepSums::add(const StepReport& step) {
  ++steps;
  sweeps += step.sweeps;
  residual_mean += step.residual_mean;
  residual_max = std::max(residual_max, step.residual_max);
  overlap_mean += step.overlap_mean;
  overlap_max = std::max(overlap_max, step.overlap_max);
}

namespace {

/// Writes each array of a state as it sees it.
class StateToFile final : public StateVisitor {
 public:
  explicit StateToFile(Hdf5Writer& file) : file_(file) {}
  bool reads() const override { return false; }

 private:
  void reals(const Field& field, std::vector<double>& values, std::size_t columns, Length) override {
    file_.write(checkpoint_group + field.name, values, columns);
  }
  void integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns, Length) override {
    file_.write(checkpoint_group + field.name, values, columns);
  }

  Hdf5Writer& file_;
};

void write_parts(Hdf5Writer& file, const ParticleParts& parts) {
  for (const auto& [name, shape] : parts.arrays) file.begin_dataset(particle_group + name, shape);
  std::map<std::string, std::size_t> written;
  for (int part = 0; part < parts.count; ++part)
    for (const auto& [name, rows] : parts.rows(part)) {
      file.write_rows(particle_group + name, written[name], rows);
      written[name] += shape_of(rows).rows;
    }
  for (const auto& [name, shape] : parts.arrays)
    if (written[name] != shape.rows) throw IoError(fmt::format("a rank did not give its rows of '{}'", name));
}

/// An array is given up as soon as it stands in the file: of a large run there is no room for all of them
/// twice. The hashes are of what the store gives back. Where the store has an error, nothing is complete.
void write_into(ByteStore& store, Snapshot snapshot, const SnapshotStreams& streams,
                const std::string& name) {
  const BuildInfo build = build_info();
  require_room(streams.particles.arrays.size());
  Hdf5Writer file(name, store);
  file.write_attribute("format", format_name);
  file.write_attribute("version", format_version);
  file.write_attribute("program",
                       std::string_view(fmt::format("softgrain {} ({})", build.version, build.commit)));
  file.write_attribute("step", snapshot.checkpoint.step);
  file.write_attribute("time", snapshot.checkpoint.time);
  file.write_attribute("wall_seconds", snapshot.wall_seconds);
  file.write_attribute("cpu_seconds", snapshot.cpu_seconds);
  file.write_attribute("case", std::string_view(snapshot.case_text));
  file.write_attribute("content_hash", std::string_view(std::string(hash_length, '0')));
  file.write_attribute("complete", std::int64_t{0});
  for (auto& [path, array] : datasets_of(std::move(snapshot))) {
    file.write(path, array);
    array = {};
  }
  StateToFile state(file);
  if (streams.state) streams.state(state);
  write_parts(file, streams.particles);
  file.open_again();
  if (store.error() != 0) return;
  file.write_attribute("content_hash", std::string_view(content_hash(file)));
  file.write_attribute("complete", std::int64_t{1});
  file.close();
  if (store.error() == 0) store.write(store.size(), file_hash(store, store.size(), name));
}

Snapshot read_from(std::unique_ptr<ByteStore> store, const std::string& name, SnapshotParts wanted) {
  check_bytes(*store, name);
  const Hdf5Reader file(std::move(store), name);
  check_format(file, name);
  Datasets datasets;
  ContentHash hash;
  for (const std::string& path : file.datasets()) {
    if (wanted == SnapshotParts::to_go_on && path.starts_with(scene_group)) {
      hash.add(file, path);
      continue;
    }
    const Array& array = datasets[path] = file.read(path);
    hash.begin(path, shape_of(array));
    hash.add(array);
  }
  if (hash.digest() != file.text_attribute("content_hash"))
    throw IoError(fmt::format("{}: damaged: its content hash is wrong", name));
  Snapshot snapshot = snapshot_of(std::move(datasets), name, wanted);
  snapshot.checkpoint.step = file.integer_attribute("step");
  snapshot.checkpoint.time = file.real_attribute("time");
  snapshot.wall_seconds = file.real_attribute("wall_seconds");
  snapshot.cpu_seconds = file.real_attribute("cpu_seconds");
  snapshot.case_text = file.text_attribute("case");
  return snapshot;
}

}  // namespace

std::string encode_snapshot(Snapshot snapshot, const std::string& name) {
  MemoryBytes store;
  write_into(store, std::move(snapshot), {}, name);
  if (store.error() != 0) throw std::bad_alloc();
  return std::move(store.bytes());
}

Snapshot decode_snapshot(std::string_view bytes, const std::string& name) {
  return read_from(std::make_unique<ViewedBytes>(bytes), name, SnapshotParts::all);
}

void write_snapshot(const std::filesystem::path& path, Snapshot snapshot, const SnapshotStreams& streams) {
  PendingFile file(path);
  FileBytes store(file.descriptor());
  write_into(store, std::move(snapshot), streams, path.string());
  file.end_writing(store.size() + (store.error() == 0 ? 0 : hash_length), store.error());
  file.commit();
}

Snapshot read_snapshot(const std::filesystem::path& path, SnapshotParts wanted) {
  return read_from(std::make_unique<FileBytes>(path), path.string(), wanted);
}

double snapshot_time(const std::filesystem::path& path) {
  auto store = std::make_unique<FileBytes>(path);
  check_bytes(*store, path.string());
  return Hdf5Reader(std::move(store), path.string()).real_attribute("time");
}

}  // namespace softgrain
