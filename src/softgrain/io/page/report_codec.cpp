#include "softgrain/io/page/report_codec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace softgrain {

namespace {

std::uint32_t zigzag(std::uint32_t difference, int bytes) {
  const int unused = 32 - 8 * bytes;
  const auto d = static_cast<std::int32_t>(difference << unused) >> unused;  // its sign
  const std::uint32_t folded = (static_cast<std::uint32_t>(d) << 1) ^ static_cast<std::uint32_t>(d >> 31);
  return folded << unused >> unused;
}

}  // namespace

EncodedArray encode_reals(std::span<const float> values, std::size_t stride, double step) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  if (!(low <= high)) low = high = 0;
  step = std::max(step, (high - low) / 65535);
  std::vector<std::uint32_t> q(values.size(), 0);
  for (std::size_t i = 0; i < q.size() && step > 0; ++i)
    if (std::isfinite(values[i])) q[i] = static_cast<std::uint32_t>(std::lround((values[i] - low) / step));
  const int bytes = high - low < 255.5 * step ? 1 : 2;
  return {low, step, bytes, q.size(), encode_whole(q, stride, bytes)};
}

EncodedArray encode_indices(std::span<const float> values, std::size_t stride) {
  const std::vector<std::uint32_t> q(values.begin(), values.end());
  const std::uint32_t largest = q.empty() ? 0 : *std::max_element(q.begin(), q.end());
  const int bytes = largest < 256 ? 1 : largest < 65536 ? 2 : 4;
  return {0, 1, bytes, q.size(), encode_whole(q, stride, bytes)};
}

std::string encode_whole(std::span<const std::uint32_t> q, std::size_t stride, int bytes) {
  std::string planes(q.size() * static_cast<std::size_t>(bytes), '\0');
  for (std::size_t i = 0; i < q.size(); ++i) {
    const std::uint32_t code = zigzag(q[i] - (i < stride ? 0 : q[i - stride]), bytes);
    for (int plane = 0; plane < bytes; ++plane)
      planes[static_cast<std::size_t>(plane) * q.size() + i] = static_cast<char>(code >> 8 * plane);
  }
  return planes;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= there ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace softgrain
