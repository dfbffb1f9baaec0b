#pragma once
#include <string>

namespace softgrain {

/// docs/observables.md, from the table of columns (observe/columns.hpp).
std::string observables_page();

/// docs/reference/checkpoint.md, from the arrays that the models declare (state/field.hpp).
std::string checkpoint_page();

}  // namespace softgrain
