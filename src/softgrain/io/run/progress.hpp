#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/observe/columns.hpp"

namespace softgrain {

enum class ProgressStyle { automatic, tty, plain, none };

/// How far a run is, on stderr. On a terminal one line, rewritten a few times a second; elsewhere a line
/// every 10 % or 30 s. A stderr that cannot be written to is no error.
class Progress {
 public:
  explicit Progress(ProgressStyle style);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` of the run that is done, in [0, 1]; `row` is what was last observed.
  void update(double fraction, const std::vector<Quantity>& row);
  /// A line of its own, above the rewritten one. Not silenced by ProgressStyle::none.
  void message(std::string_view text);

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_left(double fraction) const;
  void erase_line();

  ProgressStyle style_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point shown_{};
  double first_fraction_ = -1;  ///< where this process began: a resumed run begins in the middle
  int tenths_shown_ = -1;
  bool line_on_screen_ = false;
};

/// " 43 %  strain 0.123  stress_top 83.1 kPa  sweeps 23  ETA 1 h 02 min"; of the row, what tells most about
/// any run.
std::string progress_text(double fraction, const std::vector<Quantity>& row, double seconds_left);

/// "0.123", "83.1 kPa": three digits, and a prefix where there is a unit.
std::string short_value(const Quantity& quantity);

/// "1 h 02 min", "3 min 20 s", "5 s"; "-" when it is unknown.
std::string duration_text(double seconds);

/// "30 012".
std::string grouped(std::int64_t number);

}  // namespace softgrain
