#pragma once
#include <doctest/doctest.h>
#include <sys/mount.h>

#include <filesystem>
#include <string>

namespace softgrain::test {

/// A disk of a few kB, where mounting is allowed.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& at, const std::string& size) : at_(at) {
    std::filesystem::create_directories(at);
    mounted_ = ::mount("none", at.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    if (mounted_) ::umount(at_.c_str());
  }
  bool mounted() const { return mounted_; }
  void enlarge(const std::string& size) const {
    REQUIRE(::mount("none", at_.c_str(), "tmpfs", MS_REMOUNT, ("size=" + size).c_str()) == 0);
  }

 private:
  std::filesystem::path at_;
  bool mounted_ = false;
};

}  // namespace softgrain::test
