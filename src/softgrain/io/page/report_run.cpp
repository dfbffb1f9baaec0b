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
#include "softgrain/io/page/report_codec.hpp"
#include "softgrain/io/page/report_frame.hpp"

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
  }

  const std::vector<ReportFrame>& all() const { return frames_; }
  std::size_t every() const { return every_; }
  std::size_t merged() const { return merged_; }

 private:
  bool read(const fs::path& path) {
    try {
      const Snapshot snapshot = read_snapshot(path);
      ReportFrame frame = frame_of(snapshot.scene);
      frame.step = snapshot.checkpoint.step;
      frame.time = snapshot.checkpoint.time;
      frames_.push_back(std::move(frame));
      return true;
    } catch (const IoError& error) {
      run_.warnings.emplace_back(error.what());
      return false;
    }
  }

  /// The four points of a cell are shown by their mean, always: within a cell the pressure of a nearly
  /// incompressible material oscillates without meaning.
  void choose_thinning(double frames, const ReportLimits& limits) {
    const auto& columns = frames_.front().columns;
    const auto x = columns.find("particle.x");
    double count = x == columns.end() ? 0 : frames * static_cast<double>(x->second.size());
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

/// Whole numbers from 0 that a float holds exactly.
bool is_whole(const FrameColumn& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float v) { return v >= 0 && v < 16777216.0F && v == std::floor(v); });
}

/// Where something is, and how large; else a field, of which a few levels are seen.
bool is_geometry(std::string_view name) {
  return !name.starts_with("particle.") || name == "particle.x" || name == "particle.y" ||
         name == "particle.radius";
}

double extent(const FrameColumn& values) {
  if (values.empty()) return 0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return double{*high} - double{*low};
}

/// Width or height of the picture, about.
double picture_size(const ReportFrame& frame) {
  double size = 0;
  for (const auto& [name, values] : frame.columns)
    if (name.ends_with(".x") || name.ends_with(".y") || name.starts_with("wall."))
      size = std::max(size, extent(values));
  return size;
}

constexpr std::size_t few = 1 << 18;  ///< numbers that cost little

/// How far apart numbers may lie that the page need not tell apart, where there are many: outlines 1/8192 of
/// the picture, particles 1/4096, their fields 1/32 of the range; the widths of lines 1/255.
double resolution(const std::string& name, const FrameColumn& values, double picture) {
  if (name == "contact.force") return extent(values) / 255;
  if (values.size() <= few) return 0;
  if (!is_geometry(name)) return extent(values) / 31;
  return picture / (name.starts_with("particle.") ? 4096 : 8192);
}

/// The middle 99 % keep their values, the rest takes the nearest of these: few levels must do.
void clip_outliers(FrameColumn& values) {
  FrameColumn sorted = values;
  const auto quantile = [&](double share) {
    const auto place =
        sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), place, sorted.end());
    return *place;
  };
  const float low = quantile(0.005), high = quantile(0.995);
  for (float& value : values) value = std::clamp(value, low, high);
}

/// One column in all frames, one after another.
struct Gathered {
  FrameColumn values;
  std::size_t stride = 1;  ///< from a number to the one that it is coded against
  std::size_t frames = 1;  ///< 1 where it never changes
};

/// Nothing where frames lack the column or, for other than contacts, their sizes differ.
Gathered gather(const std::vector<ReportFrame>& frames, const std::string& name) {
  const bool ragged = name.starts_with("contact.");
  const FrameColumn& first = frames.front().columns.at(name);
  // the radius of a material point hardly changes
  bool changes = ragged;
  const bool keep_first = name == "particle.radius" && frames.front().columns.contains("outline.x");
  FrameColumn all;
  for (const ReportFrame& frame : frames) {
    const auto column = frame.columns.find(name);
    if (column == frame.columns.end() || (!ragged && column->second.size() != first.size())) return {};
    changes = changes || (column->second != first && !keep_first);
    all.insert(all.end(), column->second.begin(), column->second.end());
  }
  if (!changes) return {.values = first};
  return {std::move(all), ragged ? 1 : first.size(), frames.size()};
}

void add_arrays(const std::vector<ReportFrame>& frames, Json& header, std::string& planes) {
  Json arrays = Json::array();
  const double picture = picture_size(frames.front());
  for (const auto& [name, first] : frames.front().columns) {
    auto [values, stride, stored_frames] = gather(frames, name);
    if (values.empty()) continue;
    const bool whole = is_whole(values);
    if (!whole && !is_geometry(name) && values.size() > few) clip_outliers(values);
    const EncodedArray array = whole ? encode_indices(values, stride)
                                     : encode_reals(values, stride, resolution(name, values, picture));
    arrays.push_back({{"name", name},
                      {"low", array.low},
                      {"step", array.step},
                      {"bytes", array.bytes},
                      {"count", array.count},
                      {"stride", stride},
                      {"frames", stored_frames}});
    planes += array.planes;
  }
  header["arrays"] = arrays;
}

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
  add_arrays(frames.all(), header, planes);
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  run.payload = compressed(little_endian(text.size()) + text + planes, Container::gzip, page_compression);
  run.frames = frames.all().size();
  return run;
}

}  // namespace softgrain
