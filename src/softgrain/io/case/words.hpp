#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// A value of an enum of Case and its word in case files.
template <class Enum>
struct Word {
  Enum value;
  std::string_view word;
};
template <class Enum>
Word(Enum, std::string_view) -> Word<Enum>;  // which clang 14 does not deduce of an aggregate

/// The one table of the words of an enum, in the order in which messages and schema list them.
template <class Enum>
std::span<const Word<Enum>> words_of();
template <>
std::span<const Word<LoadingPath>> words_of();
template <>
std::span<const Word<GrainModel>> words_of();
template <>
std::span<const Word<EqualPrimaries>> words_of();
template <>
std::span<const Word<MaterialLaw>> words_of();
template <>
std::span<const Word<Integrator>> words_of();
template <>
std::span<const Word<Formulation>> words_of();
template <>
std::span<const Word<ShapeFunction>> words_of();
template <>
std::span<const Word<ContactOn>> words_of();
template <>
std::span<const Word<Activation>> words_of();
template <>
std::span<const Word<Places>> words_of();
template <>
std::span<const Word<SizeLaw>> words_of();
template <>
std::span<const Word<Precision>> words_of();
template <>
std::span<const Word<Wave>> words_of();
template <>
std::span<const Word<BoxEnd>> words_of();

/// "diametral" for LoadingPath::diametral.
template <class Enum>
std::string_view word_of(Enum value) {
  for (const Word<Enum>& entry : words_of<Enum>())
    if (entry.value == value) return entry.word;
  return "";
}

/// LoadingPath::diametral for "diametral"; nothing for what is no word of this enum.
template <class Enum>
std::optional<Enum> value_of(std::string_view word) {
  for (const Word<Enum>& entry : words_of<Enum>())
    if (entry.word == word) return entry.value;
  return std::nullopt;
}

}  // namespace softgrain
