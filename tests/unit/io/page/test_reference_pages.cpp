#include "softgrain/io/page/reference_pages.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "softgrain/observe/columns.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;

TEST_CASE("the pages of observables and of checkpoints are those that the program writes") {
  const std::string docs = SOFTGRAIN_SOURCE_DIR "/docs/";
  CHECK_MESSAGE(test::read_text(docs + "observables.md") == observables_page(),
                "run: softgrain schema --columns > docs/observables.md");
  CHECK_MESSAGE(test::read_text(docs + "reference/checkpoint.md") == checkpoint_page(),
                "run: softgrain schema --arrays > docs/reference/checkpoint.md");
}

TEST_CASE("every column has a name of its own and a place on the page") {
  const std::string page = observables_page();
  std::set<std::string_view> names;
  for (const Column& column : all_columns()) {
    CHECK(names.insert(column.name).second);
    CHECK(page.find("`" + std::string(column.name) + "`") != std::string::npos);
  }
}
