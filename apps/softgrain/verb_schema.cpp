#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "softgrain/io/case/case_schema.hpp"
#include "softgrain/io/page/reference_pages.hpp"
#include "verbs.hpp"

namespace softgrain {

void add_schema_verb(CLI::App& app) {
  struct Pages {
    bool markdown = false, columns = false, arrays = false;
  };
  auto pages = std::make_shared<Pages>();
  CLI::App* verb = app.add_subcommand("schema", "Print the keys of a case file as JSON Schema, for editors");
  CLI::Option_group* page = verb->add_option_group("pages", "Pages of the documentation instead");
  page->add_flag("--markdown", pages->markdown, "keys of a case file");
  page->add_flag("--columns", pages->columns, "columns of series.csv");
  page->add_flag("--arrays", pages->arrays, "arrays of a checkpoint");
  page->require_option(0, 1);
  verb->footer(
      "Examples:\n"
      "  softgrain schema > case.schema.json    then write `#:schema ./case.schema.json` on the case's first "
      "line\n"
      "  softgrain schema --markdown > docs/reference/case-file.md\n"
      "  softgrain schema --columns > docs/observables.md\n"
      "  softgrain schema --arrays > docs/reference/checkpoint.md");
  verb->callback([pages] {
    fmt::print("{}", pages->markdown  ? case_reference_page()
                     : pages->columns ? observables_page()
                     : pages->arrays  ? checkpoint_page()
                                      : case_json_schema());
  });
}

}  // namespace softgrain
