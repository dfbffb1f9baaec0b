#include <array>
#include <memory>
#include <stdexcept>
#include <string>

#include "fuzz/changes.hpp"
#include "fuzz/memory_file.hpp"
#include "fuzz/targets.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/run/run_json.hpp"
#include "softgrain/io/run/series_writer.hpp"
#include "support/temporary_directory.hpp"

namespace softgrain::fuzz {
namespace {

/// A small simulation after a few steps, and its snapshot.
struct Subject {
  std::unique_ptr<Simulation> simulation;
  Snapshot snapshot;
};

Subject subject(const std::string& settings) {
  Subject result;
  result.snapshot.case_text = settings;
  result.simulation = create_simulation(parse_case(settings, "subject"));
  for (int step = 0; step < 3; ++step) result.simulation->step();
  result.snapshot.checkpoint = result.simulation->checkpoint();
  result.snapshot.scene = result.simulation->scene();
  return result;
}

const std::string box = "[sample]\ngrains = 2\npacking_fraction = 0.5\n[bpm]\nprimaries = 7\nlibrary = 1\n";
const std::array<std::string, 5> cases{
    "bpm.primaries = 7\n",
    "experiment.model = \"mpm\"\nmpm.cells = 2\n",
    "experiment.model = \"mpm\"\nmpm = {cells = 3, formulation = \"updated_lagrangian\"}\n",
    "experiment.loading = \"compaction\"\n" + box,
    "experiment = {loading = \"compaction\", model = \"mpm\"}\nmpm.cells = 2\n" + box,
};

bool same(const std::map<std::string, Array>& a, const std::map<std::string, Array>& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
    const auto bytes = [](const Array& array) {
      return std::visit(
          [](const auto& v) {
            return std::string_view(reinterpret_cast<const char*>(v.data()), v.size() * sizeof v[0]);
          },
          array.values);
    };
    return x.first == y.first && x.second.values.index() == y.second.values.index() &&
           bytes(x.second) == bytes(y.second);
  });
}

}  // namespace

void read_snapshot_file(std::string_view bytes) {
  try {
    decode_snapshot(bytes, "bytes");
  } catch (const IoError&) {
  }
  Bytes rest(bytes);
  static std::array<Subject, cases.size()> subjects;
  const std::size_t which = rest.below(cases.size());
  Subject& changed = subjects[which];
  if (changed.simulation == nullptr) changed = subject(cases[which]);
  Snapshot snapshot = changed.snapshot;
  while (!rest.empty() && !snapshot.checkpoint.arrays.empty()) change(snapshot.checkpoint.arrays, rest);
  const Snapshot again = decode_snapshot(encode_snapshot(snapshot, "snapshot"), "snapshot");
  if (!same(again.checkpoint.arrays, snapshot.checkpoint.arrays))
    throw std::logic_error("a snapshot does not hold what was put into it");
  try {
    changed.simulation->restore(again.checkpoint);
  } catch (const IoError&) {
  } catch (const NumericalError&) {  // places too far away for any arithmetic
  }
}

void read_series(std::string_view bytes) {
  Bytes rest(bytes);
  const auto step = rest.take<std::int16_t>();
  const MemoryFile file(bytes.substr(std::min<std::size_t>(2, bytes.size())));
  rewind_series(file.path(), step);
  const std::string kept = test::read_text(file.path());
  if (!kept.empty() && kept.back() != '\n') throw std::logic_error("a rewound series has a torn line");
  rewind_series(file.path(), step);
  if (test::read_text(file.path()) != kept) throw std::logic_error("a series is not rewound at once");
  read_last_row(file.path());
  SeriesWriter(file.path());
}

void read_record(std::string_view bytes) {
  const MemoryFile file(bytes);
  try {
    read_run_record(file.path());
  } catch (const IoError&) {
  }
}

}  // namespace softgrain::fuzz
