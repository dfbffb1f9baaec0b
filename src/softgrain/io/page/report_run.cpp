#include "softgrain/io/page/report_run.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/format/compress.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/page/report_arrays.hpp"
#include "softgrain/io/page/report_frame.hpp"
#include "softgrain/io/page/report_surfaces.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

constexpr int page_compression = 6;

using Json = nlohmann::ordered_json;

std::string text_or_nothing(const fs::path& path) { return fs::exists(path) ? read_file(path) : ""; }

/// The header, every `every`-th row, and the last; a torn last line is left out.
std::string thinned_rows(const std::string& text, std::size_t every) {
  std::string kept;
  std::size_t row = 0;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos;
       begin = end + 1, ++row)
    if (row == 0 || (row - 1) % every == 0 || text.find('\n', end + 1) == std::string::npos)
      kept.append(text, begin, end + 1 - begin);
  return kept;
}

/// How many to take as one so that `count` is at most `limit`.
std::size_t share(double count, double limit) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(count / limit)));
}

/// Frames of a run, thinned to the limits.
class Frames {
 public:
  Frames(const RunPaths& paths, const ReportLimits& limits, ReportRun& run) : run_(run) {
    const auto files = list_snapshots(paths);
    require(!files.empty(), "{} has no snapshots to show; `softgrain resume {}` goes on with the run",
            paths.root.string(), paths.root.string());
    for (std::size_t k = 0; k < files.size(); ++k) {
      if (k % every_ != 0 && k + 1 < files.size()) continue;
      if (!read(files[k].path)) continue;
      if (frames_.size() == 1) choose_thinning(static_cast<double>(files.size()), limits);
      merge_particles(frames_.back(), merged_);
    }
    require(!frames_.empty(), "{}: none of {} snapshots can be shown; `softgrain verify {}` says why",
            paths.root.string(), files.size(), paths.root.string());
    drop_weak_contacts(limits.contacts);
    part_off_motion(frames_);
    if (vertices() * static_cast<double>(frames_.size()) > limits.fields) keep_pressure_alone(frames_);
  }

  const std::vector<ReportFrame>& all() const { return frames_; }
  std::size_t every() const { return every_; }
  std::size_t merged() const { return merged_; }

 private:
  bool read(const fs::path& path) {
    try {
      const Snapshot snapshot = read_snapshot(path);
      const bool in_space = snapshot.scene.surface.contains("quad");
      ReportFrame frame = in_space ? frame_of_surfaces(snapshot.scene) : frame_of(snapshot.scene);
      frame.step = snapshot.checkpoint.step;
      frame.time = snapshot.checkpoint.time;
      frames_.push_back(std::move(frame));
      return true;
    } catch (const IoError& error) {
      run_.warnings.emplace_back(error.what());
      return false;
    }
  }

  double vertices() const {
    const auto x = frames_.front().columns.find("vertex.x");
    return x == frames_.front().columns.end() ? 0 : static_cast<double>(x->second.size());
  }

  /// The four points of a cell are shown by their mean, always: within a cell the pressure of a nearly
  /// incompressible material oscillates without meaning.
  void choose_thinning(double frames, const ReportLimits& limits) {
    const auto& columns = frames_.front().columns;
    const auto x = columns.find("particle.x");
    double count = frames * (x == columns.end() ? vertices() : static_cast<double>(x->second.size()));
    while ((merged_ == 1 || count > limits.particles) && can_merge(frames_.front(), 4 * merged_)) {
      merged_ *= 4;
      count /= 4;
    }
    every_ = share(count, limits.particles);
  }

  /// Below 1 % of a strong force a line cannot be seen.
  void drop_weak_contacts(double limit) {
    FrameColumn forces;
    for (const ReportFrame& frame : frames_) {
      const FrameColumn& force = frame.columns.at("contact.force");
      forces.insert(forces.end(), force.begin(), force.end());
    }
    if (forces.empty()) return;
    const auto largest = [&](std::size_t rank) {
      const auto place = forces.begin() + static_cast<std::ptrdiff_t>(std::min(rank, forces.size() - 1));
      std::nth_element(forces.begin(), place, forces.end(), std::greater<>());
      return *place;
    };
    float least = 0.01F * largest(forces.size() / 100);
    if (static_cast<double>(forces.size()) > limit)
      least = std::max(least, largest(static_cast<std::size_t>(limit)));
    for (ReportFrame& frame : frames_) {
      const FrameColumn force = frame.columns["contact.force"];
      for (const char* name : {"contact.a", "contact.b", "contact.force"}) {
        FrameColumn &column = frame.columns[name], kept;
        for (std::size_t c = 0; c < force.size(); ++c)
          if (force[c] >= least) kept.push_back(column[c]);
        column = std::move(kept);
      }
    }
  }

  ReportRun& run_;
  std::vector<ReportFrame> frames_;
  std::size_t every_ = 1;   ///< snapshots shown: every which
  std::size_t merged_ = 1;  ///< points in one
};

Json provenance(const RunPaths& paths) {
  require(fs::is_directory(paths.root), "{} is not a directory; `softgrain run CASE -o {}` makes a run there",
          paths.root.string(), paths.root.string());
  require(fs::exists(paths.run_file()),
          "{} is not a run's directory: it has no run.json; `softgrain run CASE -o {}` makes one",
          paths.root.string(), paths.root.string());
  try {
    return Json::parse(read_file(paths.run_file()));
  } catch (const Json::exception& error) {
    throw UsageError(
        fmt::format("{}: not a run.json; run the case again: {}", paths.run_file().string(), error.what()));
  }
}

/// The resolved case as JSON; nothing where there is none that this version reads.
Json settings_of(const std::string& case_text, const std::string& name) {
  try {
    if (case_text.empty()) return Json::object();
    return Json::parse(case_json(parse_recorded_case(case_text, name)));
  } catch (const UsageError&) {
    return Json::object();
  }
}

Json fields_json(const ReportFrame& frame) {
  Json fields = Json::array();
  for (const ReportField& field : fields_of(frame))
    fields.push_back({{"name", field.name}, {"label", field.label}, {"unit", field.unit}});
  return fields;
}

std::string little_endian(std::size_t number) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(number >> 8 * k & 255);
  return bytes;
}

}  // namespace

ReportRun encode_run(const RunPaths& paths, const std::string& name, const ReportLimits& limits) {
  ReportRun run;
  Json header = {{"format", "softgrain-report"}, {"version", 1}, {"name", name}, {"run", provenance(paths)}};
  const Frames frames(paths, limits, run);
  const std::string series = text_or_nothing(paths.series_file());
  const auto rows = static_cast<double>(std::count(series.begin(), series.end(), '\n'));
  header["case"] = text_or_nothing(paths.case_file());
  header["settings"] = settings_of(header["case"], paths.case_file().string());
  header["fields"] = fields_json(frames.all().front());
  header["rows_every"] = share(rows, limits.rows);
  header["series"] = thinned_rows(series, header["rows_every"]);
  header["snapshots_every"] = frames.every();
  header["points_merged"] = frames.merged();
  header["damaged"] = run.warnings.size();
  header["contacts_of_grains"] = frames.all().front().contacts_of_grains;
  for (const ReportFrame& frame : frames.all()) {
    header["steps"].push_back(frame.step);
    header["times"].push_back(frame.time);
    header["contacts"].push_back(frame.columns.at("contact.force").size());
  }
  std::string planes;
  header["arrays"] = Json::array();
  for (const EncodedColumn& column : encode_columns(frames.all())) {
    const EncodedArray& array = column.array;
    header["arrays"].push_back({{"name", column.name},
                                {"low", array.low},
                                {"step", array.step},
                                {"bytes", array.bytes},
                                {"count", array.count},
                                {"stride", column.stride},
                                {"frames", column.frames}});
    planes += array.planes;
  }
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  run.payload = compressed(little_endian(text.size()) + text + planes, Container::gzip, page_compression);
  run.frames = frames.all().size();
  return run;
}

}  // namespace softgrain
