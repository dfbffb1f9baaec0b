#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "python_program.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/core/version.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "verbs.hpp"

namespace softgrain {
namespace {

/// One line of the report. A problem comes with its remedy.
struct Finding {
  std::string subject;
  std::string value;
  std::string problem;
};

/// Output of a command without its last newline; "" when it fails.
std::string output_of(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  std::array<char, 256> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    text.append(block.data(), n);
  const bool succeeded = pclose(pipe) == 0;
  while (text.ends_with('\n')) text.pop_back();
  return succeeded ? text : "";
}

/// The value of a line "name : value" of /proc/cpuinfo.
std::string cpu_info(std::string_view name) {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with(name) && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

Finding instruction_set() {
  const std::string flags = " " + cpu_info("flags") + " ";
  std::string found;
  for (const std::string name : {"avx2", "fma", "avx512f"})
    if (flags.find(" " + name + " ") != std::string::npos) found += (found.empty() ? "" : " ") + name;
  const bool fits = flags.find(" avx2 ") != std::string::npos && flags.find(" fma ") != std::string::npos;
  return {"instructions", found, fits ? "" : "no AVX2: build with -DSOFTGRAIN_ARCH=native"};
}

Finding python() {
  const std::string versions =
      output_of("'" + python_interpreter() +
                "' -c 'import sys, numpy, matplotlib, h5py; print(f\"{sys.version.split()[0]}, "
                "matplotlib {matplotlib.__version__}, h5py {h5py.__version__}\")'");
  return {"python", versions.empty() ? python_interpreter() + ": matplotlib or h5py is missing" : versions,
          versions.empty() ? "plots need them: apt-get install python3-matplotlib python3-h5py" : ""};
}

Finding python_module() {
  for (const std::filesystem::path& path : python_paths()) {
    const std::string found =
        output_of(fmt::format("PYTHONPATH='{}' '{}' -c 'import softgrain._core as c; print(c.__file__)'",
                              path.string(), python_interpreter()));
    if (!found.empty()) return {"python module", found, ""};
  }
  return {"python module", "not there",
          "simulations in Python need it: apt-get install python3-dev pybind11-dev, then configure and build "
          "again"};
}

Finding disk() {
  std::error_code failed;
  const auto space = std::filesystem::space(".", failed);
  if (failed) return {"disk", "unknown", failed.message()};
  const double gigabytes = static_cast<double>(space.available) / 1e9;
  return {"disk", fmt::format("{:.1f} GB free here", gigabytes), gigabytes < 1 ? "a run may need 1 GB" : ""};
}

std::vector<Finding> findings() {
  const BuildInfo build = build_info();
  return {{"version", fmt::format("{} ({})", build.version, build.commit), ""},
          {"compiler", build.compiler, ""},
          {"flags", build.flags, ""},
          {"cpu", cpu_info("model name"), ""},
          instruction_set(),
          {"threads", fmt::format("{}", threads()), ""},
          {"hdf5", hdf5_version(), ""},
          python(),
          python_module(),
          disk()};
}

void examine(bool json) {
  nlohmann::ordered_json report;
  for (const Finding& finding : findings()) {
    const bool ok = finding.problem.empty();
    report[finding.subject] = {{"ok", ok}, {"value", finding.value}, {"problem", finding.problem}};
    if (!json)
      fmt::print("{:8} {:13} {}{}\n", ok ? "ok" : "problem", finding.subject, finding.value,
                 ok ? "" : "; " + finding.problem);
  }
  if (json) fmt::print("{}\n", report.dump(2));
}

}  // namespace

void add_doctor_verb(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand("doctor", "Check this installation and report what is missing");
  verb->add_flag("--json", *json, "as JSON");
  verb->footer("Example:\n  softgrain doctor    to be pasted into a bug report");
  verb->callback([json] { examine(*json); });
}

}  // namespace softgrain
