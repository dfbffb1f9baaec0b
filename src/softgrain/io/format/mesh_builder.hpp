#pragma once
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/io/format/mesh_file.hpp"

namespace softgrain {

/// Puts a mesh together out of what a file says.
class MeshBuilder {
 public:
  /// The number of the vertex at x, the same for the same place. Raises UsageError if x is not finite.
  int vertex(const Vec<3>& x, const std::string& place) {
    for (int k = 0; k < 3; ++k)
      require(std::isfinite(x[k]), "{}: a coordinate is not a finite number; write the file again", place);
    const Vec<3> same = x + Vec<3>{};  // -0 is 0
    const auto [at, is_new] = number_.emplace(same.c, static_cast<int>(text_.mesh.vertex.size()));
    if (is_new) text_.mesh.vertex.push_back(same);
    return at->second;
  }
  /// A convex polygon. Raises UsageError for too many triangles.
  void polygon(std::span<const int> corners, const std::string& place) {
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const std::array<int, 3> t{corners[0], corners[k - 1], corners[k]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      require(text_.mesh.triangle.size() < most_triangles,
              "{}: not yet: more than {} triangles in a surface; reduce the mesh, a grain has a few hundred "
              "vertices",
              place, most_triangles);
      text_.mesh.triangle.push_back(t);
      text_.place.push_back(place);
    }
  }
  MeshText take() { return std::move(text_); }

 private:
  MeshText text_;
  std::map<std::array<double, 3>, int> number_;
};

/// Raises UsageError as read_mesh.
MeshText read_ply(std::string_view bytes);

/// Lines of text, without blanks round them.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// The next line that is not empty, or false.
  bool next() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      line_ = text_.substr(at_, end - at_);
      at_ = std::min(end + 1, text_.size());
      ++number_;
      while (!line_.empty() && is_blank(line_.back())) line_.remove_suffix(1);
      while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
      if (!line_.empty()) return true;
    }
    return false;
  }
  std::string_view line() const { return line_; }
  std::size_t at() const { return at_; }  ///< of the byte behind the line
  std::string place() const { return fmt::format("line {}", number_); }
  std::vector<std::string> words() const {
    std::vector<std::string> words;
    for (std::size_t k = 0; k < line_.size();) {
      std::size_t end = k;
      while (end < line_.size() && !is_blank(line_[end])) ++end;
      if (end > k) words.emplace_back(line_.substr(k, end - k));
      k = end + 1;
    }
    return words;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  std::string_view text_, line_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// Raises UsageError if a word is no number.
double number_of(const std::string& word, const std::string& place);

}  // namespace softgrain
