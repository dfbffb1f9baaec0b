#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "softgrain/io/case_forms.hpp"
#include "softgrain/io/schema.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct OptionWords {
  std::string name;  ///< without its dashes
  std::string text;
  bool takes_value;
};

struct VerbWords {
  std::string name, text;
  std::vector<OptionWords> options;
};

/// What there is to complete, from the parser itself.
std::vector<VerbWords> words_of(const CLI::App& app) {
  std::vector<VerbWords> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    VerbWords words{verb->get_name(), verb->get_description(), {}};
    for (const CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames())
        words.options.push_back({name, option->get_description(), option->get_items_expected_max() > 0});
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

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string dashed_options(const VerbWords& verb) {
  std::vector<std::string> names;
  for (const OptionWords& option : verb.options) names.push_back("--" + option.name);
  return joined(names);
}

/// 'text' with its apostrophes as `escaped`.
std::string quoted(const std::string& text, const std::string& escaped) {
  std::string words;
  for (const char letter : text) words += letter == '\'' ? escaped : std::string(1, letter);
  return "'" + words + "'";
}

std::string bash_completion(const std::vector<VerbWords>& verbs) {
  std::string names, cases;
  for (const VerbWords& verb : verbs) {
    names += (names.empty() ? "" : " ") + verb.name;
    cases += fmt::format("    {}) options=\"{}\" ;;\n", verb.name, dashed_options(verb));
  }
  return fmt::format(
      R"(# bash completion of softgrain. In ~/.bashrc: source <(softgrain completion bash)
_softgrain() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{names} --help --version" -- "$word"))
    return
  fi
  if [[ $before == --set || $before == --vary ]]; then
    compopt -o nospace 2> /dev/null
    COMPREPLY=($(compgen -S = -W "{keys}" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  fi
}}
complete -o default -F _softgrain softgrain
)",
      fmt::arg("names", names), fmt::arg("keys", joined(names_for_set())), fmt::arg("cases", cases));
}

std::string zsh_completion(const std::vector<VerbWords>& verbs) {
  std::string names, cases;
  for (const VerbWords& verb : verbs) {
    names += fmt::format("    {}\n", quoted(verb.name + ":" + verb.text, "'\\''"));
    cases += fmt::format("    {}) options=({}) ;;\n", verb.name, dashed_options(verb));
  }
  return fmt::format(
      R"(#compdef softgrain
# zsh completion of softgrain: save as _softgrain in a folder of $fpath, or in ~/.zshrc after compinit:
# source <(softgrain completion zsh)
_softgrain() {{
  local -a verbs options
  verbs=(
{names}  )
  if ((CURRENT == 2)); then
    _describe verb verbs
    return
  fi
  if [[ $words[CURRENT-1] == (--set|--vary) ]]; then
    compadd -S = -- {keys}
    return
  fi
  case $words[2] in
{cases}  esac
  if [[ $words[CURRENT] == -* ]]; then
    compadd -- $options
  else
    _files
  fi
}}
compdef _softgrain softgrain
)",
      fmt::arg("names", names), fmt::arg("keys", joined(names_for_set())), fmt::arg("cases", cases));
}

std::string fish_completion(const std::vector<VerbWords>& verbs) {
  std::string text =
      "# fish completion of softgrain: save as ~/.config/fish/completions/softgrain.fish\n"
      "complete -c softgrain -n __fish_use_subcommand -f -l help\n";
  std::vector<std::string> keys;
  for (const std::string& name : names_for_set()) keys.push_back(name + "=");
  for (const VerbWords& verb : verbs) {
    text += fmt::format("complete -c softgrain -n __fish_use_subcommand -f -a {} -d {}\n", verb.name,
                        quoted(verb.text, "\\'"));
    for (const OptionWords& option : verb.options) {
      const bool of_case = option.name == "set" || option.name == "vary";
      const std::string value = of_case ? " -x -a '" + joined(keys) + "'" : option.takes_value ? " -r" : "";
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
  verb->add_option("SHELL", *shell, "bash, zsh or fish")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}).description(""))
      ->required();
  verb->footer("Example:\n  source <(softgrain completion bash)    in ~/.bashrc");
  verb->callback([shell, &app] {
    const auto verbs = words_of(app);
    print_result(*shell == "bash"  ? bash_completion(verbs)
                 : *shell == "zsh" ? zsh_completion(verbs)
                                   : fish_completion(verbs));
  });
}

}  // namespace softgrain
