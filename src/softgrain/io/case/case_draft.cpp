#include "softgrain/io/case/case_draft.hpp"

#include <fmt/core.h>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/outline_file.hpp"
#include "softgrain/io/case/surface_file.hpp"

namespace softgrain {

void CaseDraft::add(Origin origin, std::string message) {
  constexpr std::size_t most = 100;
  issues.push_back({origin, std::move(message)});
  if (issues.size() == most) throw TooManyIssues{};
}

void CaseDraft::give(const Key& key, const std::string& name, const TomlValue& value, Origin origin) {
  if (origin.set < 0) {
    const auto [other, first] = names_.emplace(key.name, name);
    if (!first)
      return add(origin,
                 name == other->second
                     ? fmt::format("'{}' is given twice: give it once", name)
                     : fmt::format("'{}' says again what '{}' says: give one of them", name, other->second));
  }
  origins[key.name] = origin;
  try {
    Key named = key;
    named.name = name;
    const auto* file = std::get_if<std::string>(&value.content);
    const bool may_name_a_file = file != nullptr && sources != nullptr;
    if (may_name_a_file && key.name == "grain.surface") {
      the_case.grain.surface = surface_of_file(*file, origin, *this);
      return;
    }
    const bool names_a_file = may_name_a_file && key.name == "grain.outline";
    assign(the_case, named, names_a_file ? outline_of_file(*file, origin, *this) : value);
  } catch (const UsageError& error) {
    if (value.at.line > 0) origin.at = value.at;
    add(origin, error.what());
    invalid.insert(key.name);
  }
}

void CaseDraft::give_number(const std::string& key, double number, const std::string& name, Origin origin) {
  give(*find_key(key), name, {number, {}}, origin);
}

}  // namespace softgrain
