#include "softgrain/io/format/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "softgrain/core/error.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

/// Call at once after the failure: reads errno.
[[noreturn]] void fail(const fs::path& path, std::string_view what) {
  const int error = errno;
  throw IoError(fmt::format("{}: {}: {}", path.string(), what, std::strerror(error)));
}

/// How many bytes were written before the first failure; all of them when it did not fail. errno tells why.
std::size_t write_all(int descriptor, std::string_view bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  return done;
}

/// The rest of the file, or its first `size` bytes.
std::string read_all(const Descriptor& file, const fs::path& path, std::size_t size) {
  std::string bytes;
  std::array<char, 65536> piece;
  while (bytes.size() < size) {
    const ssize_t n = ::read(file.number(), piece.data(), std::min(piece.size(), size - bytes.size()));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "cannot read");
    if (n == 0) break;
    bytes.append(piece.data(), static_cast<std::size_t>(n));
  }
  return bytes;
}

/// A rename is safe from a power cut only when the directory is on the disk too.
void sync_directory(const fs::path& directory) {
  const Descriptor handle = open_file(directory, O_RDONLY | O_DIRECTORY);
  const bool ok = ::fsync(handle.number()) == 0 || errno == EINVAL;  // EINVAL: this file system has no need
  if (!ok) fail(directory, "cannot fsync directory");
}

}  // namespace

Descriptor::~Descriptor() { close(); }

bool Descriptor::close() {
  const int number = std::exchange(number_, -1);
  return number < 0 || ::close(number) == 0;
}

Descriptor open_file(const fs::path& path, int flags) {
  Descriptor file(::open(path.c_str(), flags | O_CLOEXEC, 0666));
  if (file.number() < 0) fail(path, "cannot open");
  return file;
}

Descriptor open_regular_file(const fs::path& path) {
  Descriptor file = open_file(path, O_RDONLY | O_NONBLOCK);  // a named pipe must not hold us up
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) fail(path, "cannot read");
  if (!S_ISREG(status.st_mode)) throw IoError(fmt::format("{}: not a regular file", path.string()));
  return file;
}

std::size_t file_size(const Descriptor& file, const fs::path& path) {
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) fail(path, "cannot read");
  return static_cast<std::size_t>(status.st_size);
}

std::string read_file(const fs::path& path) {
  return read_all(open_regular_file(path), path, std::numeric_limits<std::size_t>::max());
}

std::string read_beginning(const fs::path& path, std::size_t size) {
  return read_all(open_file(path, O_RDONLY), path, size);
}

PendingFile::PendingFile(fs::path path, Survives survives)
    : path_(std::move(path)),
      temporary_(path_.string() + ".tmp"),
      file_(open_file(temporary_, O_RDWR | O_CREAT | O_TRUNC)),
      survives_(survives) {}

void PendingFile::end_writing(std::size_t size, int error) {
  if (error == 0 && survives_ == Survives::power_cut && ::fsync(file_.number()) != 0) error = errno;
  if (error == 0 && file_.close()) return;
  if (error != 0) errno = error;
  fail(path_, fmt::format("cannot write {} bytes", size));
}

PendingFile::~PendingFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void PendingFile::commit() {
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "cannot rename to it");
  committed_ = true;
  if (survives_ == Survives::power_cut)
    sync_directory(path_.has_parent_path() ? path_.parent_path() : fs::path("."));
}

namespace {

template <class Pieces>
void write_all_of(const fs::path& path, const Pieces& pieces, Survives survives) {
  PendingFile file(path, survives);
  std::size_t size = 0;
  int error = 0;
  for (const std::string_view piece : pieces) {
    size += piece.size();
    if (error == 0 && write_all(file.descriptor(), piece) != piece.size()) error = errno;
  }
  file.end_writing(size, error);
  file.commit();
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes, Survives survives) {
  write_all_of(path, std::initializer_list<std::string_view>{bytes}, survives);
}

void write_pieces(const fs::path& path, std::span<const std::string> pieces, Survives survives) {
  write_all_of(path, pieces, survives);
}

AppendFile::AppendFile(fs::path path)
    : path_(std::move(path)), file_(open_file(path_, O_WRONLY | O_CREAT | O_APPEND)) {}

void AppendFile::append(std::string_view text) {
  const off_t before = ::lseek(file_.number(), 0, SEEK_END);
  if (write_all(file_.number(), text) == text.size()) return;
  const int error = errno;
  if (before >= 0 && ::ftruncate(file_.number(), before) != 0) {
    // A torn last line stays; a resumed run drops it.
  }
  errno = error;
  fail(path_, fmt::format("cannot write {} bytes", text.size()));
}

void AppendFile::sync() {
  if (::fsync(file_.number()) != 0) fail(path_, "cannot fsync");
}

}  // namespace softgrain
