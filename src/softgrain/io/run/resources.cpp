#include "softgrain/io/run/resources.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "softgrain/core/error.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double largest_share = 0.9;  // of what there is

/// MemAvailable of Linux.
double free_memory() {
  std::ifstream info("/proc/meminfo");
  for (std::string name, rest; info >> name; std::getline(info, rest)) {
    double kilobytes = 0;
    if (name == "MemAvailable:" && info >> kilobytes) return 1024 * kilobytes;
  }
  return unlimited;
}

/// The number in the file; infinity when there is no such file or no number, as "max".
double number_in(const fs::path& path) {
  double number = 0;
  return std::ifstream(path) >> number ? number : unlimited;
}

/// What the control group of this process leaves: a container's, a queue's.
double left_by_control_group() {
  std::ifstream groups("/proc/self/cgroup");
  double left = unlimited;
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::/")) continue;  // version 2
    const fs::path group = fs::path("/sys/fs/cgroup") / line.substr(4);
    const double limit = number_in(group / "memory.max");
    if (limit < unlimited) left = std::min(left, limit - number_in(group / "memory.current"));
  }
  return left;
}

double limit_of_process() {
  rlimit limit{};
  const bool limited = ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return limited ? static_cast<double>(limit.rlim_cur) : unlimited;
}

double free_disk(fs::path directory) {
  std::error_code failed;
  directory = fs::absolute(directory, failed);
  while (!fs::exists(directory, failed) && directory.has_relative_path()) directory = directory.parent_path();
  const auto space = fs::space(directory, failed);
  return failed ? unlimited : static_cast<double>(space.available);
}

void require_room(double needed, double available, std::string_view what, std::string_view remedy) {
  require(needed <= largest_share * available,
          "the run needs about {:.0f} MB of {}, and there are {:.0f} MB; {}, or begin it all the same with "
          "--force",
          needed / 1e6, what, available / 1e6, remedy);
}

}  // namespace

Resources available_resources(const fs::path& directory) {
  return {.memory = std::min({free_memory(), left_by_control_group(), limit_of_process()}),
          .disk = free_disk(directory)};
}

void require_resources(const Estimate& needed, const Resources& available) {
  require_room(needed.memory, available.memory, "memory", "choose fewer grains, primaries or cells");
  require_room(needed.disk, available.disk, "disk",
               "choose fewer output.snapshots, output.vtk = false or another disk");
}

}  // namespace softgrain
