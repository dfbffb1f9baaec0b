#include <doctest/doctest.h>

#include <sstream>
#include <string>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

TEST_CASE("every column that a run writes is defined on the page of observables") {
  const std::string page = read_text(SOFTGRAIN_SOURCE_DIR "/docs/observables.md");
  for (const std::string model : {"bpm", "mpm"})
    for (const std::string loading : {"diametral", "compaction"}) {
      CAPTURE(model);
      CAPTURE(loading);
      const TemporaryDirectory folder;
      const auto path = folder.file(
          "case.toml",
          "[experiment]\nmodel = \"" + model + "\"\nloading = \"" + loading +
              "\"\n[sample]\ngrains = 4\npacking_fraction = 0.4\n[bpm]\nprimaries = 20\n[mpm]\ncells = 3\n"
              "[loading]\nmax_strain = 0.005\nunload_at = []\nwall_velocity = \"2 m/s\"\n"
              "[output]\nsamples = 1\nsnapshots = 1\nreport = false\n");
      const auto made = softgrain::test::run({SOFTGRAIN_PROGRAM, "run", path, "-q", "-o", "run"}, {},
                                             folder.path().string());
      REQUIRE_MESSAGE(made.exit_code == 0, made.err);
      std::istringstream series(read_text(folder.path() / "run/series.csv"));
      std::string header, column;
      std::getline(series, header);
      for (std::istringstream columns(header); std::getline(columns, column, ',');) {
        const std::string name = column.substr(0, column.find('['));
        CHECK_MESSAGE(page.find("`" + name + "`") != std::string::npos, name);
      }
    }
}
