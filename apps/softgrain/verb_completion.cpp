#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "choices.hpp"
#include "softgrain/io/case/case_forms.hpp"
#include "softgrain/io/case/schema.hpp"
#include "softgrain/observe/columns.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

using Words = std::vector<std::string>;

struct OptionWords {
  std::string name;  ///< without its dashes
  std::string text;
  bool takes_value;
  Words choices;
};

struct VerbWords {
  std::string name, text;
  std::vector<OptionWords> options;
  Words places;        ///< what its first argument may be
  bool files = false;  ///< or a file
};

/// What a key of the case takes, if that can be listed.
struct KeyWords {
  std::string name;
  Words choices;
};

Words series_columns() {
  Words names;
  for (const Column& column : all_columns()) names.emplace_back(column.name);
  return names;
}

Words choices_of_option(const CLI::Option& option, const std::string& name) {
  return name == "column" ? series_columns() : choices_of(&option);
}

/// What there is to complete, from the parser itself.
std::vector<VerbWords> words_of(const CLI::App& app) {
  std::vector<VerbWords> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    VerbWords words{verb->get_name(), verb->get_description(), {}, {}};
    for (const CLI::Option* option : verb->get_options()) {
      for (const std::string& name : option->get_lnames())
        words.options.push_back({name, option->get_description(), option->get_items_expected_max() > 0,
                                 choices_of_option(*option, name)});
      if (option->get_positional() && words.places.empty()) {
        words.places = choices_of(option);
        words.files = !takes_only_choices(option);
      }
    }
    verbs.push_back(std::move(words));
  }
  return verbs;
}

/// The keys that --set takes: those of the schema, and other spellings.
std::vector<std::string> names_for_set() {
  std::vector<std::string> names = key_names();
  for (const FormKey& form : form_keys())
    if (form.name == "sample.file" || (form.takes == Takes::as_key && !form.name.starts_with("pair.")))
      names.push_back(form.name);
  return names;
}

std::vector<KeyWords> words_of_keys() {
  std::vector<KeyWords> keys;
  for (const Key& key : case_keys()) {
    Words choices;
    if (const auto* member = std::get_if<WordMember>(&key.member)) choices = member->words();
    if (std::holds_alternative<MemberOf<bool>>(key.member)) choices = {"true", "false"};
    keys.push_back({key.name, choices});
  }
  return keys;
}

std::string joined(const Words& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string dashed_options(const VerbWords& verb) {
  Words names;
  for (const OptionWords& option : verb.options) names.push_back("--" + option.name);
  return joined(names);
}

/// `"VERB --OPTION") ASSIGNMENT ;;` for each option whose values can be listed, in the syntax of bash and
/// zsh.
std::string cases_of_values(const std::vector<VerbWords>& verbs, const char* form) {
  std::string cases;
  for (const VerbWords& verb : verbs)
    for (const OptionWords& option : verb.options)
      if (!option.choices.empty())
        cases += fmt::format("    \"{} --{}\") {} ;;\n", verb.name, option.name,
                             fmt::format(fmt::runtime(form), joined(option.choices)));
  return cases;
}

std::string cases_of_keys(const char* form) {
  std::string cases;
  for (const KeyWords& key : words_of_keys())
    if (!key.choices.empty())
      cases += fmt::format("    {}) {} ;;\n", key.name, fmt::format(fmt::runtime(form), joined(key.choices)));
  return cases;
}

std::string cases_of_verbs(const std::vector<VerbWords>& verbs, const char* form) {
  std::string cases;
  for (const VerbWords& verb : verbs)
    cases += fmt::format("    {}) {} ;;\n", verb.name,
                         fmt::format(fmt::runtime(form), dashed_options(verb), joined(verb.places),
                                     verb.files && !verb.places.empty() ? "1" : ""));
  return cases;
}

/// 'text' with its apostrophes as `escaped`.
std::string quoted(const std::string& text, const std::string& escaped) {
  std::string words;
  for (const char letter : text) words += letter == '\'' ? escaped : std::string(1, letter);
  return "'" + words + "'";
}

std::string bash_completion(const std::vector<VerbWords>& verbs) {
  Words names;
  for (const VerbWords& verb : verbs) names.push_back(verb.name);
  return fmt::format(
      R"(# bash completion of softgrain. In ~/.bashrc: source <(softgrain completion bash)
_softgrain() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} key="" options="" places="" files="" values=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{names} --help --version" -- "$word"))
    return
  fi
  # bash parts words at = as well: --set key = value, --format = png
  if [[ $word == = ]]; then
    key=$before word="" before=${{COMP_WORDS[COMP_CWORD-2]}}
  elif [[ $before == = ]]; then
    key=${{COMP_WORDS[COMP_CWORD-2]}} before=${{COMP_WORDS[COMP_CWORD-3]}}
  fi
  if [[ $key == --* ]]; then
    before=$key key=""
  fi
  if [[ $before == --set || $before == --vary ]] && [[ -z $key ]]; then
    compopt -o nospace 2> /dev/null
    COMPREPLY=($(compgen -S = -W "{keys}" -- "$word"))
    return
  fi
  case $key in
{key_cases}  esac
  case "${{COMP_WORDS[1]}} $before" in
{value_cases}  esac
  if [[ -n $values ]]; then
    COMPREPLY=($(compgen -W "$values" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif ((COMP_CWORD == 2)) && [[ -n $places ]]; then
    COMPREPLY=($(compgen ${{files:+-f}} -W "$places" -- "$word"))
  fi
}}
complete -o default -F _softgrain softgrain
)",
      fmt::arg("names", joined(names)), fmt::arg("keys", joined(names_for_set())),
      fmt::arg("key_cases", cases_of_keys("values=\"{}\"")),
      fmt::arg("value_cases", cases_of_values(verbs, "values=\"{}\"")),
      fmt::arg("cases", cases_of_verbs(verbs, "options=\"{}\" places=\"{}\" files=\"{}\"")));
}

std::string zsh_completion(const std::vector<VerbWords>& verbs) {
  std::string names;
  for (const VerbWords& verb : verbs)
    names += fmt::format("    {}\n", quoted(verb.name + ":" + verb.text, "'\\''"));
  return fmt::format(
      R"(#compdef softgrain
# zsh completion of softgrain: save as _softgrain in a folder of $fpath, or in ~/.zshrc after compinit:
# source <(softgrain completion zsh)
_softgrain() {{
  local -a verbs options places files values
  verbs=(
{names}  )
  if ((CURRENT == 2)); then
    _describe verb verbs
    return
  fi
  if [[ $words[CURRENT-1] == (--set|--vary) ]]; then
    if compset -P '*='; then
      case ${{IPREFIX%=}} in
{key_cases}      esac
      compadd -- $values
    else
      compadd -S = -- {keys}
    fi
    return
  fi
  case "$words[2] $words[CURRENT-1]" in
{value_cases}  esac
  case $words[2] in
{cases}  esac
  if ((#values)); then
    compadd -- $values
  elif [[ $words[CURRENT] == -* ]]; then
    compadd -- $options
  elif ((CURRENT == 3 && #places)); then
    compadd -- $places
    ((#files)) && _files
  else
    _files
  fi
}}
compdef _softgrain softgrain
)",
      fmt::arg("names", names), fmt::arg("keys", joined(names_for_set())),
      fmt::arg("key_cases", cases_of_keys("values=({})")),
      fmt::arg("value_cases", cases_of_values(verbs, "values=({})")),
      fmt::arg("cases", cases_of_verbs(verbs, "options=({}) places=({}) files=({})")));
}

std::string fish_completion(const std::vector<VerbWords>& verbs) {
  std::string text =
      "# fish completion of softgrain: save as ~/.config/fish/completions/softgrain.fish\n"
      "complete -c softgrain -n __fish_use_subcommand -f -l help\n";
  Words keys;
  for (const std::string& name : names_for_set()) keys.push_back(name + "=");
  for (const KeyWords& key : words_of_keys()) {
    for (const std::string& choice : key.choices) keys.push_back(fmt::format("{}={}", key.name, choice));
  }
  for (const VerbWords& verb : verbs) {
    text += fmt::format("complete -c softgrain -n __fish_use_subcommand -f -a {} -d {}\n", verb.name,
                        quoted(verb.text, "\\'"));
    if (!verb.places.empty())
      text += fmt::format("complete -c softgrain -n '__fish_seen_subcommand_from {}' {}-a '{}'\n", verb.name,
                          verb.files ? "" : "-f ", joined(verb.places));
    for (const OptionWords& option : verb.options) {
      const bool of_case = option.name == "set" || option.name == "vary";
      const Words& offered = of_case ? keys : option.choices;
      const std::string value = !offered.empty()     ? " -x -a '" + joined(offered) + "'"
                                : option.takes_value ? " -r"
                                                     : "";
      text += fmt::format("complete -c softgrain -n '__fish_seen_subcommand_from {}' -l {}{} -d {}\n",
                          verb.name, option.name, value, quoted(option.text, "\\'"));
    }
  }
  return text;
}

}  // namespace

void add_completion_verb(CLI::App& app) {
  auto* verb = app.add_subcommand("completion", "Print what makes a shell complete verbs, options and keys");
  auto shell = std::make_shared<std::string>();
  take_one_of(verb->add_option("SHELL", *shell, "bash, zsh or fish")->required(), {"bash", "zsh", "fish"});
  verb->footer("Example:\n  source <(softgrain completion bash)    in ~/.bashrc");
  verb->callback([shell, &app] {
    const auto verbs = words_of(app);
    print_result(*shell == "bash"  ? bash_completion(verbs)
                 : *shell == "zsh" ? zsh_completion(verbs)
                                   : fish_completion(verbs));
  });
}

}  // namespace softgrain
