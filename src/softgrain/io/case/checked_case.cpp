#include "softgrain/io/case/checked_case.hpp"

#include <vector>

#include "softgrain/experiment/check_case.hpp"

namespace softgrain {
namespace {

/// Where the message names this key, and not another one of which the name is a part; npos for nowhere.
std::size_t place_of(const std::string& key, std::string_view message) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789_";
  const auto is_letter = [&](std::size_t i) {
    return i < message.size() && letters.find(message[i]) != std::string_view::npos;
  };
  std::size_t at = message.find(key);
  while (at != std::string_view::npos && (is_letter(at + key.size()) || (at > 0 && is_letter(at - 1))))
    at = message.find(key, at + 1);
  return at;
}

}  // namespace

Origin place_of_key_in(std::string_view message, const CaseReading& reading) {
  Origin origin;
  std::size_t first = std::string_view::npos;
  for (const auto& [key, given_at] : reading.origins)
    if (const std::size_t at = place_of(key, message); at < first) first = at, origin = given_at;
  return origin;
}

void check_case(const CaseReading& reading) {
  try {
    check_case(reading.the_case);
  } catch (const UsageError& error) {
    throw CaseFileError(
        report({{place_of_key_in(error.what(), reading), error.what()}}, reading.sources, reading.sets));
  }
}

}  // namespace softgrain
