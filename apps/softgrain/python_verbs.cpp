#include "python_verbs.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "choices.hpp"
#include "python_program.hpp"
#include "verbs.hpp"

namespace softgrain {

extern const std::string_view python_options;  // python/softgrain/options.json

namespace {

using Json = nlohmann::json;

/// The table that both the program and Python's parser are made of.
const Json& tables() {
  static const Json table = Json::parse(python_options);
  return table;
}

std::string joined_names(const Json& option) {
  return fmt::format("{}", fmt::join(option.at("names").get<std::vector<std::string>>(), ","));
}

bool is_positional(const Json& option) { return !joined_names(option).starts_with('-'); }

void add_checks(CLI::Option& added, const Json& option) {
  const std::string kind = option.value("kind", "");
  if (option.contains("choices")) take_one_of(&added, option.at("choices").get<std::vector<std::string>>());
  if (option.contains("offers")) offer(&added, option.at("offers").get<std::vector<std::string>>());
  if (kind == "case") complete_case_path_of(added);
  if (kind == "count") added.check(CLI::Validator(at_least_one, ""));
  if (kind == "index") added.check(CLI::NonNegativeNumber);
  if (kind == "integer") added.check(CLI::TypeValidator<int>().description(""));
}

/// The words typed for an option stay with the parser, which keeps them as text.
void add_option(CLI::App& verb, const Json& option) {
  const std::string text = option.at("text");
  if (!is_positional(option) && !option.contains("value")) {
    verb.add_flag(joined_names(option), text);
    return;
  }
  const bool many = option.value("many", false);
  CLI::Option* added = verb.add_option(joined_names(option), CLI::callback_t{}, text);
  added->expected(many && is_positional(option) ? -1 : 1);
  if (many && !is_positional(option)) added->allow_extra_args(false);
  if (many) added->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->type_size(1);
  if (option.contains("value")) added->type_name(option.at("value"));
  if (option.contains("default")) {
    const Json& value = option.at("default");
    added->default_str(value.is_string() ? value.get<std::string>() : value.dump());
  }
  added->required(option.value("required", false));
  add_checks(*added, option);
}

/// --name=value for each option that was given, then the positionals behind "--".
std::vector<std::string> words_of(const CLI::App& verb, const Json& table) {
  std::vector<std::string> words = table.value("becomes", std::vector<std::string>{verb.get_name()}), places;
  for (const Json& option : table.at("options")) {
    const std::string name = option.at("names").back();
    for (const std::string& value : verb.get_option(name)->results()) {
      if (is_positional(option))
        places.push_back(value);
      else
        words.push_back(option.contains("value") ? fmt::format("{}={}", name, value) : name);
    }
  }
  words.emplace_back("--");
  words.insert(words.end(), places.begin(), places.end());
  return words;
}

}  // namespace

void carry_out_in_python(const CLI::App& verb) {
  become_python(words_of(verb, tables().at(verb.get_name())));
}

CLI::App* add_python_verb(CLI::App& app, const std::string& name) {
  const Json& table = tables().at(name);
  CLI::App* verb = app.add_subcommand(name, table.at("text").get<std::string>());
  for (const Json& option : table.at("options")) add_option(*verb, option);
  for (const Json& option : table.at("options"))
    for (const std::string& other : option.value("excludes", std::vector<std::string>{}))
      verb->get_option(option.at("names").back().get<std::string>())->excludes(verb->get_option(other));
  const auto footer = table.at("footer").get<std::vector<std::string>>();
  verb->footer(fmt::format("{}", fmt::join(footer, "\n")));
  verb->callback([verb] { carry_out_in_python(*verb); });
  return verb;
}

}  // namespace softgrain
