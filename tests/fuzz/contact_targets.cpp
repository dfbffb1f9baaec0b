#include <string>

#include "fuzz/changes.hpp"
#include "fuzz/memory_file.hpp"
#include "fuzz/targets.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/format/fclib.hpp"
#include "softgrain/io/format/hdf5_file.hpp"

namespace softgrain::fuzz {
namespace {

using Datasets = std::map<std::string, Array>;

Array reals(std::vector<double> values) { return {1, std::move(values)}; }
Array whole(std::vector<std::int64_t> values) { return {1, std::move(values)}; }

void add_matrix(Datasets& datasets, const std::string& group, int storage) {
  datasets[group + "/m"] = datasets[group + "/n"] = whole({4});
  datasets[group + "/nz"] = whole({storage >= 0 ? 6 : storage});  // triplets, compressed columns or rows
  datasets[group + "/x"] = reals({2, 1, 1, 2, 3, 4});
  datasets[group + "/i"] = whole({0, 1, 1, 0, 2, 3});
  datasets[group + "/p"] = storage >= 0 ? whole({0, 1, 0, 1, 2, 3}) : whole({0, 2, 4, 5, 6});
}

/// Two contacts in the plane, one of FCLIB's two forms, one of its three kinds of storage.
Datasets small_problem(bool local, int storage) {
  const std::string group = local ? "/fclib_local" : "/fclib_global";
  Datasets datasets{{group + "/spacedim", whole({2})}, {group + "/vectors/mu", reals({0.3, 0.5})}};
  if (local) {
    datasets[group + "/vectors/q"] = reals({-1, 0.5, 0, -2});
    add_matrix(datasets, group + "/W", storage);
    datasets["/solution/u"] = reals({0, 0, 0, 0});
  } else {
    datasets[group + "/vectors/f"] = reals({1, -1, 0, 2});
    datasets[group + "/vectors/w"] = reals({0, 0, 1, 0});
    add_matrix(datasets, group + "/M", storage);
    add_matrix(datasets, group + "/H", storage);
  }
  return datasets;
}

std::string hdf5_file(const Datasets& datasets) {
  Hdf5Writer file("problem");
  for (const auto& [path, array] : datasets) file.write(path, array);
  return std::string(file.finish());
}

}  // namespace

void read_contact_problem(std::string_view bytes) {
  Bytes rest(bytes);
  const bool local = rest.below(2) == 0;
  Datasets datasets = small_problem(local, static_cast<int>(rest.below(3)) - 2);
  while (!rest.empty() && !datasets.empty()) change(datasets, rest);
  const MemoryFile file(hdf5_file(datasets));
  try {
    const ContactProblem problem = read_fclib(file.path()).problem;
    for (const ContactMethod method : {ContactMethod::nesterov, ContactMethod::nlgs})
      solve_contact_problem(problem, {.method = method, .tolerance = 1e-8, .max_sweeps = 30});
  } catch (const UsageError&) {
  }
}

}  // namespace softgrain::fuzz
