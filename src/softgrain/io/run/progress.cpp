#include "softgrain/io/run/progress.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace softgrain {

namespace {

constexpr int bar_width = 24;
constexpr auto rewrite_after = std::chrono::milliseconds(200);
constexpr auto repeat_after = std::chrono::seconds(30);

void write_to_stderr(std::string_view text) {
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) {
    // Nobody looks.
  }
}

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar(double fraction) {
  std::string text(bar_width, ' ');
  const auto filled = static_cast<std::size_t>(fraction * bar_width);
  for (std::size_t k = 0; k < filled; ++k) text[k] = '=';
  if (filled < text.size()) text[filled] = '>';
  return "[" + text + "]";
}

}  // namespace

std::string grouped(std::int64_t number) {
  std::string text = std::to_string(number);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > (number < 0 ? 1 : 0); at -= 3)
    text.insert(static_cast<std::size_t>(at), " ");
  return text;
}

std::string duration_text(double seconds) {
  if (!(seconds >= 0) || seconds > 1e9) return "-";
  const auto total = static_cast<std::int64_t>(std::llround(seconds));
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{} min {:02} s", total / 60, total % 60);
  return fmt::format("{} h {:02} min", total / 3600, total % 3600 / 60);
}

std::string short_value(const Quantity& quantity) {
  struct Prefix {
    double factor;
    std::string_view letter;
  };
  constexpr std::array prefixes{Prefix{1e9, "G"},  Prefix{1e6, "M"},  Prefix{1e3, "k"}, Prefix{1, ""},
                                Prefix{1e-3, "m"}, Prefix{1e-6, "u"}, Prefix{1e-9, "n"}};
  if (quantity.unit.empty() || quantity.value == 0 || !std::isfinite(quantity.value))
    return fmt::format("{:.3g}{}{}", quantity.value, quantity.unit.empty() ? "" : " ", quantity.unit);
  const auto* prefix = std::find_if(prefixes.begin(), prefixes.end() - 1,
                                    [&](const Prefix& p) { return std::fabs(quantity.value) >= p.factor; });
  return fmt::format("{:.3g} {}{}", quantity.value / prefix->factor, prefix->letter, quantity.unit);
}

std::string progress_text(double fraction, const std::vector<Quantity>& row, double seconds_left) {
  std::string text = fmt::format("{:3.0f} %", std::floor(100 * fraction));
  for (const std::string_view name : {"strain", "phi", "z", "stress_top", "sweeps"}) {
    const auto at = std::find_if(row.begin(), row.end(), [&](const Quantity& q) { return q.name == name; });
    if (at != row.end()) text += fmt::format("  {} {}", name, short_value(*at));
  }
  return text + fmt::format("  ETA {}", duration_text(seconds_left));
}

Progress::Progress(ProgressStyle style) : style_(style) {
  if (style_ == ProgressStyle::automatic)
    style_ = ::isatty(STDERR_FILENO) == 1 ? ProgressStyle::tty : ProgressStyle::plain;
}

Progress::~Progress() { erase_line(); }

void Progress::erase_line() {
  if (std::exchange(line_on_screen_, false)) write_to_stderr("\r\033[K");
}

double Progress::seconds_left(double fraction) const {
  const double done = fraction - first_fraction_;
  const std::chrono::duration<double> elapsed = Clock::now() - begin_;
  return done > 0 ? elapsed.count() * (1 - fraction) / done : std::nan("");
}

void Progress::update(double fraction, const std::vector<Quantity>& row) {
  if (style_ == ProgressStyle::none) return;
  if (first_fraction_ < 0) first_fraction_ = fraction;
  const auto now = Clock::now();
  if (style_ == ProgressStyle::tty) {
    if (now - shown_ < rewrite_after) return;
    std::string line = bar(fraction) + progress_text(fraction, row, seconds_left(fraction));
    line.resize(std::min(line.size(), terminal_width() - 1));
    write_to_stderr("\r" + line + "\033[K");
    line_on_screen_ = true;
  } else {
    const int tenths = static_cast<int>(10 * fraction);
    if (tenths == tenths_shown_ && now - shown_ < repeat_after) return;
    write_to_stderr(progress_text(fraction, row, seconds_left(fraction)) + "\n");
    tenths_shown_ = tenths;
  }
  shown_ = now;
}

void Progress::message(std::string_view text) {
  erase_line();
  write_to_stderr(fmt::format("{}\n", text));
}

}  // namespace softgrain
