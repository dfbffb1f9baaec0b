#include "softgrain/io/format/vtp_text.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>

#include "softgrain/core/parallel.hpp"
#include "softgrain/io/format/compress.hpp"

namespace softgrain {
namespace {

constexpr int fastest_compression = 1;
constexpr std::size_t block_size = 1 << 20;

float as_float(double value) {
  const auto narrow = static_cast<float>(value);
  return std::fabs(narrow) < FLT_MIN ? 0.0F : narrow;
}

template <class T>
void append_bytes(std::string& raw, std::span<const T> values) {
  raw.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

/// VTK's compressed array, of rows that come one after the other: number of blocks, size of a block, of a
/// last partial one, of each when compressed; then the blocks.
class CompressedBlocks {
 public:
  void add(const Array& rows) {
    if (const auto* reals = std::get_if<std::vector<double>>(&rows.values)) {
      std::vector<float> floats;
      floats.reserve(reals->size() / rows.columns * (rows.columns == 2 ? 3 : rows.columns));
      for (std::size_t k = 0; k < reals->size(); ++k) {
        floats.push_back(as_float((*reals)[k]));
        if (rows.columns == 2 && k % 2 == 1) floats.push_back(0);
      }
      append_bytes(raw_, std::span<const float>(floats));
    } else {
      append_bytes(raw_, std::span<const std::int64_t>(std::get<std::vector<std::int64_t>>(rows.values)));
    }
    if (raw_.size() >= blocks_at_once * block_size) compress(raw_.size() / block_size);
  }
  std::string finish() {
    const std::size_t last = raw_.size() % block_size;
    compress(raw_.size() / block_size + (last > 0 ? 1 : 0));
    std::vector<std::uint64_t> sizes{size_.size(), block_size, last};
    sizes.insert(sizes.end(), size_.begin(), size_.end());
    std::string head;
    append_bytes(head, std::span<const std::uint64_t>(sizes));
    blocks_.insert(0, head);
    return std::move(blocks_);
  }

 private:
  static constexpr std::size_t blocks_at_once = 8;  // among threads

  void compress(std::size_t count) {
    std::vector<std::string> block(count);
    parallel_for(static_cast<int>(count), [&](int k) {
      block[k] = compressed(std::string_view(raw_).substr(k * block_size, block_size), Container::zlib,
                            fastest_compression);
    });
    for (const std::string& packed : block) {
      size_.push_back(packed.size());
      blocks_ += packed;
    }
    raw_.erase(0, count * block_size);
  }

  std::string raw_, blocks_;
  std::vector<std::uint64_t> size_;
};

}  // namespace

void VtpText::array(const std::string& name, const ArrayShape& shape,
                    const std::function<Array(std::size_t first, std::size_t count)>& rows) {
  CompressedBlocks blocks;
  for (std::size_t first = 0; first < shape.rows; first += rows_at_once)
    blocks.add(rows(first, std::min(rows_at_once, shape.rows - first)));
  line(
      fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)",
                  shape.integers ? "Int64" : "Float32", name,
                  shape.columns == 2 && !shape.integers ? 3 : shape.columns, offset_));
  arrays_.push_back(blocks.finish());
  offset_ += arrays_.back().size();
}

std::vector<std::string> VtpText::finish() {
  arrays_.insert(arrays_.begin(), xml_ + "<AppendedData encoding=\"raw\">\n_");
  arrays_.emplace_back("\n</AppendedData>\n</VTKFile>\n");
  return std::move(arrays_);
}

}  // namespace softgrain
