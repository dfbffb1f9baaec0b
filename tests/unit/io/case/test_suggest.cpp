#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "softgrain/io/case/suggest.hpp"

using namespace softgrain;

TEST_CASE("the edit distance counts insertions, deletions, replacements and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);  // Levenshtein's example
  CHECK(edit_distance("density", "densty") == 1);
  CHECK(edit_distance("step", "setp") == 1);
}

TEST_CASE("only a near word is suggested") {
  const std::vector<std::string> words{"friction", "wall_friction", "restitution"};
  CHECK(nearest("fricton", words) == "friction");
  CHECK(nearest("walfriction", words) == "wall_friction");
  CHECK(nearest("colour", words).empty());
  CHECK(nearest("", words).empty());
  CHECK(nearest(std::string(100000, 'f'), words).empty());
  CHECK(did_you_mean("fricton", words) == "; did you mean 'friction'?");
  CHECK(did_you_mean("colour", words).empty());
}
