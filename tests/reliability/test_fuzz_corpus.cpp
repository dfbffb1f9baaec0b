#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "fuzz/targets.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;

TEST_CASE("readers take or refuse every file of the fuzzers' corpus: no crash, no other error") {
  const std::pair<std::string, std::function<void(std::string_view)>> targets[] = {
      {"case_file", fuzz::read_case_file},
      {"settings", fuzz::read_settings},
      {"quantity", fuzz::read_quantity},
      {"snapshot_file", fuzz::read_snapshot_file},
      {"contact_problem", fuzz::read_contact_problem},
      {"series", fuzz::read_series},
      {"record", fuzz::read_record},
  };
  for (const auto& [name, read] : targets) {
    int files = 0;
    const auto corpus = std::filesystem::path(SOFTGRAIN_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / name;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
      const std::string bytes = test::read_text(entry.path());
      CAPTURE(entry.path().string());
      CHECK_NOTHROW(read(bytes));
      ++files;
    }
    CAPTURE(name);
    CHECK(files >= 4);
  }
}
