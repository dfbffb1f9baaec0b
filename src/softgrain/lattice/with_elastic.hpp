#pragma once
#include <type_traits>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/material/elastic_law.hpp"

namespace softgrain {

/// visit(law) of an elastic law: points that move through the lattice do not keep what they remember. Raises
/// UsageError for others.
template <class Visit, class Result = std::invoke_result_t<Visit, const Hencky&>>
Result with_elastic(const AnyLaw& law, Visit&& visit) {
  const auto elastic = [&]<class Law>(const Law& some) -> Result {
    if constexpr (ElasticLaw<Law, 2>) return visit(some);
    throw UsageError("the updated Lagrangian formulation takes elastic laws only, none that flows");
  };
  return std::visit(elastic, law);
}

}  // namespace softgrain
