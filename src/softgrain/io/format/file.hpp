#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace softgrain {

/// Owns a file descriptor of the operating system; -1 is none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();

  int number() const { return number_; }
  /// False when the system reports a late failure to write.
  bool close();

 private:
  int number_;
};

/// open(2) with O_CLOEXEC and mode 0666. Raises IoError.
Descriptor open_file(const std::filesystem::path& path, int flags);

/// For reading. It must be a regular one: never waits for a pipe or reads a device. Raises IoError.
Descriptor open_regular_file(const std::filesystem::path& path);
/// [bytes]. Raises IoError.
std::size_t file_size(const Descriptor& file, const std::filesystem::path& path);

/// The whole file, which must be a regular one. Raises IoError.
std::string read_file(const std::filesystem::path& path);

/// The first `size` bytes of anything that can be read, or all when there are fewer. Raises IoError.
std::string read_beginning(const std::filesystem::path& path, std::size_t size);

/// What a finished file survives. A power cut costs two waits for the disk.
enum class Survives { kill, power_cut };

/// A file that appears under its name complete or not at all: the bytes go to `path`.tmp first, `commit`
/// renames. Without `commit` nothing is left. Raises IoError naming the path and the bytes needed.
class PendingFile {
 public:
  /// An empty one, for whoever fills it and then calls end_writing.
  explicit PendingFile(std::filesystem::path path, Survives survives = Survives::power_cut);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  /// For reading and writing.
  int descriptor() const { return file_.number(); }
  /// Of so many bytes; `error` is the errno of a write that failed, or 0.
  void end_writing(std::size_t size, int error);
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  Descriptor file_;
  Survives survives_;
  bool committed_ = false;
};

/// Replaces the file's contents in one piece.
void write_file(const std::filesystem::path& path, std::string_view bytes,
                Survives survives = Survives::power_cut);

/// The same with pieces one behind the other.
void write_pieces(const std::filesystem::path& path, std::span<const std::string> pieces,
                  Survives survives = Survives::power_cut);

/// A file that only grows, each piece by one write(): series.csv, log.txt. A piece that does not fit on the
/// disk is taken back. Raises IoError naming the path and the bytes needed.
class AppendFile {
 public:
  explicit AppendFile(std::filesystem::path path);

  void append(std::string_view text);
  /// Waits until all is on the disk.
  void sync();

 private:
  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace softgrain
