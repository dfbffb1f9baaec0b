#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace softgrain {

/// Number of single-letter insertions, deletions, replacements and swaps of neighbours that turn `a` into
/// `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to a mistyped `word`, or "" when none is near enough to be meant (a third of its
/// letters).
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean 'x'?" with the nearest candidate, or "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace softgrain
