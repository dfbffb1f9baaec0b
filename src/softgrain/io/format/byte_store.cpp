#include "softgrain/io/format/byte_store.hpp"

#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>

namespace softgrain {
namespace {

bool copy(std::string_view from, std::size_t begin, std::span<char> to) {
  if (begin > from.size() || to.size() > from.size() - begin) return false;
  std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(begin), to.size(), to.begin());
  return true;
}

}  // namespace

bool MemoryBytes::read(std::size_t begin, std::span<char> bytes) {
  return error() == 0 && copy(bytes_, begin, bytes);
}

void MemoryBytes::write(std::size_t begin, std::string_view bytes) {
  if (begin + bytes.size() > bytes_.size()) resize(begin + bytes.size());
  if (error() == 0)
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
}

void MemoryBytes::resize(std::size_t size) {
  try {
    bytes_.resize(size);
  } catch (const std::bad_alloc&) {
    error_ = ENOMEM;
  }
}

bool ViewedBytes::read(std::size_t begin, std::span<char> bytes) { return copy(bytes_, begin, bytes); }

void ViewedBytes::write(std::size_t, std::string_view) { error_ = EROFS; }

FileBytes::FileBytes(const std::filesystem::path& path) : own_(open_regular_file(path)) {
  descriptor_ = own_.number();
  size_ = file_size(own_, path);
}

bool FileBytes::read(std::size_t begin, std::span<char> bytes) {
  if (error() != 0 || begin > size_ || bytes.size() > size_ - begin) return false;
  while (!bytes.empty()) {
    const ssize_t n = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(begin));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    begin += static_cast<std::size_t>(n);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

void FileBytes::write(std::size_t begin, std::string_view bytes) {
  size_ = std::max(size_, begin + bytes.size());
  while (error() == 0 && !bytes.empty()) {
    const ssize_t n = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(begin));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      error_ = n < 0 ? errno : EIO;
      return;
    }
    begin += static_cast<std::size_t>(n);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void FileBytes::resize(std::size_t size) {
  if (size == size_) return;
  size_ = size;
  if (error() == 0 && ::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) error_ = errno;
}

}  // namespace softgrain
