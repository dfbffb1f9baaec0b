#include <doctest/doctest.h>

#include "softgrain/core/error.hpp"
#include "softgrain/io/run/series_writer.hpp"
#include "support/file_size_limit.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;

namespace {

std::vector<Quantity> row(double step, double stress) {
  return {{"step", "", step}, {"stress_top", "Pa", stress}};
}

}  // namespace

TEST_CASE("a series begins with names and units and keeps every digit") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "series.csv";
  SeriesWriter series(path);
  series.write_row(row(0, 0));
  series.write_row(row(30012, 0.1));
  series.write_row(row(40000, 1.0 / 3));
  CHECK(test::read_text(path) == "step,stress_top[Pa]\n0,0\n30012,0.1\n40000,0.3333333333333333\n");
  CHECK(read_last_row(path)->at(1).unit == "Pa");
  CHECK(read_last_row(path)->at(1).value == 1.0 / 3);
}

TEST_CASE("a rewound series has lost its torn last line and the rows after the step") {
  const test::TemporaryDirectory directory;
  const std::string path = directory.file("series.csv", "step,z\n0,1\n10,2\n20,3\n30,4");
  SUBCASE("torn line only") {
    rewind_series(path, 30);
    CHECK(test::read_text(path) == "step,z\n0,1\n10,2\n20,3\n");
  }
  SUBCASE("later rows") {
    rewind_series(path, 10);
    CHECK(test::read_text(path) == "step,z\n0,1\n10,2\n");
  }
  SUBCASE("what follows a damaged line") {
    directory.file("series.csv", "step,z\n0,1\n1?,2\n10,2\n");
    rewind_series(path, 10);
    CHECK(test::read_text(path) == "step,z\n0,1\n");
  }
  SUBCASE("a torn header goes as a whole") {
    directory.file("series.csv", "step,stre");
    rewind_series(path, 10);
    CHECK(test::read_text(path).empty());
  }
}

TEST_CASE("a series goes on under the same columns only") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "series.csv";
  { SeriesWriter(path).write_row(row(0, 1)); }
  SeriesWriter again(path);
  again.write_row(row(1, 2));
  CHECK(test::read_text(path) == "step,stress_top[Pa]\n0,1\n1,2\n");
  CHECK_THROWS_AS(again.write_row({{"step", "", 2}}), UsageError);
}

TEST_CASE("a row that does not fit on the disk is taken back, and the error names the file and the bytes") {
  CHECK_THROWS_WITH_AS(AppendFile("/dev/full").append("12345"),
                       "/dev/full: cannot write 5 bytes: No space left on device", IoError);
  const test::TemporaryDirectory directory;
  const std::string path = directory.file("series.csv", "step,z\n0,1\n");
  const test::FileSizeLimit limit(15);
  CHECK_THROWS_AS(AppendFile(path).append("10,2.5\n"), IoError);
  CHECK(test::read_text(path) == "step,z\n0,1\n");
}
