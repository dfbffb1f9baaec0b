#include "softgrain/io/page/report_page.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/page/report_codec.hpp"
#include "softgrain/io/page/report_run.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t named_in_title = 2;  ///< runs; the others are counted
constexpr std::string_view title_mark = "<!--title-->", runs_mark = "<!--runs-->";

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '<')
      html += "&lt;";
    else if (c == '&')
      html += "&amp;";
    else
      html += c;
  }
  return html;
}

/// "squeeze" for out/squeeze, "squeeze/case_run" for the directory that everybody's run has by default; the
/// whole path where another run has the same name.
std::string name_of(const fs::path& run, const std::vector<fs::path>& runs) {
  const auto last = [](const fs::path& path) {
    fs::path whole = fs::absolute(path).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();
    const fs::path name = whole.filename();
    return name == "case_run" ? whole.parent_path().filename() / name : name;
  };
  const auto alike = [&](const fs::path& other) { return last(other) == last(run); };
  return (std::count_if(runs.begin(), runs.end(), alike) > 1 ? run : last(run)).string();
}

}  // namespace

std::string report_text(std::string_view page, const std::string& title,
                        const std::vector<std::string>& payloads) {
  const auto title_at = page.find(title_mark), runs_at = page.find(runs_mark);
  assert(title_at < runs_at && runs_at != std::string_view::npos);
  std::string text(page.substr(0, title_at));
  text += escaped(title);
  text += page.substr(title_at + title_mark.size(), runs_at - title_at - title_mark.size());
  for (const std::string& payload : payloads)
    text += "<script type=\"application/octet-stream\" class=\"run\">" + base64(payload) + "</script>\n";
  text += page.substr(runs_at + runs_mark.size());
  return text;
}

std::vector<std::string> write_report(const std::vector<fs::path>& runs, const fs::path& page) {
  std::vector<std::string> payloads, warnings;
  std::string title;
  for (const fs::path& directory : runs) {
    const std::string name = name_of(directory, runs);
    ReportRun run = encode_run(RunPaths{directory}, name);
    payloads.push_back(std::move(run.payload));
    warnings.insert(warnings.end(), run.warnings.begin(), run.warnings.end());
    if (payloads.size() <= named_in_title) title += (title.empty() ? "" : ", ") + name;
  }
  if (runs.size() > named_in_title) title += fmt::format(" and {} more", runs.size() - named_in_title);
  write_file(page, report_text(report_template, title, payloads), Survives::kill);
  return warnings;
}

}  // namespace softgrain
