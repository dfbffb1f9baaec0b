#pragma once
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace softgrain::bench {

/// CPU time of the calling thread [s]: other processes on the machine do not count.
double cpu_seconds();

/// CPU time of one call of `work` [s].
double seconds_of(const std::function<void()>& work);

/// A piece of work that does `part` so many times.
std::function<void()> repeated(int times, std::function<void()> part);

/// Smallest CPU time [s] of each piece of work. A round runs every piece once, so that a slow moment of the
/// machine meets all of them. Rounds go on, 5 at least, until in five of them no minimum has fallen by more
/// than 1 %, or 20 s of CPU time are spent.
std::vector<double> fastest(std::initializer_list<std::function<void()>> work);

/// One measured number.
struct Measurement {
  std::string what;
  double value = 0;
  std::string unit;
  double ratio = 0;  ///< value over that of the reference, measured in the same run; 0: there is none
  std::string reference = {};  ///< what the ratio compares with
};

/// Prints each measurement; with `--csv FILE` on the command line also writes them there, with commit, date
/// and processor.
class Results {
 public:
  Results(std::string benchmark, int argc, char** argv);
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  void heading(const std::string& text) const;
  void add(const Measurement& measurement);

 private:
  std::string benchmark_, file_;
  std::vector<Measurement> rows_;
};

}  // namespace softgrain::bench
