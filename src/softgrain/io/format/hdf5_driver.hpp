#pragma once
#include <cstdint>

#include "softgrain/io/format/byte_store.hpp"

namespace softgrain {

/// Tells the HDF5 library to find a file in these bytes: `access` is its identifier of a list of properties
/// of file access, a file that is opened with it keeps a reference to the bytes. Of writes that fail the
/// library does not hear: the store remembers them. Negative where the library fails.
int use_store(std::int64_t access, ByteStore& store);

}  // namespace softgrain
