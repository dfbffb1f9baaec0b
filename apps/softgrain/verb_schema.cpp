#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "softgrain/io/case_schema.hpp"
#include "verbs.hpp"

namespace softgrain {

void add_schema_verb(CLI::App& app) {
  auto markdown = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand("schema", "Print the keys of a case file as JSON Schema, for editors");
  verb->add_flag("--markdown", *markdown, "as the reference page of the documentation");
  verb->footer(
      "Examples:\n"
      "  softgrain schema > case.schema.json    then write `#:schema ./case.schema.json` on the case's first "
      "line\n"
      "  softgrain schema --markdown > docs/reference/case-file.md");
  verb->callback([markdown] { fmt::print("{}", *markdown ? case_reference_page() : case_json_schema()); });
}

}  // namespace softgrain
