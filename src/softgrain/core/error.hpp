#pragma once
#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace softgrain {

/// The user's mistake: a bad case file, argument or parameter. The program ends with exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The numbers broke down: NaN, no solution after step halving. The program ends with exit code 3.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file could not be read or written. The program ends with exit code 4.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws UsageError with the formatted text unless `ok`. For the user's mistakes; `assert` is for ours.
template <class... Args>
void require(bool ok, fmt::format_string<Args...> text, Args&&... args) {
  if (!ok) throw UsageError(fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace softgrain
