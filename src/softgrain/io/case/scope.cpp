#include "softgrain/io/case/scope.hpp"

#include <fmt/format.h>

#include <utility>

#include "softgrain/io/case/schema.hpp"
#include "softgrain/io/case/words.hpp"

namespace softgrain {
namespace {

/// "a, b and c".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  return text;
}

}  // namespace

std::vector<std::string> notes_on_effect(const Case& the_case, const std::vector<std::string>& keys) {
  std::vector<std::pair<std::string_view, std::vector<std::string>>> names_of_scopes;
  for (const std::string& name : keys) {
    const Key* key = find_key(name);
    if (key == nullptr || key->acts.covers(the_case)) continue;
    auto at = names_of_scopes.begin();
    while (at != names_of_scopes.end() && at->first != key->acts.words) ++at;
    if (at == names_of_scopes.end()) at = names_of_scopes.insert(at, {key->acts.words, {}});
    at->second.push_back(name);
  }
  std::vector<std::string> notes;
  for (const auto& [words, names] : names_of_scopes) {
    const bool one = names.size() == 1;
    notes.push_back(fmt::format("note: {} {} no effect on {} {}: {} only {}", listed(names),
                                one ? "has" : "have", word_of(the_case.experiment.model),
                                is_in_a_box(the_case) ? "in a box" : "between walls",
                                one ? "it acts" : "they act", words));
  }
  return notes;
}

}  // namespace softgrain
