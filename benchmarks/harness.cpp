#include "harness.hpp"

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <string_view>

#include "softgrain/core/parallel.hpp"
#include "softgrain/core/version.hpp"

namespace softgrain::bench {
namespace {

constexpr int fewest_rounds = 5;
constexpr double still_falling = 0.99, longest = 20;  // of the minimum; [s]

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string today() {
  const time_t now = time(nullptr);
  tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 16> text{};
  strftime(text.data(), text.size(), "%Y-%m-%d", &utc);
  return text.data();
}

}  // namespace

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

std::function<void()> repeated(int times, std::function<void()> part) {
  return [times, part = std::move(part)] {
    for (int k = 0; k < times; ++k) part();
  };
}

std::vector<double> fastest(std::initializer_list<std::function<void()>> work) {
  std::vector<double> best(work.size(), std::numeric_limits<double>::infinity());
  const double start = cpu_seconds();
  int rounds = 0, quiet_rounds = 0;
  while (rounds < fewest_rounds || (quiet_rounds < fewest_rounds && cpu_seconds() - start < longest)) {
    bool fell = false;
    std::size_t k = 0;
    for (const auto& piece : work) {
      const double seconds = seconds_of(piece);
      fell = fell || seconds < still_falling * best[k];
      best[k] = std::min(best[k], seconds);
      ++k;
    }
    ++rounds;
    quiet_rounds = fell ? 0 : quiet_rounds + 1;
  }
  return best;
}

Results::Results(std::string benchmark, int argc, char** argv) : benchmark_(std::move(benchmark)) {
  if (argc == 3 && std::string_view(argv[1]) == "--csv") file_ = argv[2];
  set_threads(1);  // cpu_seconds() sees the calling thread only
}

void Results::heading(const std::string& text) const { fmt::print("\n{}: {}\n", benchmark_, text); }

void Results::add(const Measurement& m) {
  rows_.push_back(m);
  fmt::print("  {:<58} {:>10.4g} {:<14}", m.what, m.value, m.unit);
  if (m.ratio > 0) fmt::print(" {:>6.3g} x {}", m.ratio, m.reference);
  fmt::print("\n");
  std::fflush(stdout);
}

Results::~Results() {
  if (file_.empty()) return;
  std::ofstream csv(file_);
  csv << "commit,date,processor,flags,benchmark,what,value,unit,ratio,reference\n";
  const BuildInfo build = build_info();
  for (const Measurement& m : rows_)
    csv << fmt::format("{},{},{},{},{},\"{}\",{:.4g},{},{},{}\n", build.commit, today(), processor(),
                       build.flags, benchmark_, m.what, m.value, m.unit,
                       m.ratio > 0 ? fmt::format("{:.3g}", m.ratio) : "", m.reference);
}

}  // namespace softgrain::bench
