#pragma once
#include <string>

#include "softgrain/io/case/case_draft.hpp"

namespace softgrain {

/// What is wrong with the shape of the grains of a kind, and a remedy; "" where nothing is.
std::string shape_cannot(const Case& kind);

/// The same as an issue of the draft of a case of one kind; and for outlines that no grid fits, with the line
/// of the nearest point. grain.outline then is invalid.
void check_shape(CaseDraft& draft);

}  // namespace softgrain
