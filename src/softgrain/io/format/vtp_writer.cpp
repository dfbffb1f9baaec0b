#include "softgrain/io/format/vtp_writer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/vtp_text.hpp"

namespace softgrain {

namespace {

/// Rows first .. first + count - 1.
Array rows_of(const Array& array, std::size_t first, std::size_t count) {
  return std::visit(
      [&](const auto& values) -> Array {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(array.columns * first),
                   end = begin + static_cast<std::ptrdiff_t>(array.columns * count);
        return {array.columns, std::vector(begin, end)};
      },
      array.values);
}

void add_array(VtpText& text, const std::string& name, const Array& array) {
  text.array(name, shape_of(array),
             [&](std::size_t first, std::size_t count) { return rows_of(array, first, count); });
}

/// first, first + stride, ...
Array integers(std::size_t first, std::size_t count, std::int64_t begin, std::int64_t stride) {
  std::vector<std::int64_t> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k] = begin + stride * static_cast<std::int64_t>(first + k);
  return {1, std::move(values)};
}

/// Rows of an array, in the order of `rows`.
Array select_rows(const Array& array, const std::vector<std::size_t>& rows) {
  Array selected{array.columns, array.values};
  std::visit(
      [&](auto& values) {
        const auto all = values;
        values.clear();
        for (const std::size_t row : rows)
          for (std::size_t k = 0; k < array.columns; ++k) values.push_back(all[row * array.columns + k]);
      },
      selected.values);
  return selected;
}

std::size_t columns_of(const ParticleRows& particles) {
  const auto at = particles.arrays.find("position");
  return at == particles.arrays.end() ? 2 : at->second.columns;
}

std::size_t count_of(const ParticleRows& particles) {
  const auto at = particles.arrays.find("position");
  return at == particles.arrays.end() ? 0 : at->second.rows;
}

template <class T>
std::vector<T> numbers_of(const ParticleRows& particles, const std::string& name, std::size_t first,
                          std::size_t count) {
  return std::get<std::vector<T>>(particles.rows(name, first, count).values);
}

/// Where lines between bodies end: the particles themselves, or each grain's centre: the mean of its material
/// points, weighted by their areas.
std::vector<double> body_positions(const Scene& scene, const ParticleRows& particles) {
  const std::size_t rows = count_of(particles), columns = columns_of(particles);
  if (!scene.contacts.contains("position"))
    return rows == 0 ? std::vector<double>{} : numbers_of<double>(particles, "position", 0, rows);
  std::vector<double> centre, weight;
  for (const char* name : {"grain", "radius"})
    if (particles.arrays.at(name).rows != rows) throw IoError("the scene's particles belong to no grains");
  for (std::size_t first = 0; first < rows; first += VtpText::rows_at_once) {
    const std::size_t count = std::min(VtpText::rows_at_once, rows - first);
    const auto grain = numbers_of<std::int64_t>(particles, "grain", first, count);
    const auto radius = numbers_of<double>(particles, "radius", first, count),
               x = numbers_of<double>(particles, "position", first, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto g = static_cast<std::size_t>(grain[i]);
      if (grain[i] < 0 || g >= rows) throw IoError("the scene's particles belong to no grains");
      if (g >= weight.size()) weight.resize(g + 1), centre.resize(columns * (g + 1));
      const double area = radius[i] * radius[i];
      weight[g] += area;
      for (std::size_t d = 0; d < columns; ++d) centre[columns * g + d] += area * x[columns * i + d];
    }
  }
  for (std::size_t k = 0; k < centre.size(); ++k) centre[k] /= weight[k / columns];
  return centre;
}

}  // namespace

ParticleRows rows_of_particles(const Scene& scene) {
  ParticleRows particles;
  for (const auto& [name, array] : scene.particles) particles.arrays[name] = shape_of(array);
  particles.rows = [&scene](const std::string& name, std::size_t first, std::size_t count) {
    return rows_of(scene.particles.at(name), first, count);
  };
  return particles;
}

PolyData contacts_of(const Scene& scene, const ParticleRows& particles) {
  PolyData data;
  data.has_lines = true;
  data.columns = columns_of(particles);
  const std::size_t columns = data.columns;
  const auto pair = scene.contacts.find("pair"), place = scene.contacts.find("position");
  if (pair == scene.contacts.end()) return data;
  const auto* places =
      place == scene.contacts.end() ? nullptr : &std::get<std::vector<double>>(place->second.values);
  const auto& ends = std::get<std::vector<std::int64_t>>(pair->second.values);
  const std::vector<double> positions = body_positions(scene, particles);
  const auto bodies = static_cast<std::int64_t>(positions.size() / columns);
  const auto is_body = [&](std::int64_t end) { return end >= 0 && end < bodies; };
  std::unordered_map<std::int64_t, std::int64_t> number;  // of the bodies that lines end at
  const auto add_point = [&](const double* x) {
    data.positions.insert(data.positions.end(), x, x + columns);
    return static_cast<std::int64_t>(data.positions.size() / columns) - 1;
  };
  const auto number_of = [&](std::int64_t body) {
    const auto [found, is_new] = number.try_emplace(body, 0);
    if (is_new) found->second = add_point(&positions[columns * body]);
    return found->second;
  };
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; 2 * k + 1 < ends.size(); ++k) {
    const std::int64_t a = ends[2 * k], b = ends[2 * k + 1];
    if (!is_body(a) || (!is_body(b) && places == nullptr)) continue;
    data.lines.push_back(number_of(a));
    data.lines.push_back(is_body(b) ? number_of(b) : add_point(&(*places)[columns * k]));
    kept.push_back(k);
  }
  for (const auto& [name, array] : scene.contacts)
    if (name != "pair" && name != "position") data.cell_data[name] = select_rows(array, kept);
  return data;
}

PolyData walls_of(const Scene& scene) {
  PolyData data;
  if (const auto faces = scene.surface.find("walls"); faces != scene.surface.end()) {
    data.positions = std::get<std::vector<double>>(faces->second.values);
    data.columns = 3;
    data.quads.resize(data.positions.size() / data.columns);
    std::iota(data.quads.begin(), data.quads.end(), 0);
    return data;
  }
  data.positions = scene.wall_segments;
  data.has_lines = true;
  data.lines.resize(scene.wall_segments.size() / 2);
  std::iota(data.lines.begin(), data.lines.end(), 0);
  return data;
}

PolyData surfaces_of(const Scene& scene) {
  PolyData data;
  data.columns = 3;
  data.point_data = scene.outlines;
  data.positions = std::get<std::vector<double>>(scene.outlines.at("position").values);
  data.point_data.erase("position");
  data.cell_data = scene.surface;
  data.quads = std::get<std::vector<std::int64_t>>(scene.surface.at("quad").values);
  data.cell_data.erase("quad");
  data.cell_data.erase("walls");
  return data;
}

namespace {

/// Points, each of which is a vertex where there are no cells.
struct Piece {
  std::size_t points = 0, lines = 0, quads = 0;
  bool has_cells = false;
};

/// of_points(text), of_cells(text), position(text), cells(text) add the arrays of each.
template <class OfPoints, class OfCells, class Position, class Cells>
std::vector<std::string> vtp_pieces(const Piece& piece, const OfPoints& of_points, const OfCells& of_cells,
                                    const Position& position, std::string_view name_of_cells,
                                    const Cells& cells) {
  VtpText text;
  text.line(R"(<?xml version="1.0"?>)");
  text.line(R"(<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" )"
            R"(header_type="UInt64" compressor="vtkZLibDataCompressor">)");
  text.line("<PolyData>");
  text.line(fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="{}" )"
                        R"(NumberOfStrips="0" NumberOfPolys="{}">)",
                        piece.points, piece.has_cells ? 0 : piece.points, piece.lines, piece.quads));
  text.line("<PointData>");
  of_points(text);
  text.line("</PointData>\n<CellData>");
  of_cells(text);
  text.line("</CellData>\n<Points>");
  position(text);
  text.line("</Points>");
  text.line(fmt::format("<{}>", name_of_cells));
  cells(text);
  text.line(fmt::format("</{}>\n</Piece>\n</PolyData>", name_of_cells));
  return text.finish();
}

/// begin, begin + stride, ..., `count` numbers.
void add_integers(VtpText& text, const char* name, std::size_t count, std::int64_t begin,
                  std::int64_t stride) {
  text.array(name, {.rows = count, .columns = 1, .integers = true},
             [&](std::size_t first, std::size_t rows) { return integers(first, rows, begin, stride); });
}

void add_vertices(VtpText& text, std::size_t points) {
  add_integers(text, "connectivity", points, 0, 1);
  add_integers(text, "offsets", points, 1, 1);
}

std::vector<std::string> particle_pieces(const ParticleRows& particles) {
  const auto add = [&](VtpText& text, const std::string& name) {
    text.array(name, particles.arrays.at(name),
               [&](std::size_t first, std::size_t count) { return particles.rows(name, first, count); });
  };
  const std::size_t points = count_of(particles);
  return vtp_pieces(
      {.points = points},
      [&](VtpText& text) {
        for (const auto& [name, shape] : particles.arrays)
          if (name != "position") add(text, name);
      },
      [](VtpText&) {},
      [&](VtpText& text) {
        if (particles.arrays.contains("position")) return add(text, "position");
        add_array(text, "position", {2, std::vector<double>{}});
      },
      "Verts", [&](VtpText& text) { add_vertices(text, points); });
}

std::vector<std::string> pieces_of(const PolyData& data) {
  const std::size_t points = data.positions.size() / data.columns;
  const std::size_t lines = data.lines.size() / 2, quads = data.quads.size() / 4;
  const bool are_cells = data.has_lines || !data.quads.empty();
  const auto add_all = [](const std::map<std::string, Array>& arrays) {
    return [&arrays](VtpText& text) {
      for (const auto& [name, array] : arrays) add_array(text, name, array);
    };
  };
  return vtp_pieces(
      {.points = points, .lines = lines, .quads = quads, .has_cells = are_cells}, add_all(data.point_data),
      add_all(data.cell_data),
      [&](VtpText& text) {
        add_array(text, "position", {data.columns, data.positions});
      },
      data.has_lines ? "Lines"
      : are_cells    ? "Polys"
                     : "Verts",
      [&](VtpText& text) {
        if (!are_cells) return add_vertices(text, points);
        add_array(text, "connectivity", {1, data.has_lines ? data.lines : data.quads});
        data.has_lines ? add_integers(text, "offsets", lines, 2, 2)
                       : add_integers(text, "offsets", quads, 4, 4);
      });
}

std::string joined(const std::vector<std::string>& pieces) {
  return std::accumulate(pieces.begin(), pieces.end(), std::string());
}

}  // namespace

std::string encode_vtp(const PolyData& data) { return joined(pieces_of(data)); }

std::string encode_vtp(const ParticleRows& particles) { return joined(particle_pieces(particles)); }

void write_scene(const std::filesystem::path& folder, const std::string& label, const Scene& scene,
                 const ParticleRows& particles) {
  const auto write = [&](const char* part, const std::vector<std::string>& pieces) {
    write_pieces(folder / fmt::format("{}_{}.vtp", part, label), pieces, Survives::kill);
  };
  write("particles", particle_pieces(particles));
  write("contacts", pieces_of(contacts_of(scene, particles)));
  write("walls", pieces_of(walls_of(scene)));
  if (!scene.surface.empty()) write("surfaces", pieces_of(surfaces_of(scene)));
}

std::string pvd_text(const std::vector<Frame>& frames, const std::string& folder, bool in_space) {
  std::vector<std::string_view> parts{"particles", "contacts", "walls"};
  if (in_space) parts.push_back("surfaces");
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const Frame& frame : frames) {
    int part = 0;
    for (const std::string_view name : parts)
      text += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}/{}_{}.vtp\"/>\n",
                          frame.time, part++, name, folder, name, frame.label);
  }
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace softgrain
