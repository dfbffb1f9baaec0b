#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/io/case/schema.hpp"

namespace softgrain {

/// What a key of a form takes.
enum class Takes {
  as_key,  ///< what the keys take that it stands for
  number,  ///< a number, or a quantity in `unit`
  word,    ///< one of `words`
  text,    ///< any text
  texts,   ///< a list of texts
};

/// A key of a case file that Case has no member for: another spelling of keys that are in the schema, a part
/// of a pair or a stage.
struct FormKey {
  std::string name;  ///< with all its tables: "kind.law.young_modulus"
  Takes takes;
  std::vector<std::string> keys;  ///< of the schema, for which it stands
  std::string_view text;
  std::vector<std::string> words = {}, later = {};  ///< `later` come with later versions
  std::string_view unit = {};
  Range range = {};
};

/// The list of them, which parser, JSON Schema, reference page and completion follow as they do case_keys().
const std::vector<FormKey>& form_keys();

/// Tables that may stand several times, as [[kind]].
const std::vector<TableOfKeys>& form_tables();

/// nullptr where there is none.
const FormKey* find_form(std::string_view name);

/// Old spellings, still read: a key that has another name now, and what to write.
struct OldKey {
  std::string name;
  std::string now;
};
const std::vector<OldKey>& old_keys();

}  // namespace softgrain
