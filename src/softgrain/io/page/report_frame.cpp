#include "softgrain/io/page/report_frame.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "softgrain/io/page/report_chains.hpp"
#include "softgrain/model/scene_in_cell.hpp"

namespace softgrain {

namespace {

/// Column `k` of an array, as floats.
FrameColumn column_of(const Array& array, std::size_t k = 0) {
  FrameColumn column;
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = k; i < values.size(); i += array.columns)
          column.push_back(static_cast<float>(values[i]));
      },
      array.values);
  return column;
}

/// One number for each row: itself, the length of a vector, the largest shear of a plane tensor (xx xy yx
/// yy). Nothing for other shapes.
FrameColumn scalar_of(const Array& array) {
  if (array.columns == 1) return column_of(array);
  FrameColumn scalar;
  if (array.columns == 2) {
    const FrameColumn x = column_of(array, 0), y = column_of(array, 1);
    for (std::size_t i = 0; i < x.size(); ++i) scalar.push_back(std::hypot(x[i], y[i]));
  } else if (array.columns == 4) {
    const FrameColumn xx = column_of(array, 0), xy = column_of(array, 1), yy = column_of(array, 3);
    for (std::size_t i = 0; i < xx.size(); ++i) scalar.push_back(std::hypot((xx[i] - yy[i]) / 2, xy[i]));
  }
  return scalar;
}

/// What a particle is, and not a field that it carries.
bool is_field(std::string_view name) {
  return name != "x" && name != "y" && name != "z" && name != "radius" && name != "grain";
}

void add_fields(ReportFrame& frame, const Scene& scene) {
  for (const auto& [name, array] : scene.particles)
    if (name != "position")
      if (FrameColumn values = scalar_of(array); !values.empty())
        frame.columns["particle." + name] = std::move(values);
}

void add_positions(ReportFrame& frame, const std::map<std::string, Array>& arrays, const std::string& owner) {
  const auto position = arrays.find("position");
  if (position == arrays.end()) return;
  frame.columns[owner + ".x"] = column_of(position->second, 0);
  frame.columns[owner + ".y"] = column_of(position->second, 1);
}

void add_walls(ReportFrame& frame, const Scene& scene) {
  const char* const names[] = {"wall.x0", "wall.y0", "wall.x1", "wall.y1"};
  const Array walls{4, scene.wall_segments};
  for (std::size_t k = 0; k < 4; ++k) frame.columns[names[k]] = column_of(walls, k);
}

std::size_t grain_count(const FrameColumn& grain_of) {
  return grain_of.empty() ? 0
                          : 1 + static_cast<std::size_t>(*std::max_element(grain_of.begin(), grain_of.end()));
}

/// Area and centroid of each outline, and the outline seen from there.
void add_outlines(ReportFrame& frame, const Scene& scene) {
  const auto grain = scene.outlines.find("grain");
  if (grain == scene.outlines.end()) return;
  add_positions(frame, scene.outlines, "outline");
  auto& columns = frame.columns;
  const FrameColumn& owner = columns["outline.grain"] = column_of(grain->second);
  FrameColumn &x = columns["outline.x"], &y = columns["outline.y"];
  const std::size_t grains = grain_count(owner);
  FrameColumn &area = columns["grain.area"], &grain_x = columns["grain.x"], &grain_y = columns["grain.y"];
  for (FrameColumn* column : {&area, &grain_x, &grain_y}) column->assign(grains, 0);
  for (std::size_t begin = 0, end; begin < owner.size(); begin = end) {
    for (end = begin; end < owner.size() && owner[end] == owner[begin];) ++end;
    // A = 1/2 sum (x_i y_j - x_j y_i), A c = 1/6 sum (x_i + x_j)(x_i y_j - x_j y_i), j = i + 1, seen from
    // vertex 0
    const double x0 = x[begin], y0 = y[begin];
    double twice_area = 0, moment_x = 0, moment_y = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t j = i + 1 < end ? i + 1 : begin;
      const double xi = x[i] - x0, yi = y[i] - y0, xj = x[j] - x0, yj = y[j] - y0;
      const double cross = xi * yj - xj * yi;
      twice_area += cross, moment_x += (xi + xj) * cross, moment_y += (yi + yj) * cross;
    }
    const auto g = static_cast<std::size_t>(owner[begin]);
    area[g] = static_cast<float>(std::fabs(twice_area) / 2);
    grain_x[g] = static_cast<float>(x0 + (twice_area != 0 ? moment_x / (3 * twice_area) : 0));
    grain_y[g] = static_cast<float>(y0 + (twice_area != 0 ? moment_y / (3 * twice_area) : 0));
    for (std::size_t i = begin; i < end; ++i) x[i] -= grain_x[g], y[i] -= grain_y[g];
  }
}

/// Means over a grain's particles, weighted by their areas: of each field, and the centre where there is no
/// outline. Positions count from there.
void add_grain_means(ReportFrame& frame) {
  auto& columns = frame.columns;
  if (!columns.contains("particle.grain") || !columns.contains("particle.radius")) return;
  const FrameColumn &grain = columns["particle.grain"], &radius = columns["particle.radius"];
  const auto mean = [&](const std::string& name) {
    std::vector<double> sum(grain_count(grain), 0), weight = sum;
    const FrameColumn& values = columns["particle." + name];
    for (std::size_t i = 0; i < std::min(values.size(), grain.size()); ++i) {
      const double a = double{radius[i]} * double{radius[i]};
      sum[static_cast<std::size_t>(grain[i])] += a * double{values[i]};
      weight[static_cast<std::size_t>(grain[i])] += a;
    }
    for (std::size_t g = 0; g < sum.size(); ++g) sum[g] /= std::max(weight[g], 1e-300);
    return FrameColumn(sum.begin(), sum.end());
  };
  for (const ReportField& field : fields_of(frame)) columns["grain." + field.name] = mean(field.name);
  for (const std::string axis : {"x", "y"}) {
    const std::string centre_name = "grain." + axis;
    if (!columns.contains(centre_name)) columns[centre_name] = mean(axis);
    const FrameColumn& centre = columns[centre_name];
    FrameColumn& position = columns["particle." + axis];
    for (std::size_t i = 0; i < position.size(); ++i)
      position[i] -= centre[static_cast<std::size_t>(grain[i])];
  }
}

/// Of chains across the edges of a periodic cell the page would draw a line through all of it.
void leave_out_crossing(ReportFrame& frame, const Scene& scene, std::size_t movable,
                        std::vector<Chain>& chains) {
  const PeriodicCell<2> cell = cell_of<2>(scene);
  const bool of_grains = frame.contacts_of_grains;
  const FrameColumn x = of_grains ? frame.columns["grain.x"] : column_of(scene.particles.at("position"), 0),
                    y = of_grains ? frame.columns["grain.y"] : column_of(scene.particles.at("position"), 1);
  const auto crosses = [&](const Chain& chain) {
    const auto a = static_cast<std::size_t>(chain.a), b = static_cast<std::size_t>(chain.b);
    if (std::max(a, b) >= movable) return false;
    return cell.nearest({double{x[b]} - x[a], double{y[b]} - y[a]}) != PeriodicCell<2>::Image{};
  };
  chains.erase(std::remove_if(chains.begin(), chains.end(), crosses), chains.end());
}

void add_contacts(ReportFrame& frame, const Scene& scene) {
  std::vector<Chain> chains;
  const auto pair = scene.contacts.find("pair"), force = scene.contacts.find("force");
  if (pair != scene.contacts.end() && force != scene.contacts.end()) {
    const FrameColumn a = column_of(pair->second, 0), b = column_of(pair->second, 1),
                      f = column_of(force->second);
    frame.contacts_of_grains = scene.contacts.contains("position");
    const std::size_t movable = frame.columns[frame.contacts_of_grains ? "grain.x" : "particle.x"].size();
    const std::size_t walls = scene.wall_segments.size() / 4;
    const auto bodies = static_cast<float>(movable + walls);
    for (std::size_t c = 0; c < std::min({a.size(), b.size(), f.size()}); ++c)
      if (f[c] > 0 && std::min(a[c], b[c]) >= 0 && std::max(a[c], b[c]) < bodies)
        chains.push_back({static_cast<int>(a[c]), static_cast<int>(b[c]), double{f[c]}});
    if (!scene.cell.empty()) leave_out_crossing(frame, scene, movable, chains);
  } else {
    frame.contacts_of_grains = true;
    chains = chains_between_outlines(scene);
  }
  std::sort(chains.begin(), chains.end(),
            [](const Chain& c, const Chain& d) { return std::pair(c.a, c.b) < std::pair(d.a, d.b); });
  auto& columns = frame.columns;
  FrameColumn &a = columns["contact.a"], &b = columns["contact.b"], &f = columns["contact.force"];
  for (const Chain& chain : chains) {
    a.push_back(static_cast<float>(chain.a));
    b.push_back(static_cast<float>(chain.b));
    f.push_back(static_cast<float>(chain.force));
  }
}

}  // namespace

std::vector<ReportField> fields_of(const ReportFrame& frame) {
  static const std::vector<ReportField> known{{"pressure", "pressure", "Pa"},
                                              {"coordination", "contacts", ""},
                                              {"J", "volume over that at rest", ""},
                                              {"stress", "largest shear stress", "Pa"},
                                              {"velocity", "speed", "m/s"}};
  const std::string_view prefix = frame.columns.contains("vertex.x") ? "vertex." : "particle.";
  std::vector<ReportField> fields;
  for (const ReportField& field : known)
    if (frame.columns.contains(std::string(prefix) + field.name)) fields.push_back(field);
  for (const auto& [column, values] : frame.columns) {
    if (!column.starts_with(prefix)) continue;
    const std::string name = column.substr(prefix.size());
    const auto same = [&](const ReportField& field) { return field.name == name; };
    if (is_field(name) && std::none_of(known.begin(), known.end(), same)) fields.push_back({name, name, ""});
  }
  return fields;
}

ReportFrame frame_of(const Scene& scene) {
  ReportFrame frame;
  add_positions(frame, scene.particles, "particle");
  add_fields(frame, scene);
  add_walls(frame, scene);
  add_outlines(frame, scene);
  add_grain_means(frame);
  add_contacts(frame, scene);
  return frame;
}

bool can_merge(const ReportFrame& frame, std::size_t size) {
  const auto column = [&](const char* name) {
    const auto at = frame.columns.find(name);
    return at == frame.columns.end() ? FrameColumn{} : at->second;
  };
  const FrameColumn grain = column("particle.grain"), x = column("particle.x"), y = column("particle.y");
  const FrameColumn radius = column("particle.radius");
  const bool has_points = frame.contacts_of_grains && !grain.empty() && radius.size() == grain.size();
  if (!has_points || grain.size() % size != 0) return false;
  for (std::size_t i = 0; i < grain.size(); ++i) {
    const std::size_t first = i - i % size;
    const float reach = 4 * std::sqrt(static_cast<float>(size)) * radius[first];
    if (grain[i] != grain[first] || std::hypot(x[i] - x[first], y[i] - y[first]) > reach) return false;
  }
  return true;
}

void merge_particles(ReportFrame& frame, std::size_t size) {
  if (size < 2) return;
  for (auto& [name, column] : frame.columns) {
    if (!name.starts_with("particle.")) continue;
    FrameColumn merged;
    for (std::size_t i = 0; i < column.size(); i += size) {
      double sum = 0;
      for (std::size_t k = i; k < i + size; ++k) sum += double{column[k]};
      merged.push_back(static_cast<float>(sum / static_cast<double>(size)));
    }
    column = std::move(merged);
  }
  // the group covers the area of its members
  for (float& radius : frame.columns["particle.radius"]) radius *= std::sqrt(static_cast<float>(size));
}

}  // namespace softgrain
