#include "softgrain/io/case/checked_case.hpp"

#include "softgrain/experiment/check_case.hpp"

namespace softgrain {

Origin place_of_key_in(std::string_view message, const CaseReading& reading) {
  Origin origin;
  std::size_t first = std::string_view::npos;
  for (const auto& [key, given_at] : reading.origins)
    if (const std::size_t at = place_of_key(key, message); at < first) first = at, origin = given_at;
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
