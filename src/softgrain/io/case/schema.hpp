#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/io/case/scope.hpp"

namespace softgrain {

/// Numbers that a key takes, in SI. A list's range holds for each of its numbers.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool without_low = false;   ///< the lower bound itself is excluded
  bool without_high = false;  ///< the upper bound itself is excluded

  bool contains(double value) const;
  std::string text() const;  ///< "> 0", ">= 1", "in [0, 1]", "in (0, 2)", "" for all
};

/// Where a key's value lies in a Case; the type it takes follows from it.
template <class T>
using MemberOf = T& (*)(Case&);
/// An enum in a Case, seen through its words (io/case/words.hpp).
struct WordMember {
  std::vector<std::string> (*words)();           ///< all that it takes
  std::string_view (*word)(const Case&);         ///< that of its value
  bool (*assign)(Case&, std::string_view word);  ///< false: not one of the words

  std::string_view operator()(const Case& c) const { return word(c); }
};
using Member = std::variant<MemberOf<bool>, MemberOf<int>, MemberOf<std::int64_t>, MemberOf<double>,
                            WordMember, MemberOf<std::vector<double>>, MemberOf<std::vector<PlacedGrain>>,
                            MemberOf<std::vector<OutlinePoint>>, MemberOf<TriangleMesh>>;

/// One key of a case file. Its default is the value in Case{}.
struct Key {
  std::string name;  ///< with its table: "loading.wall_velocity"
  Member member;
  std::string_view
      unit;  ///< in which people write it: "mm"; fixes the dimension; "" for plain numbers and words
  Range range;
  std::string_view text;
  Scope acts = scope::everywhere;   ///< where it acts; elsewhere it is taken, and a note says so
  std::string_view zero_word = {};  ///< a word for the number 0: "auto"

  std::string table() const { return name.substr(0, name.find('.')); }
  std::string short_name() const { return name.substr(name.find('.') + 1); }
};

struct TableOfKeys {
  std::string name;
  std::string_view text;
};

/// The one list of all keys: parser, checks, JSON Schema, reference page, template and resolved case follow
/// it.
const std::vector<Key>& case_keys();
const std::vector<TableOfKeys>& case_tables();

/// Calls `on_table` for each table and `on_key` for each of its keys.
template <class OnTable, class OnKey>
void for_each_key(const OnTable& on_table, const OnKey& on_key) {
  for (const TableOfKeys& table : case_tables()) {
    on_table(table);
    for (const Key& key : case_keys())
      if (key.table() == table.name) on_key(key);
  }
}

/// nullptr when there is no key of this full name.
const Key* find_key(std::string_view name);
std::vector<std::string> key_names();

}  // namespace softgrain
