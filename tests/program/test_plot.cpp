#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::ProcessResult;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

/// `softgrain plot` with an interpreter that writes down its arguments and ends with exit code 4.
ProcessResult plot(const TemporaryDirectory& folder, std::vector<std::string> arguments) {
  const std::string fake = folder.file("python", "#!/bin/sh\nprintf '%s\\n' \"$@\"\nexit 4\n");
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  arguments.insert(arguments.begin(), {SOFTGRAIN_PROGRAM, "plot"});
  return softgrain::test::run(arguments, {{"SOFTGRAIN_PYTHON", fake}});
}

}  // namespace

TEST_CASE("plot hands its arguments to Python word for word and ends with Python's exit code") {
  const TemporaryDirectory folder;
  const auto result =
      plot(folder, {"slow run", "it's; $(fast)", "-o", "-odd", "--format", "svg", "--normalise"});
  CHECK(result.exit_code == 4);
  CHECK(result.err.empty());
  const std::string words = "--output=-odd\n--format=svg\n--normalise\n--\nslow run\nit's; $(fast)\n";
  CHECK(result.out.ends_with("/python/softgrain\nplot\n" + words));
}

TEST_CASE("plot refuses an unknown figure or format before it starts Python") {
  const TemporaryDirectory folder;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--kind", "pie"}, {"--format", "gif"}, {"--colour", "red"}}) {
    std::vector<std::string> arguments{"RUN"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const auto result = plot(folder, arguments);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(result.err.find(wrong.front()) != std::string::npos);
  }
}

TEST_CASE("plot without Python names the Debian packages it needs") {
  const auto result =
      softgrain::test::run({SOFTGRAIN_PROGRAM, "plot", "RUN"}, {{"SOFTGRAIN_PYTHON", "/no/python3"}});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("/no/python3") != std::string::npos);
  CHECK(result.err.find("python3-matplotlib python3-h5py") != std::string::npos);
}

TEST_CASE("plot ends with exit code 2 where there is no run") {
  const TemporaryDirectory folder;
  const auto result = softgrain::test::run({SOFTGRAIN_PROGRAM, "plot", folder.path().string()});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("case.toml") != std::string::npos);
}
