#include "softgrain/io/case/placement.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/io/case/sample_file.hpp"
#include "softgrain/io/format/file.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

std::string fault_in_words(const Case& c, const Misplaced& fault, const std::string& other) {
  const double share = fault.depth / c.sample.placed[fault.grain].radius;
  if (fault.other < 0)
    return fmt::format(
        "the grain reaches {:.3g} of its radius out of the box, whose corner is (0, 0{}), box.width {:.6g} "
        "m{} "
        "and box.height {:.6g} m; at most {} are allowed: move it, or leave width{} and height out for a box "
        "round all grains",
        share, is_in_space(c) ? ", 0" : "", c.box.width,
        is_in_space(c) ? fmt::format(", box.depth {:.6g} m", c.box.depth) : "", c.box.height,
        largest_placed_overlap, is_in_space(c) ? ", depth" : "");
  return fmt::format(
      "the grain overlaps that of {} by {:.3g} of its radius; at most {} of the smaller radius are allowed: "
      "move "
      "one of them, or make it smaller",
      other, share, largest_placed_overlap);
}

}  // namespace

std::string read_limited(const std::string& path, const char* what) {
  constexpr std::size_t largest = 1'000'000;
  std::string text;
  try {
    text = read_beginning(path, largest + 1);
  } catch (const IoError& error) {
    throw UsageError(error.what());
  }
  require(text.size() <= largest, "{} is larger than 1 MB: not {}", path, what);
  return text;
}

PlacedLines place_grains(const FormReader& forms, CaseDraft& draft, std::vector<Source>& sources) {
  if (forms.sample_file().empty()) return {};
  const Origin origin = forms.sample_file_origin();
  Case::Sample& sample = draft.the_case.sample;
  if (draft.origins.contains("sample.placed"))
    return draft.add(origin, "sample.file and sample.placed both place the grains: give one of them"),
           PlacedLines{};
  fs::path path = forms.sample_file();
  if (origin.set < 0) path = fs::path(sources.front().name).parent_path() / path;
  try {
    std::error_code unknown;
    require(!fs::exists(path, unknown) || fs::is_regular_file(path, unknown), "{} is not a file",
            path.string());
    sources.push_back({path.string(), read_limited(path.string(), "a sample's file")});
  } catch (const UsageError& error) {
    return draft.add(origin, fmt::format("sample.file: {}", error.what())), PlacedLines{};
  }
  SampleText text =
      read_sample_text(sources.back().text, forms.kind_names(), draft.the_case.experiment.dimension);
  const int source = static_cast<int>(sources.size()) - 1;
  for (const SampleIssue& issue : text.issues) draft.add({.at = issue.at, .source = source}, issue.message);
  sample.placed = std::move(text.grains);
  sample.placed_z = std::move(text.z);
  draft.origins["sample.placed"] = origin;
  if (!text.issues.empty()) draft.invalid.insert("sample.placed");
  return {text.lines, source};
}

void check_heights(CaseDraft& draft) {
  Case::Sample& sample = draft.the_case.sample;
  if (!is_in_space(draft.the_case) || sample.placed.size() == sample.placed_z.size()) return;
  if (draft.is_valid("sample.placed"))
    draft.add(draft.origins["sample.placed"],
              fmt::format("sample.placed_z must have a z for each of sample.placed: {} for {}; write "
                          "sample.file, which has all",
                          sample.placed_z.size(), sample.placed.size()));
  sample.placed.clear();
  sample.placed_z.clear();
}

void check_placement(CaseDraft& draft, const PlacedLines& lines) {
  const Case& c = draft.the_case;
  if (c.sample.placed.empty() || !draft.is_valid("sample.placed")) return;
  constexpr std::size_t most = 20;
  std::vector<Misplaced> faults =
      is_in_space(c) ? misplaced_grains(sample_solid_box(c)) : misplaced_grains(sample_box(c));
  if (faults.size() > most) faults.resize(most);
  for (const Misplaced& fault : faults) {
    if (lines.line.empty())
      draft.add(draft.origins["sample.placed"],
                fmt::format("grain {}: {}", fault.grain + 1,
                            fault_in_words(c, fault, fmt::format("number {}", fault.other + 1))));
    else
      draft.add(
          {.at = {lines.line[fault.grain], 1}, .source = lines.source},
          fault_in_words(c, fault, fault.other < 0 ? "" : fmt::format("line {}", lines.line[fault.other])));
  }
}

}  // namespace softgrain
