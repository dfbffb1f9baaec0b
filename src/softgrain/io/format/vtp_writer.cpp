#include "softgrain/io/format/vtp_writer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/io/format/compress.hpp"
#include "softgrain/io/format/file.hpp"

namespace softgrain {

namespace {

constexpr int fastest_compression = 1;
constexpr std::size_t block_size = 1 << 20;

float as_float(double value) {
  const auto narrow = static_cast<float>(value);
  return std::fabs(narrow) < FLT_MIN ? 0.0F : narrow;
}

template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// VTK's compressed array: number of blocks, size of a block, of a last partial one, of each when compressed;
/// then the blocks.
std::string compressed_blocks(std::string_view raw) {
  const std::size_t count = (raw.size() + block_size - 1) / block_size;
  std::vector<std::string> block(count);
  parallel_for(static_cast<int>(count), [&](int k) {
    block[k] = compressed(raw.substr(k * block_size, block_size), Container::zlib, fastest_compression);
  });
  std::vector<std::uint64_t> sizes{count, block_size, raw.size() % block_size};
  for (const std::string& packed : block) sizes.push_back(packed.size());
  std::string blocks = raw_bytes(sizes);
  for (const std::string& packed : block) blocks += packed;
  return blocks;
}

/// The XML of a .vtp file and, behind it, its binary blocks.
class VtpText {
 public:
  void line(std::string_view text) { xml_ += fmt::format("{}\n", text); }

  void array(const std::string& name, const Array& array) {
    if (const auto* reals = std::get_if<std::vector<double>>(&array.values)) {
      const std::size_t columns = array.columns == 2 ? 3 : array.columns;
      std::vector<float> floats;
      floats.reserve(reals->size() / array.columns * columns);
      for (std::size_t k = 0; k < reals->size(); ++k) {
        floats.push_back(as_float((*reals)[k]));
        if (array.columns == 2 && k % 2 == 1) floats.push_back(0);
      }
      block("Float32", name, columns, raw_bytes(floats));
    } else {
      block("Int64", name, array.columns, raw_bytes(std::get<std::vector<std::int64_t>>(array.values)));
    }
  }

  std::string finish() const {
    return xml_ + "<AppendedData encoding=\"raw\">\n_" + blocks_ + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  void block(std::string_view type, const std::string& name, std::size_t columns, const std::string& raw) {
    line(fmt::format(
        R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)", type,
        name, columns, blocks_.size()));
    blocks_ += compressed_blocks(raw);
  }

  std::string xml_, blocks_;
};

Array integers(std::size_t count, std::int64_t first, std::int64_t stride) {
  std::vector<std::int64_t> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k] = first + stride * static_cast<std::int64_t>(k);
  return {1, values};
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

std::vector<double> positions_of(const Scene& scene) {
  const auto at = scene.particles.find("position");
  return at == scene.particles.end() ? std::vector<double>{}
                                     : std::get<std::vector<double>>(at->second.values);
}

std::size_t columns_of(const Scene& scene) {
  const auto at = scene.particles.find("position");
  return at == scene.particles.end() ? 2 : at->second.columns;
}

/// Where lines between bodies end: the particles themselves, or each grain's centre: the mean of its material
/// points, weighted by their areas.
std::vector<double> body_positions(const Scene& scene) {
  std::vector<double> x = positions_of(scene);
  if (!scene.contacts.contains("position")) return x;
  const auto& grain = std::get<std::vector<std::int64_t>>(scene.particles.at("grain").values);
  const auto& radius = std::get<std::vector<double>>(scene.particles.at("radius").values);
  if (grain.empty()) return {};
  const auto [least, most] = std::minmax_element(grain.begin(), grain.end());
  const std::size_t columns = columns_of(scene);
  if (columns * grain.size() != x.size() || radius.size() != grain.size() || *least < 0 ||
      *most >= static_cast<std::int64_t>(grain.size()))
    throw IoError("the scene's particles belong to no grains");
  const std::int64_t grains = *most + 1;
  std::vector<double> centre(columns * grains, 0), weight(grains, 0);
  for (std::size_t i = 0; i < grain.size(); ++i) {
    const double area = radius[i] * radius[i];
    weight[grain[i]] += area;
    for (std::size_t d = 0; d < columns; ++d) centre[columns * grain[i] + d] += area * x[columns * i + d];
  }
  for (std::size_t k = 0; k < centre.size(); ++k) centre[k] /= weight[k / columns];
  return centre;
}

}  // namespace

PolyData particles_of(const Scene& scene) {
  PolyData data;
  data.positions = positions_of(scene);
  data.columns = columns_of(scene);
  data.point_data = scene.particles;
  data.point_data.erase("position");
  return data;
}

PolyData contacts_of(const Scene& scene) {
  PolyData data;
  data.has_lines = true;
  data.columns = columns_of(scene);
  const std::size_t columns = data.columns;
  const auto pair = scene.contacts.find("pair"), place = scene.contacts.find("position");
  if (pair == scene.contacts.end()) return data;
  const auto* places =
      place == scene.contacts.end() ? nullptr : &std::get<std::vector<double>>(place->second.values);
  const auto& ends = std::get<std::vector<std::int64_t>>(pair->second.values);
  const std::vector<double> positions = body_positions(scene);
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

std::string encode_vtp(const PolyData& data) {
  const std::size_t points = data.positions.size() / data.columns;
  const std::size_t lines = data.lines.size() / 2, quads = data.quads.size() / 4;
  const bool are_cells = data.has_lines || !data.quads.empty();
  VtpText text;
  text.line(R"(<?xml version="1.0"?>)");
  text.line(R"(<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" )"
            R"(header_type="UInt64" compressor="vtkZLibDataCompressor">)");
  text.line("<PolyData>");
  text.line(fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="{}" )"
                        R"(NumberOfStrips="0" NumberOfPolys="{}">)",
                        points, are_cells ? 0 : points, lines, quads));
  text.line("<PointData>");
  for (const auto& [name, array] : data.point_data) text.array(name, array);
  text.line("</PointData>\n<CellData>");
  for (const auto& [name, array] : data.cell_data) text.array(name, array);
  text.line("</CellData>\n<Points>");
  text.array("position", {data.columns, data.positions});
  text.line("</Points>");
  const std::string_view cells = data.has_lines ? "Lines" : are_cells ? "Polys" : "Verts";
  text.line(fmt::format("<{}>", cells));
  text.array("connectivity", data.has_lines ? Array{1, data.lines}
                             : are_cells    ? Array{1, data.quads}
                                            : integers(points, 0, 1));
  text.array("offsets", data.has_lines ? integers(lines, 2, 2)
                        : are_cells    ? integers(quads, 4, 4)
                                       : integers(points, 1, 1));
  text.line(fmt::format("</{}>\n</Piece>\n</PolyData>", cells));
  return text.finish();
}

void write_scene(const std::filesystem::path& folder, const std::string& label, const Scene& scene) {
  write_file(folder / fmt::format("particles_{}.vtp", label), encode_vtp(particles_of(scene)),
             Survives::kill);
  write_file(folder / fmt::format("contacts_{}.vtp", label), encode_vtp(contacts_of(scene)), Survives::kill);
  write_file(folder / fmt::format("walls_{}.vtp", label), encode_vtp(walls_of(scene)), Survives::kill);
  if (!scene.surface.empty())
    write_file(folder / fmt::format("surfaces_{}.vtp", label), encode_vtp(surfaces_of(scene)),
               Survives::kill);
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
