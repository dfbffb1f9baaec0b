#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "choices.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_schema.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/format/file.hpp"
#include "verbs.hpp"

namespace softgrain {
namespace {

struct NewOptions {
  std::string directory;
  std::string template_name;
  bool all = false;
};

const CaseTemplate& find_template(const std::string& name) {
  std::vector<std::string> names;
  for (const CaseTemplate& candidate : case_templates()) {
    if (candidate.name == name) return candidate;
    names.push_back(candidate.name);
  }
  throw UsageError(fmt::format("unknown template '{}'{}\none of: {}", name, did_you_mean(name, names),
                               fmt::join(names, ", ")));
}

void write_new_case(const NewOptions& options) {
  const CaseTemplate& start = find_template(options.template_name);
  const std::filesystem::path path = std::filesystem::path(options.directory) / "case.toml";
  require(!std::filesystem::exists(path), "{} exists already; choose another name", path.string());
  std::error_code failed;
  std::filesystem::create_directories(options.directory, failed);
  if (failed)
    throw IoError(fmt::format("cannot make the directory {}: {}", options.directory, failed.message()));
  write_file(path,
             commented_case_text(start.content(), options.all ? Keys::all : Keys::that_act, start.advice));
  write_file(path.parent_path() / "case.schema.json", case_json_schema());
  fmt::print("{}\n", path.string());
}

std::string list_of_templates() {
  std::string text = "Templates:\n";
  for (const CaseTemplate& start : case_templates())
    text += fmt::format("  {:22} {}\n", start.name, start.text);
  return text;
}

}  // namespace

void add_new_verb(CLI::App& app) {
  auto options = std::make_shared<NewOptions>();
  options->template_name = case_templates().front().name;
  CLI::App* verb =
      app.add_subcommand("new", "Write NAME/case.toml, commented, ready to run, and its schema for editors");
  verb->add_option("NAME", options->directory, "directory to make")->required();
  std::vector<std::string> names;
  for (const CaseTemplate& start : case_templates()) names.push_back(start.name);
  offer(verb->add_option("--template", options->template_name, "what to start from")->capture_default_str(),
        names);
  verb->add_flag("--all", options->all, "also the keys that do nothing in this case");
  verb->footer(list_of_templates() + "\nExample:\n  softgrain new squeeze --template diametral-bpm");
  verb->callback([options] { write_new_case(*options); });
}

}  // namespace softgrain
