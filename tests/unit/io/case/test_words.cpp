#include "softgrain/io/case/words.hpp"

#include <doctest/doctest.h>

#include <set>

using namespace softgrain;

namespace {

/// Every value up to `last` has a word, no two share one, and the word leads back to the value.
template <class Enum>
void check_words(Enum last) {
  std::set<std::string_view> words;
  for (int number = 0; number <= static_cast<int>(last); ++number) {
    const auto value = static_cast<Enum>(number);
    const std::string_view word = word_of(value);
    CHECK(!word.empty());
    CHECK(words.insert(word).second);
    CHECK(value_of<Enum>(word) == value);
  }
  CHECK(words_of<Enum>().size() == words.size());
  CHECK(!value_of<Enum>("").has_value());
  CHECK(!value_of<Enum>("nonsense").has_value());
}

}  // namespace

TEST_CASE("every choice of a case has its own word, which leads back to it") {
  check_words(LoadingPath::stages);
  check_words(GrainModel::rigid);
  check_words(ShapeOfGrain::surface);
  check_words(EqualPrimaries::size);
  check_words(MaterialLaw::prony);
  check_words(Integrator::symplectic_euler);
  check_words(Formulation::updated_lagrangian);
  check_words(ShapeFunction::bspline);
  check_words(ContactOn::grid_nodes);
  check_words(Activation::closed_at_end_of_step);
  check_words(Precision::single);
  check_words(Wave::triangle);
}
