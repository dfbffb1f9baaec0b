#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softgrain {

/// Numbers as the page reads them: value = low + step q, with whole q from 0, each in `bytes` bytes.
struct EncodedArray {
  double low = 0;
  double step = 0;
  int bytes = 2;          ///< 1, 2 or 4
  std::size_t count = 0;  ///< of numbers
  std::string planes;     ///< count * bytes bytes, see encode_whole
};

/// Reals to the nearest multiple of `step` above the smallest, or of what 16 bits reach if that is coarser.
/// What is not finite becomes the smallest. Each value should differ little from the one `stride` places
/// before it.
EncodedArray encode_reals(std::span<const float> values, std::size_t stride, double step);

/// Whole numbers from 0 that come as floats, exactly (below 2^24).
EncodedArray encode_indices(std::span<const float> values, std::size_t stride);

/// The bytes of q, so that gzip finds them short: d_i = q_i - q_(i - stride) modulo 2^(8 bytes), as zigzag
/// (0, -1, 1, -2, ... become 0, 1, 2, 3, ...), then the lowest byte of all, the next byte of all, and so on.
std::string encode_whole(std::span<const std::uint32_t> q, std::size_t stride, int bytes);

/// RFC 4648, with padding, in one line.
std::string base64(std::string_view bytes);

}  // namespace softgrain
