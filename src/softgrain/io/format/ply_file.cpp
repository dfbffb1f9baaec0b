#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/io/format/mesh_builder.hpp"

namespace softgrain {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
  std::string_view name, other;
  Type type;
  std::size_t size;
};
constexpr std::array types{
    TypeName{"char", "int8", Type::int8, 1},        TypeName{"uchar", "uint8", Type::uint8, 1},
    TypeName{"short", "int16", Type::int16, 2},     TypeName{"ushort", "uint16", Type::uint16, 2},
    TypeName{"int", "int32", Type::int32, 4},       TypeName{"uint", "uint32", Type::uint32, 4},
    TypeName{"float", "float32", Type::float32, 4}, TypeName{"double", "float64", Type::float64, 8}};

const TypeName* type_named(const std::string& name, const std::string& place) {
  const auto found = std::find_if(types.begin(), types.end(),
                                  [&](const TypeName& t) { return t.name == name || t.other == name; });
  require(found != types.end(), "{}: '{}' is no type of a PLY file", place, name.substr(0, 20));
  return &*found;
}

struct Property {
  std::string name;
  const TypeName* count = nullptr;  // of a list
  const TypeName* type = nullptr;
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  enum class Format { text, little, big } format = Format::text;
  std::vector<Element> elements;
  std::size_t end = 0;  // of its bytes
  int lines = 0;
};

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : lines_(bytes) {}

  Header read() {
    bool has_format = false;
    while (lines_.next()) {
      const std::vector<std::string> words = lines_.words();
      if (words[0] == "end_header") {
        require(has_format, "{}: the header names no format", lines_.place());
        header_.end = lines_.at();
        return header_;
      }
      if (words[0] == "format") read_format(words), has_format = true;
      if (words[0] == "element") read_element(words);
      if (words[0] == "property") read_property(words);
    }
    throw UsageError(fmt::format("{}: the header has no 'end_header': the file is cut off; copy it again",
                                 lines_.place()));
  }

 private:
  void need(bool ok, std::string_view form) const {
    require(ok, "{}: the line must read '{}'", lines_.place(), form);
  }
  void read_format(const std::vector<std::string>& words) {
    need(words.size() >= 2, "format ascii 1.0");
    using enum Header::Format;
    const bool known =
        words[1] == "ascii" || words[1] == "binary_little_endian" || words[1] == "binary_big_endian";
    require(known, "{}: format '{}' is none of ascii, binary_little_endian, binary_big_endian",
            lines_.place(), words[1].substr(0, 30));
    header_.format = words[1] == "ascii" ? text : words[1] == "binary_little_endian" ? little : big;
  }
  void read_element(const std::vector<std::string>& words) {
    need(words.size() == 3, "element vertex 8");
    const double count = number_of(words[2], lines_.place());
    constexpr double most = 1e8;
    require(count >= 0 && count <= most && count == std::floor(count), "{}: '{}' is no number of elements",
            lines_.place(), words[2].substr(0, 20));
    header_.elements.push_back({words[1], static_cast<std::size_t>(count), {}});
  }
  void read_property(const std::vector<std::string>& words) {
    require(!header_.elements.empty(), "{}: a property stands behind its element", lines_.place());
    auto& properties = header_.elements.back().properties;
    if (words.size() == 5 && words[1] == "list") {
      const TypeName* count = type_named(words[2], lines_.place());
      require(count->type != Type::float32 && count->type != Type::float64,
              "{}: a list's length is a whole number", lines_.place());
      properties.push_back({words[4], count, type_named(words[3], lines_.place())});
    } else {
      need(words.size() == 3, "property float x");
      properties.push_back({words[2], nullptr, type_named(words[1], lines_.place())});
    }
  }

  LineReader lines_;
  Header header_;
};

/// The numbers behind the header, one after the other.
class Numbers {
 public:
  Numbers(std::string_view bytes, const Header& header)
      : bytes_(bytes), at_(header.end), format_(header.format), lines_(bytes) {
    if (format_ == Header::Format::text)
      while (lines_.at() < header.end && lines_.next()) {
      }
  }
  /// Before the numbers of an element: in text it is a line of its own.
  void begin_element() {
    if (format_ != Header::Format::text) return;
    require(lines_.next(),
            "{}: the file ends before all elements of its header: it is cut off; copy it again",
            lines_.place());
    words_ = lines_.words();
    word_ = 0;
  }
  std::string place() const {
    return format_ == Header::Format::text ? lines_.place() : fmt::format("byte {}", at_);
  }
  double next(const TypeName& type) {
    if (format_ == Header::Format::text) {
      require(word_ < words_.size(), "{}: the line has fewer numbers than the header's properties", place());
      return number_of(words_[word_++], place());
    }
    require(bytes_.size() - at_ >= type.size, "byte {}: the file ends there: it is cut off; copy it again",
            at_);
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < type.size; ++k) {
      const std::size_t from = format_ == Header::Format::little ? k : type.size - 1 - k;
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[at_ + from])) << (8 * k);
    }
    at_ += type.size;
    return value_of(bits, type.type);
  }

 private:
  static double value_of(std::uint64_t bits, Type type) {
    switch (type) {
      case Type::int8:
        return static_cast<std::int8_t>(bits);
      case Type::int16:
        return static_cast<std::int16_t>(bits);
      case Type::int32:
        return static_cast<std::int32_t>(bits);
      case Type::float32:
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      case Type::float64:
        return std::bit_cast<double>(bits);
      default:
        return static_cast<double>(bits);
    }
  }

  std::string_view bytes_;
  std::size_t at_;
  Header::Format format_;
  LineReader lines_;
  std::vector<std::string> words_;
  std::size_t word_ = 0;
};

/// Vertices first, as all programs write them, then faces; other elements are read past.
class ElementReader {
 public:
  ElementReader(std::string_view bytes, const Header& header) : header_(header), numbers_(bytes, header) {}

  MeshText read() {
    for (const Element& element : header_.elements)
      for (std::size_t k = 0; k < element.count; ++k) read_one(element);
    return mesh_.take();
  }

 private:
  void read_one(const Element& element) {
    constexpr double longest_list = 1000;
    numbers_.begin_element();
    const std::string place = numbers_.place();
    Vec<3> x;
    std::vector<int> corners;
    for (const Property& property : element.properties) {
      const bool is_corners =
          element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
      const double count = property.count ? numbers_.next(*property.count) : 1;
      require(count >= 0 && count <= longest_list && count == std::floor(count),
              "{}: a list of {} numbers: the file is damaged; write it again", place, count);
      for (int k = 0; k < count; ++k) {
        const double number = numbers_.next(*property.type);
        if (is_corners) corners.push_back(corner(number, place));
        for (int axis = 0; axis < 3; ++axis)
          if (property.name == std::string(1, "xyz"[axis])) x[axis] = number;
      }
    }
    if (element.name == "vertex") vertices_.push_back(mesh_.vertex(x, place));
    if (element.name != "face") return;
    require(corners.size() >= 3, "{}: a face has {} corners instead of 3 or more", place, corners.size());
    mesh_.polygon(corners, place);
  }
  int corner(double number, const std::string& place) const {
    require(number >= 0 && number < static_cast<double>(vertices_.size()) && number == std::floor(number),
            "{}: a face names vertex {}, but there are {}, from 0 on", place, number, vertices_.size());
    return vertices_[static_cast<std::size_t>(number)];
  }

  const Header& header_;
  Numbers numbers_;
  MeshBuilder mesh_;
  std::vector<int> vertices_;  // their numbers in the mesh
};

void check_elements(const Header& header) {
  const auto has = [&](std::string_view element, const std::vector<std::string_view>& names) {
    return std::any_of(header.elements.begin(), header.elements.end(), [&](const Element& e) {
      return e.name == element && std::any_of(names.begin(), names.end(), [&](std::string_view name) {
               return std::any_of(e.properties.begin(), e.properties.end(),
                                  [&](const Property& property) { return property.name == name; });
             });
    });
  };
  for (const std::string_view axis : {"x", "y", "z"})
    require(has("vertex", {axis}), "the header names no property {} of the element vertex", axis);
  require(has("face", {"vertex_indices", "vertex_index"}),
          "the header names no list vertex_indices of the element face: a cloud of points is no surface");
}

}  // namespace

MeshText read_ply(std::string_view bytes) {
  const Header header = HeaderReader(bytes).read();
  check_elements(header);
  return ElementReader(bytes, header).read();
}

}  // namespace softgrain
