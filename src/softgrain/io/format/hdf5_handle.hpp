#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "softgrain/core/error.hpp"

// What the files that call the HDF5 library share; hid_t and herr_t by their own types.

namespace softgrain {

/// Owns one HDF5 identifier.
class Handle {
 public:
  Handle(std::int64_t id, int (*close_id)(std::int64_t)) : id_(id), close_(close_id) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }
  operator std::int64_t() const { return id_; }  // NOLINT: as the library takes it
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// Raises IoError when the library reports a failure: `status` < 0.
template <class Status>
Status checked(Status status, const std::string& file, std::string_view what) {
  if (status < 0) throw IoError(fmt::format("{}: {}", file, what));
  return status;
}

/// The library's identifier of the type of an Array's numbers.
std::int64_t type_in_memory(bool integers);

}  // namespace softgrain
