#include "choices.hpp"

#include <CLI/CLI.hpp>

#include <map>

namespace softgrain {

namespace {

struct Choices {
  std::vector<std::string> words;
  bool only;  ///< nothing else is taken
};

/// The parser keeps checks, and no lists.
std::map<const CLI::Option*, Choices>& all_choices() {
  static std::map<const CLI::Option*, Choices> choices;
  return choices;
}

}  // namespace

CLI::Option* offer(CLI::Option* option, const std::vector<std::string>& words) {
  all_choices()[option] = {words, false};
  return option;
}

CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::string>& words) {
  all_choices()[option] = {words, true};
  return option->check(CLI::IsMember(words).description(""));
}

std::vector<std::string> choices_of(const CLI::Option* option) {
  const auto found = all_choices().find(option);
  return found == all_choices().end() ? std::vector<std::string>{} : found->second.words;
}

bool takes_only_choices(const CLI::Option* option) {
  const auto found = all_choices().find(option);
  return found != all_choices().end() && found->second.only;
}

}  // namespace softgrain
