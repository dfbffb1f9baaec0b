#include "softgrain/io/page/report_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/math/sym_eigen.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/model/scene_in_cell.hpp"

namespace softgrain {

namespace {

const std::array<std::string, 3> axes{"x", "y", "z"};

const std::vector<double>& reals(const std::map<std::string, Array>& arrays, const char* name) {
  return std::get<std::vector<double>>(arrays.at(name).values);
}
const std::vector<std::int64_t>& integers(const std::map<std::string, Array>& arrays, const char* name) {
  return std::get<std::vector<std::int64_t>>(arrays.at(name).values);
}

std::vector<Vec<3>> vectors(const std::vector<double>& rows) {
  std::vector<Vec<3>> all;
  for (std::size_t i = 0; i + 2 < rows.size(); i += 3) all.push_back({rows[i], rows[i + 1], rows[i + 2]});
  return all;
}

/// Of a symmetric tensor.
double largest_shear(const double* s) {
  Mat<3> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = (s[3 * i + j] + s[3 * j + i]) / 2;
  const Vec<3> value = sym_eigen(m).values;
  return (std::max({value[0], value[1], value[2]}) - std::min({value[0], value[1], value[2]})) / 2;
}

/// One number for each quad.
std::vector<double> field_of(const Array& array) {
  const auto& values = std::get<std::vector<double>>(array.values);
  if (array.columns == 1) return values;
  std::vector<double> shear;
  for (std::size_t i = 0; i + 8 < values.size(); i += 9) shear.push_back(largest_shear(&values[i]));
  return shear;
}

/// What a frame is made of.
struct Surfaces {
  std::vector<Vec<3>> x;            ///< vertices [m]
  std::vector<std::int64_t> grain;  ///< of each vertex
  std::vector<std::array<std::size_t, 4>> quad;
  std::size_t grains = 0;

  explicit Surfaces(const Scene& scene)
      : x(vectors(reals(scene.outlines, "position"))), grain(integers(scene.outlines, "grain")) {
    const auto& corners = integers(scene.surface, "quad");
    for (std::size_t q = 0; q + 3 < corners.size(); q += 4) {
      quad.push_back({});
      for (std::size_t k = 0; k < 4; ++k) {
        quad.back()[k] = static_cast<std::size_t>(corners[q + k]);
        if (quad.back()[k] >= x.size()) throw IoError("the scene's quads have vertices that are not there");
      }
    }
    if (grain.size() != x.size()) throw IoError("the scene's vertices belong to no grains");
    for (const std::int64_t g : grain) {
      if (g < 0 || g > static_cast<std::int64_t>(x.size()))
        throw IoError("the scene's vertices belong to no grains");
      grains = std::max(grains, static_cast<std::size_t>(g) + 1);
    }
  }

  std::size_t grain_of_quad(std::size_t q) const { return static_cast<std::size_t>(grain[quad[q][0]]); }
  /// Twice the mean area, by the diagonals [m^2].
  Vec<3> area(std::size_t q) const {
    return cross(x[quad[q][2]] - x[quad[q][0]], x[quad[q][3]] - x[quad[q][1]]);
  }
};

void add_vectors(ReportFrame& frame, const std::string& owner, const std::vector<Vec<3>>& all) {
  for (int d = 0; d < 3; ++d) {
    FrameColumn& column = frame.columns[owner + axes[static_cast<std::size_t>(d)]];
    for (const Vec<3>& x : all) column.push_back(static_cast<float>(x[d]));
  }
}

/// Mean of the vertices of each grain [m].
std::vector<Vec<3>> centres_of(const Surfaces& s) {
  std::vector<Vec<3>> centre(s.grains);
  std::vector<double> count(s.grains, 0);
  for (std::size_t v = 0; v < s.x.size(); ++v) {
    centre[static_cast<std::size_t>(s.grain[v])] += s.x[v];
    ++count[static_cast<std::size_t>(s.grain[v])];
  }
  for (std::size_t g = 0; g < s.grains; ++g) centre[g] = (1 / std::max(count[g], 1.0)) * centre[g];
  return centre;
}

/// V = 1/3 sum x . n dA, a quad as two triangles.
void add_volumes(ReportFrame& frame, const Surfaces& s, const std::vector<Vec<3>>& centre) {
  std::vector<double> volume(s.grains, 0);
  for (std::size_t q = 0; q < s.quad.size(); ++q) {
    const std::size_t g = s.grain_of_quad(q);
    const auto at = [&](std::size_t k) { return s.x[s.quad[q][k]] - centre[g]; };
    volume[g] += (dot(at(0), cross(at(1), at(2))) + dot(at(0), cross(at(2), at(3)))) / 6;
  }
  frame.columns["grain.volume"] = FrameColumn(volume.begin(), volume.end());
}

void add_field(ReportFrame& frame, const Surfaces& s, const std::string& name,
               const std::vector<double>& values) {
  if (values.size() != s.quad.size()) return;
  std::vector<double> sum(s.x.size(), 0), count = sum, mean(s.grains, 0), area = mean;
  for (std::size_t q = 0; q < s.quad.size(); ++q) {
    const std::size_t g = s.grain_of_quad(q);
    const double a = norm(s.area(q));
    area[g] += a, mean[g] += a * values[q];
    for (const std::size_t v : s.quad[q]) sum[v] += values[q], ++count[v];
  }
  FrameColumn &of_vertex = frame.columns["vertex." + name], &of_grain = frame.columns["grain." + name];
  for (std::size_t v = 0; v < sum.size(); ++v)
    of_vertex.push_back(static_cast<float>(sum[v] / std::max(count[v], 1.0)));
  for (std::size_t g = 0; g < s.grains; ++g)
    of_grain.push_back(static_cast<float>(mean[g] / std::max(area[g], 1e-300)));
}

void add_contacts(ReportFrame& frame, const Scene& scene, const std::vector<Vec<3>>& centre,
                  std::size_t walls) {
  frame.contacts_of_grains = true;
  auto& columns = frame.columns;
  FrameColumn &a = columns["contact.a"], &b = columns["contact.b"], &f = columns["contact.force"];
  if (!scene.contacts.contains("pair") || !scene.contacts.contains("force")) return;
  const PeriodicCell<3> cell = cell_of<3>(scene);
  const auto& pair = integers(scene.contacts, "pair");
  const auto& force = reals(scene.contacts, "force");
  for (std::size_t c = 0; c < std::min(pair.size() / 2, force.size()); ++c) {
    const auto first = static_cast<std::size_t>(pair[2 * c]),
               second = static_cast<std::size_t>(pair[2 * c + 1]);
    if (first >= centre.size() || second >= centre.size() + walls || !(force[c] > 0)) continue;
    const bool between = second < centre.size();
    if (between && cell.nearest(centre[second] - centre[first]) != PeriodicCell<3>::Image{}) continue;
    a.push_back(static_cast<float>(first));
    b.push_back(static_cast<float>(second));
    f.push_back(static_cast<float>(force[c]));
  }
}

/// The grains' A: nine columns.
std::string entry(int i, int j) { return fmt::format("grain.a{}{}", i, j); }

/// Places of the vertices from the means of their grains.
std::vector<Vec<3>> places_about_means(const ReportFrame& frame) {
  const auto& columns = frame.columns;
  const FrameColumn& grain = columns.at("vertex.grain");
  std::vector<Vec<3>> x(grain.size());
  for (int d = 0; d < 3; ++d) {
    const std::string& axis = axes[static_cast<std::size_t>(d)];
    const FrameColumn &of_vertex = columns.at("vertex." + axis), &of_grain = columns.at("grain." + axis);
    for (std::size_t v = 0; v < grain.size(); ++v)
      x[v][d] = double{of_vertex[v]} - double{of_grain[static_cast<std::size_t>(grain[v])]};
  }
  return x;
}

/// A of each grain.
std::vector<Mat<3>> motions(const FrameColumn& grain, std::size_t grains, const std::vector<Vec<3>>& X,
                            const std::vector<Vec<3>>& x) {
  std::vector<Mat<3>> xX(grains), XX(grains), A;
  for (std::size_t v = 0; v < X.size(); ++v) {
    const auto g = static_cast<std::size_t>(grain[v]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        xX[g](i, j) += x[v][i] * X[v][j];
        XX[g](i, j) += X[v][i] * X[v][j];
      }
  }
  for (std::size_t g = 0; g < grains; ++g)
    A.push_back(determinant(XX[g]) > 0 ? xX[g] * inverse(XX[g]) : Mat<3>{});
  return A;
}

}  // namespace

ReportFrame frame_of_surfaces(const Scene& scene) {
  const Surfaces s(scene);
  ReportFrame frame;
  const std::vector<Vec<3>> centre = centres_of(s);
  add_vectors(frame, "vertex.", s.x);
  add_vectors(frame, "grain.", centre);
  frame.columns["vertex.grain"] = FrameColumn(s.grain.begin(), s.grain.end());
  for (std::size_t k = 0; k < 4; ++k)
    for (const auto& quad : s.quad)
      frame.columns[fmt::format("quad.{}", k)].push_back(static_cast<float>(quad[k]));
  add_volumes(frame, s, centre);
  for (const char* name : {"pressure", "J", "stress"})
    if (const auto found = scene.surface.find(name); found != scene.surface.end())
      add_field(frame, s, name, field_of(found->second));
  if (const auto kind = scene.particles.find("kind"); kind != scene.particles.end()) {
    const auto& kinds = std::get<std::vector<std::int64_t>>(kind->second.values);
    const auto& grain = std::get<std::vector<std::int64_t>>(scene.particles.at("grain").values);
    FrameColumn of_grain(centre.size());  // bonded grains have it by primary
    for (std::size_t i = 0; i < kinds.size(); ++i)
      of_grain[static_cast<std::size_t>(grain[i])] = static_cast<float>(kinds[i]);
    frame.columns["grain.kind"] = std::move(of_grain);
  }
  const auto walls = scene.surface.find("walls");
  const auto corners = walls == scene.surface.end() ? std::vector<double>{}
                                                    : std::get<std::vector<double>>(walls->second.values);
  for (std::size_t i = 0; i < corners.size(); ++i)
    frame.columns[fmt::format("wall.{}", i % 12)].push_back(static_cast<float>(corners[i]));
  add_contacts(frame, scene, centre, corners.size() / 12);
  return frame;
}

void part_off_motion(std::vector<ReportFrame>& frames) {
  if (frames.empty() || !frames.front().columns.contains("vertex.x")) return;
  const std::vector<Vec<3>> X = places_about_means(frames.front());
  const FrameColumn grain = frames.front().columns.at("vertex.grain");
  const std::size_t grains = frames.front().columns.at("grain.x").size();
  for (ReportFrame& frame : frames) {
    if (frame.columns.at("vertex.grain").size() != grain.size())
      throw IoError("grains' vertices change their number");
    std::vector<Vec<3>> x = places_about_means(frame);
    const std::vector<Mat<3>> A = motions(grain, grains, X, x);
    for (std::size_t v = 0; v < x.size(); ++v) x[v] -= A[static_cast<std::size_t>(grain[v])] * X[v];
    for (const std::string& axis : axes) frame.columns["vertex." + axis].clear();
    add_vectors(frame, "vertex.", x);
    add_vectors(frame, "rest.", X);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (const Mat<3>& a : A) frame.columns[entry(i, j)].push_back(static_cast<float>(a(i, j)));
  }
}

void keep_pressure_alone(std::vector<ReportFrame>& frames) {
  for (ReportFrame& frame : frames)
    for (const char* name : {"vertex.J", "vertex.stress"}) frame.columns.erase(name);
}

}  // namespace softgrain
