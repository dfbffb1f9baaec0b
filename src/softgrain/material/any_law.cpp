#include "softgrain/material/any_law.hpp"

#include "softgrain/material/elastic_law.hpp"

namespace softgrain {
namespace {

template <class... Laws>
constexpr bool all_elastic(const std::variant<Laws...>*) {
  return ((SplitLaw<Laws, 2> && ElasticLaw<Laws, 3>)&&...);
}
static_assert(all_elastic(static_cast<const AnyLaw*>(nullptr)));

constexpr bool in_order() {
  for (const LawChoice& choice : law_choices())
    if (&choice != &law_choice(choice.law)) return false;
  return true;
}
static_assert(in_order());

}  // namespace
}  // namespace softgrain
