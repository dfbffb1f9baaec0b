#pragma once
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Keys that must fit together, checked once each of them is valid alone.
struct Relation {
  std::vector<std::string> keys;
  std::string (*broken)(const Case&);  ///< what is wrong, or ""
};

const std::vector<Relation>& case_relations();

}  // namespace softgrain
