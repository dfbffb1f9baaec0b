#include "softgrain/material/any_law.hpp"

#include "softgrain/material/elastic_law.hpp"

namespace softgrain {
namespace {

template <class Law>
constexpr bool is_whole = (SplitLaw<Law, 2> && ElasticLaw<Law, 3>) || SplitHistoryLaw<Law, 2>;

template <class... Laws>
constexpr bool all_whole(const std::variant<Laws...>*) {
  return (is_whole<Laws> && ...);
}
static_assert(all_whole(static_cast<const AnyLaw*>(nullptr)));

constexpr bool in_order() {
  for (const LawChoice& choice : law_choices())
    if (&choice != &law_choice(choice.law)) return false;
  return true;
}
static_assert(in_order());

}  // namespace

bool has_history(const AnyLaw& law) {
  return std::visit([]<class Law>(const Law&) { return HistoryLaw<Law, 2>; }, law);
}

double wave_speed(const AnyLaw& law, double density) {
  return std::visit([&](const auto& some) { return some.wave_speed(density); }, law);
}

}  // namespace softgrain
