#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace softgrain {

/// viewer/dist/report_template.html, built into the program.
extern const std::string_view report_template;

/// The template with a title and with the payloads of runs (`encode_run`) in the places marked for them.
std::string report_text(std::string_view page, const std::string& title,
                        const std::vector<std::string>& payloads);

/// Writes one self-contained page of all runs, whole or not at all. Returns warnings: snapshots that are
/// damaged and left out. Raises UsageError when a directory holds no run, IoError when the page cannot be
/// written.
std::vector<std::string> write_report(const std::vector<std::filesystem::path>& runs,
                                      const std::filesystem::path& page);

}  // namespace softgrain
