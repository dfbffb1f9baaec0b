#include "choices.hpp"

#include <CLI/CLI.hpp>

#include <map>

namespace softgrain {

namespace {

/// The parser keeps checks, and no lists.
std::map<const CLI::Option*, std::vector<std::string>>& all_choices() {
  static std::map<const CLI::Option*, std::vector<std::string>> choices;
  return choices;
}

}  // namespace

CLI::Option* offer(CLI::Option* option, const std::vector<std::string>& words) {
  all_choices()[option] = words;
  return option;
}

CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::string>& words) {
  return offer(option, words)->check(CLI::IsMember(words).description(""));
}

std::vector<std::string> choices_of(const CLI::Option* option) {
  const auto found = all_choices().find(option);
  return found == all_choices().end() ? std::vector<std::string>{} : found->second;
}

}  // namespace softgrain
