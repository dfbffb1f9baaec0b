#pragma once
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming)
class Option;
}

namespace softgrain {

/// The option takes one of these words, which shells offer when they complete its value.
CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::string>& words);

/// Shells offer these words; what else is given is for the verb to judge.
CLI::Option* offer(CLI::Option* option, const std::vector<std::string>& words);

/// The words that shells offer for an option; none if it takes anything.
std::vector<std::string> choices_of(const CLI::Option* option);

/// Whether it takes no other word.
bool takes_only_choices(const CLI::Option* option);

}  // namespace softgrain
