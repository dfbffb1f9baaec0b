#pragma once
#include <string>
#include <string_view>

#include "softgrain/io/case/case_file.hpp"

namespace softgrain {

/// Where the first key that a message names was given; the case file where it names none that was given.
Origin place_of_key_in(std::string_view message, const CaseReading& reading);

/// check_case of a case that was read. What is wrong with it becomes a CaseFileError, at the place of the
/// first key that it names.
void check_case(const CaseReading& reading);

}  // namespace softgrain
