#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

#include "softgrain/io/case/schema.hpp"
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

bool has(const std::string& shell) {
  if (softgrain::test::run({"/bin/sh", "-c", "command -v " + shell}).exit_code == 0) return true;
  MESSAGE(shell << " is not here, so this was not tried: tools/install_dependencies.sh --with shells");
  return false;
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
  CHECK(bash_offers("sweep case.toml --vary sample.s") ==
        "sample.seed=\nsample.sizes=\nsample.smallest_diameter=\nsample.shares=\n");
  CHECK(bash_offers("run ca") == "\n");  // then bash offers files
}

TEST_CASE("bash completes values where they can be listed, also behind =, at which it parts words") {
  CHECK(bash_offers("new x --template compaction-") == "compaction-bpm\ncompaction-mpm\n");
  CHECK(bash_offers("export run --to con") == "contacts\n");
  CHECK(bash_offers("plot run --format = p") == "png\npdf\n");
  CHECK(bash_offers("run case.toml --set experiment.model = m") == "mpm\n");
  CHECK(bash_offers("run case.toml --set experiment.model =") == "bpm\nmpm\nrigid\n");
  CHECK(bash_offers("run case.toml --set output.vtk = t") == "true\n");
  CHECK(bash_offers("sweep case.toml --column z_no") == "z_no_rattlers\n");
  CHECK(bash_offers("reproduce fig3 --scale q") == "quick\n");
  CHECK(bash_offers("sweep stat") == "status\n");
  CHECK(bash_offers("sweep case.toml --over phi") == "phi\nphi_0\n");
  CHECK(bash_offers("sweep case.toml --ret") == "--retry-failed\n");
  CHECK(bash_offers("completion fi") == "fish\n");
}

TEST_CASE("the columns that are offered are columns of a packing or of a grain") {
  const softgrain::test::TemporaryDirectory folder;
  std::string header;
  for (const std::string loading : {"compaction", "diametral"})
    for (const std::string model : {"mpm", "bpm", "metal", "cell", "space"}) {
      const std::string ends = model == "cell" ? "periodic" : "walls";
      const std::string out = (folder.path() / (loading + model)).string();
      softgrain::test::run({SOFTGRAIN_PROGRAM,
                            "run",
                            "/dev/null",
                            "-q",
                            "-o",
                            out,
                            "--set",
                            "experiment.loading=" + loading,
                            "--set",
                            "experiment.model=" + (model == "bpm" ? model : "mpm"),
                            "--set",
                            model == "metal" ? "mpm.law=von_mises" : "mpm.law=neo_hookean",
                            "--set",
                            model == "metal" ? "mpm.yield_stress=1e5" : "mpm.yield_stress=0",
                            "--set",
                            model == "cell" ? "sample.grains=12" : "sample.grains=4",
                            "--set",
                            model == "metal" ? "box.gravity_y=-9.81" : "box.gravity_y=0",
                            "--set",
                            "box.x=" + ends,
                            "--set",
                            "box.y=" + ends,
                            "--set",
                            "mpm.cells=2",
                            "--set",
                            model == "mpm" ? "contact.surface_energy=0.01" : "contact.surface_energy=0",
                            "--set",
                            model == "space" ? "experiment.dimension=3" : "experiment.dimension=2",
                            "--set",
                            "bpm.primaries=20",
                            "--set",
                            model == "space" ? "sample.packing_fraction=0.2" : "sample.packing_fraction=0.4",
                            "--stop-after",
                            "1 ms"});
      const std::string series = softgrain::test::read_text(out + "/series.csv");
      header += "," + series.substr(0, series.find('\n'));
    }
  std::istringstream offered(bash_offers("sweep case.toml --column \"\""));
  int columns = 0;
  for (std::string name; offered >> name; ++columns)
    CHECK_MESSAGE((header.find("," + name + ",") != std::string::npos ||
                   header.find("," + name + "[") != std::string::npos),
                  name);
  CHECK(columns > 20);
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

TEST_CASE("fish completes verbs, options and keys when it is there") {
  if (!has("fish")) return;
  const softgrain::test::TemporaryDirectory folder;
  const std::string file = folder.file("softgrain.fish", completion("fish").out);
  const auto offers = [&](const std::string& line) {
    const auto result = softgrain::test::run(
        {"/usr/bin/fish", "--no-config", "-c", "source " + file + "; complete -C '" + line + "'"},
        {{"HOME", folder.path().string()}}, folder.path().string());
    CHECK_MESSAGE(result.err.empty(), result.err);
    return result.out;
  };
  CHECK(offers("softgrain res").starts_with("resume\tGo on"));
  CHECK(offers("softgrain run case.toml --st").starts_with("--stop-after\t"));
  CHECK(offers("softgrain run case.toml --set contact.fr").starts_with("contact.friction="));
  CHECK(offers("softgrain sweep case.toml --vary sample.see").starts_with("sample.seed="));
  CHECK(offers("softgrain new x --template compaction-m").starts_with("compaction-mpm\t"));
  CHECK(offers("softgrain run case.toml --set experiment.model=m").starts_with("experiment.model=mpm\t"));
  CHECK(offers("softgrain completion fi") == "fish\n");
  CHECK(offers("softgrain sweep stat") == "status\n");
  CHECK(offers("softgrain sweep case.toml --over phi_").starts_with("phi_0"));
}

TEST_CASE("zsh completes verbs, options and keys when it is there") {
  if (!has("zsh")) return;
  const softgrain::test::TemporaryDirectory folder;
  // types a line with a tab at its end into a zsh of its own, where `softgrain` prints how it was called
  const std::string typist = folder.file("typist", R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'PS1=; stty -echo; autoload -Uz compinit; compinit -u -D; source '$1'; softgrain() { print "<$*>" }; print READ''Y'
zpty -r -m shell said '*READY*'
zpty -w shell "softgrain $2"$'\t'
zpty -r -m shell said '*<*>*'
print -r -- ${${said##*<}%%>*}
)");
  const std::string file = folder.file("softgrain.zsh", completion("zsh").out);
  const auto completed = [&](const std::string& line) {
    return softgrain::test::run({"/usr/bin/timeout", "60", "zsh", "-f", typist, file, line}).out;
  };
  CHECK(completed("res") == "resume\n");
  CHECK(completed("run case.toml --st") == "run case.toml --stop-after\n");
  CHECK(completed("run case.toml --set contact.fr") == "run case.toml --set contact.friction=\n");
  CHECK(completed("sweep case.toml --vary sample.see") == "sweep case.toml --vary sample.seed=\n");
  CHECK(completed("export run --to con") == "export run --to contacts\n");
  CHECK(completed("sweep stat") == "sweep status\n");
  CHECK(completed("run case.toml --set experiment.model=m") == "run case.toml --set experiment.model=mpm\n");
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
