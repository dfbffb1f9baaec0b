#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz/targets.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/case/units.hpp"

namespace softgrain::fuzz {
namespace {

/// An accepted case can be estimated and written, and what is written is the same case.
void check_accepted(const Case& the_case) {
  estimate(the_case);
  const std::string text = resolved_case_text(the_case);
  try {
    if (resolved_case_text(parse_case(text, "resolved")) == text) return;
  } catch (const UsageError&) {
  }
  throw std::logic_error("the resolved case is not the case");
}

}  // namespace

void read_case_file(std::string_view bytes) {
  Case the_case;
  try {
    the_case = parse_case(bytes, "case.toml");
  } catch (const UsageError&) {
    return;
  }
  check_accepted(the_case);
}

void read_settings(std::string_view bytes) {
  static const std::string base = case_templates().front().text;
  std::vector<std::string> settings;
  for (std::size_t end = 0; end != std::string_view::npos && settings.size() < 20;) {
    end = bytes.find('\n');
    settings.emplace_back(bytes.substr(0, end));
    bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
  }
  Case the_case;
  try {
    the_case = parse_case(base, "case.toml", settings);
  } catch (const UsageError&) {
    return;
  }
  check_accepted(the_case);
}

void read_quantity(std::string_view bytes) {
  constexpr std::array<Dimension, 6> dimensions{
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, -1}, {-1, 1, -2}, {-3, 1, 0}}};
  if (bytes.empty()) return;
  const Dimension& expected = dimensions[static_cast<unsigned char>(bytes.front()) % dimensions.size()];
  const std::string_view text = bytes.substr(1);
  try {
    const double value = parse_quantity(text, expected);
    if (!std::isfinite(value)) throw std::logic_error("a quantity is not finite");
  } catch (const UsageError&) {
  }
  try {
    in_words(parse_unit(text).dimension);
  } catch (const UsageError&) {
  }
}

}  // namespace softgrain::fuzz
