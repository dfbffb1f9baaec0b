#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "softgrain/io/schema.hpp"
#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::ProcessResult;

namespace {

/// What bash offers for the last of `words`, one a line.
std::string bash_offers(const std::string& words) {
  const std::string script =
      "source <(\"$0\" completion bash); COMP_WORDS=(softgrain " + words +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _softgrain; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const ProcessResult result =
      softgrain::test::run({"/bin/bash", "--norc", "-u", "-c", script, SOFTGRAIN_PROGRAM});
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  return result.out;
}

ProcessResult completion(const std::string& shell) {
  return softgrain::test::run({SOFTGRAIN_PROGRAM, "completion", shell});
}

}  // namespace

TEST_CASE("bash completes verbs, the options of a verb and the keys of a case") {
  CHECK(bash_offers("res") == "resume\n");
  CHECK(bash_offers("run case.toml --st") == "--stop-after\n");
  CHECK(bash_offers("report run --st") == "\n");
  CHECK(bash_offers("run case.toml --set contact.fr") == "contact.friction=\n");
  CHECK(bash_offers("sweep case.toml --vary sample.s") == "sample.seed=\nsample.smallest_diameter=\n");
  CHECK(bash_offers("run ca") == "\n");  // then bash offers files
}

TEST_CASE("every key of a case is completed in every shell") {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const auto printed = completion(shell);
    CHECK(printed.exit_code == 0);
    for (const std::string& key : softgrain::key_names())
      CHECK_MESSAGE(printed.out.find(key) != std::string::npos, key);
  }
  CHECK(completion("csh").exit_code == 2);
}

TEST_CASE("bash takes its completion for complete, and bash reads the one of zsh without a syntax error") {
  const softgrain::test::TemporaryDirectory folder;
  const std::string bash = folder.file("bash", completion("bash").out);
  CHECK(softgrain::test::run({"/bin/bash", "-n", bash}).exit_code == 0);
  const auto registered =
      softgrain::test::run({"/bin/bash", "--norc", "-c", "source \"$0\"; complete -p softgrain", bash});
  CHECK(registered.out == "complete -o default -F _softgrain softgrain\n");
  CHECK(softgrain::test::run({"/bin/bash", "-n", folder.file("zsh", completion("zsh").out)}).exit_code == 0);
}

TEST_CASE("the manual page has every verb") {
  const std::string maker = std::string(SOFTGRAIN_SOURCE_DIR) + "/tools/man_page";
  const auto page = softgrain::test::run({"/usr/bin/python3", maker, SOFTGRAIN_PROGRAM});
  REQUIRE_MESSAGE(page.exit_code == 0, page.err);
  CHECK(page.out.starts_with(".TH SOFTGRAIN 1 "));
  for (const char* verb : {"new", "check", "run", "resume", "sweep", "export", "completion"})
    CHECK(page.out.find(std::string("\n.SS ") + verb + "\n") != std::string::npos);
  CHECK(page.out.find("\\-\\-stop\\-after") != std::string::npos);
}
