#pragma once
#include <string>
#include <vector>

#include "softgrain/io/run/run_directory.hpp"

namespace softgrain {

/// What a page holds of one run.
struct ReportRun {
  std::string payload;     ///< gzip of: size of the header (32 bit, little endian), JSON header, planes
  std::size_t frames = 0;  ///< snapshots shown
  std::vector<std::string> warnings;  ///< one for each snapshot that was left out because it is damaged
};

/// How much a page may hold before it is thinned: material points are merged further, primaries are
/// shown at fewer times, as surfaces in space are, whose fields come down to the pressure; weak contacts and
/// rows of the series are left out.
struct ReportLimits {
  double particles = 14e6;  ///< or vertices in space, times frames
  double fields = 2e6;      ///< vertices in space, times frames: beyond, of their fields the pressure alone
  double contacts = 3e6;    ///< in all frames
  double rows = 4000;       ///< of the series
};

/// Reads a run's directory. `name` is what the page calls it. Raises UsageError, with what to do about it,
/// when the directory holds no run or no snapshot that can be shown.
ReportRun encode_run(const RunPaths& paths, const std::string& name, const ReportLimits& limits = {});

}  // namespace softgrain
