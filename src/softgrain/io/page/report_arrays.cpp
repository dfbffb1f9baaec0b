#include "softgrain/io/page/report_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace softgrain {

namespace {

/// Whole numbers from 0 that a float holds exactly.
bool is_whole(const FrameColumn& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float v) { return v >= 0 && v < 16777216.0F && v == std::floor(v); });
}

/// Where something is, and how large; else a field, of which a few levels are seen.
bool is_geometry(std::string_view name) {
  const bool is_field = name.starts_with("particle.") || name.starts_with("vertex.");
  return !is_field || name.ends_with(".x") || name.ends_with(".y") || name.ends_with(".z") ||
         name == "particle.radius";
}

double extent(const FrameColumn& values) {
  if (values.empty()) return 0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return double{*high} - double{*low};
}

/// Width or height of the picture, about; of grains in space the size of one, 2 (3 V/4 pi)^(1/3) in the mean.
double picture_size(const ReportFrame& frame) {
  if (const auto volume = frame.columns.find("grain.volume"); volume != frame.columns.end()) {
    double diameters = 0;
    for (const float v : volume->second) diameters += std::cbrt(6 / std::numbers::pi * double{std::fabs(v)});
    return diameters / static_cast<double>(volume->second.size());
  }
  double size = 0;
  for (const auto& [name, values] : frame.columns)
    if (name.ends_with(".x") || name.ends_with(".y") || name.starts_with("wall."))
      size = std::max(size, extent(values));
  return size;
}

constexpr std::size_t few = 1 << 18;        ///< numbers that cost little
constexpr std::size_t very_many = 2000000;  ///< of vertices in space

/// How far apart numbers may lie that the page need not tell apart, where there are many: outlines 1/8192 of
/// the picture, particles 1/4096, their fields 1/32 of the range; the widths of lines 1/255. In space
/// vertices 1/400 of a grain, of very many 1/200 and their fields 1/20; what deforms a grain as a whole 1e-4.
double resolution(const std::string& name, const FrameColumn& values, double picture) {
  if (name == "contact.force") return extent(values) / 255;
  if (name.starts_with("grain.a") && name.size() == std::string_view("grain.a00").size()) return 1e-4;
  if (values.size() <= few) return 0;
  const bool of_surface = name.starts_with("vertex."), all = of_surface && values.size() > very_many;
  if (!is_geometry(name)) return extent(values) / (all ? 19 : 31);
  if (of_surface) return picture / (all ? 200 : 400);
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

}  // namespace

std::vector<EncodedColumn> encode_columns(const std::vector<ReportFrame>& frames) {
  std::vector<EncodedColumn> columns;
  const double picture = picture_size(frames.front());
  for (const auto& [name, first] : frames.front().columns) {
    auto [values, stride, stored_frames] = gather(frames, name);
    if (values.empty()) continue;
    const bool whole = is_whole(values);
    if (!whole && !is_geometry(name) && values.size() > few) clip_outliers(values);
    columns.push_back({name, stride, stored_frames,
                       whole ? encode_indices(values, stride)
                             : encode_reals(values, stride, resolution(name, values, picture))});
  }
  return columns;
}

}  // namespace softgrain
