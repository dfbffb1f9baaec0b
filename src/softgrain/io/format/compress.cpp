#include "softgrain/io/format/compress.hpp"

#include <libdeflate.h>

#include <memory>
#include <new>

namespace softgrain {

std::string compressed(std::string_view bytes, Container container, int level) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(level), &libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  const bool gzip = container == Container::gzip;
  const auto bound = gzip ? libdeflate_gzip_compress_bound : libdeflate_zlib_compress_bound;
  const auto compress = gzip ? libdeflate_gzip_compress : libdeflate_zlib_compress;
  std::string packed(bound(compressor.get(), bytes.size()), '\0');
  packed.resize(compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed;
}

}  // namespace softgrain
