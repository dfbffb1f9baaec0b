#pragma once
#include <string>
#include <string_view>

namespace softgrain {

/// Container format of the DEFLATE stream: RFC 1950, RFC 1952.
enum class Container { zlib, gzip };

/// Deflated bytes; `level` from 1, the fastest, to 12, the smallest. Throws nothing but std::bad_alloc, so
/// threads may call it.
std::string compressed(std::string_view bytes, Container container, int level);

}  // namespace softgrain
