#include "softgrain/io/run/run_json.hpp"

#include <libdeflate.h>
#include <sys/resource.h>
#include <unistd.h>
#include <xxhash.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/core/version.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/run/verdict.hpp"

namespace softgrain {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view format_name = "softgrain-run";
constexpr int format_version = 1;

rusage usage() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used;
}

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": "), line.size() - 2) + 2);
  return "unknown";
}

Json program() {
  const BuildInfo build = build_info();
  return {{"version", build.version},
          {"commit", build.commit},
          {"compiler", build.compiler},
          {"flags", build.flags}};
}

Json libraries() {
  return {{"hdf5", hdf5_version()},
          {"libdeflate", LIBDEFLATE_VERSION_STRING},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)},
          {"xxhash", fmt::format("{}.{}.{}", XXH_VERSION_MAJOR, XXH_VERSION_MINOR, XXH_VERSION_RELEASE)}};
}

/// What is neither shared nor exchanged, all ranks do alike.
Json json_of(const RankRecord& record) {
  const Communicator& all = communicator();
  const SharingAccount& account = all.account;
  const double shared = record.cpu_shared.mean * all.ranks();
  return {{"count", all.ranks()},
          {"hosts", all.hosts()},
          {"exchanges", account.exchanges},
          {"messages_by_first", account.messages},
          {"bytes_sent_by_first", account.bytes_sent},
          {"bytes_received_by_first", account.bytes_received},
          {"cpu_shared", shared},
          {"cpu_exchanges", record.cpu_exchanges},
          {"cpu_alike", record.cpu_all - shared - record.cpu_exchanges},
          {"imbalance", record.cpu_shared.largest_over_mean()},
          {"peak_memory_bytes_mean", record.memory.mean},
          {"peak_memory_bytes_largest", record.memory.largest}};
}

Json machine() {
  return {{"host", host_name()},
          {"cpu", cpu_name()},
          {"threads", threads()},
          {"peak_memory_bytes", peak_memory()}};
}

}  // namespace

std::vector<std::string> command_line() {
  std::ifstream file("/proc/self/cmdline");
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

double cpu_seconds() {
  const rusage used = usage();
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

std::int64_t peak_memory() {
  constexpr std::int64_t kibibyte = 1024;
  return usage().ru_maxrss * kibibyte;
}

namespace {

Json json_of(const RunOrigin& origin) {
  return {{"directory", origin.directory},
          {"snapshot", origin.snapshot},
          {"content_hash", origin.content_hash},
          {"command", origin.command}};
}

}  // namespace

std::string encode_run_record(const RunRecord& record) {
  const RunReport& report = record.report;
  const Verdict verdict = verdict_of(report, record.path);
  Json origins = Json::array();
  for (const RunOrigin& origin : record.origins) origins.push_back(json_of(origin));
  Json json = {
      {"format", format_name},
      {"version", format_version},
      {"state", record.state},
      {"message", record.message},
      {"verdict", verdict.words},
      {"doubts", verdict.doubts},
      {"path_completed", record.state == "done" && record.path.completed},
      {"command", record.command},
      {"begun_from", origins},
      {"started", record.started},
      {"updated", utc_now()},
      {"resumes", record.resumes},
      {"seed", record.seed},
      {"step", record.step},
      {"steps_planned", record.steps_planned},
      {"time", record.time},
      {"progress", record.progress},
      {"wall_seconds", record.wall_seconds},
      {"cpu_seconds", record.cpu_seconds},
      {"report",
       {{"steps", report.steps},
        {"steps_converged", report.steps_converged},
        {"sweeps", report.sweeps},
        {"residual_max", report.residual_max},
        {"residual_limit", report.residual_limit},
        {"overlap_max", report.overlap_max},
        {"energy_error", report.energy.error},
        {"energy_scale", report.energy.scale}}},
      {"program", program()},
      {"libraries", libraries()},
      {"machine", machine()},
  };
  if (communicator().ranks() > 1) json["ranks"] = json_of(record.ranks);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunRecord read_run_record(const std::filesystem::path& path) {
  try {
    const Json json = Json::parse(read_file(path));
    if (json.at("format") != format_name) throw IoError("it has another format");
    RunRecord record;
    record.command = json.at("command").get<std::vector<std::string>>();
    for (const Json& origin : json.value("begun_from", Json::array()))
      record.origins.push_back({origin.at("directory"), origin.at("snapshot"), origin.at("content_hash"),
                                origin.at("command").get<std::vector<std::string>>()});
    record.started = json.at("started");
    record.resumes = json.at("resumes");
    record.state = json.at("state");
    record.step = json.at("step");
    return record;
  } catch (const std::exception& error) {
    throw IoError(fmt::format("{}: not a run.json: {}", path.string(), error.what()));
  }
}

}  // namespace softgrain
