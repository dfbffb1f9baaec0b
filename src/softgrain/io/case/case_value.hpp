#pragma once
#include <string>

#include "softgrain/experiment/case.hpp"
#include "softgrain/io/case/schema.hpp"
#include "softgrain/io/case/toml_document.hpp"

namespace softgrain {

/// Checks a value against its key and puts it into the case, in SI. Raises UsageError: wrong type, wrong
/// dimension, out of range, not one of the words.
void assign(Case& the_case, const Key& key, const TomlValue& value);

/// What a key takes, in words: "a length", "a whole number", "a list of plain numbers", "true or false".
std::string kind_in_words(const Key& key);

/// The same with its range: "a length, > 0 m"; words and switches need none.
std::string accepted(const Key& key);

/// "m/s" for a key in "mm/s"; "" for plain numbers.
std::string si_unit_of(const Key& key);

/// The value as people write it in TOML, in the key's unit: `"5 mm"`, `[0.1, 0.3]`, `true`. Reads back
/// exactly.
std::string written_value(const Case& the_case, const Key& key);

/// The value as TOML in SI, shortest digits that read back bit for bit: `0.005`.
std::string value_in_si(const Case& the_case, const Key& key);

}  // namespace softgrain
