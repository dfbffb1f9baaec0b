#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/fclib.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "support/contact_problems.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

using Integers = std::vector<std::int64_t>;
using Reals = std::vector<double>;
using Datasets = std::map<std::string, std::variant<Reals, Integers>>;

FclibFile read(const Datasets& datasets) {
  Hdf5Writer writer("test");
  for (const auto& [path, values] : datasets) writer.write(path, {.columns = 1, .values = values});
  const TemporaryDirectory directory;
  return read_fclib(directory.file("problem.hdf5", std::string(writer.finish())));
}

/// Datasets of a matrix in CSparse's way.
void put_matrix(Datasets& datasets, const std::string& group, std::int64_t rows, std::int64_t columns,
                std::int64_t nz, const Integers& i, const Integers& p, const Reals& x) {
  datasets[group + "/m"] = Integers{rows};
  datasets[group + "/n"] = Integers{columns};
  datasets[group + "/nz"] = Integers{nz};
  datasets[group + "/nzmax"] = Integers{static_cast<std::int64_t>(x.size())};
  datasets[group + "/i"] = i;
  datasets[group + "/p"] = p;
  datasets[group + "/x"] = x;
}

/// Two contacts in 2D; W = [2 . . 5; . 3 . .; . 4 6 .; . . . 7] by triplets.
Datasets local_problem() {
  Datasets datasets{{"/fclib_local/spacedim", Integers{2}},
                    {"/fclib_local/vectors/mu", Reals{0.3, 0.4}},
                    {"/fclib_local/vectors/q", Reals{-1, 2, -3, 4}}};
  put_matrix(datasets, "/fclib_local/W", 4, 4, 6, {0, 0, 1, 2, 2, 3}, {0, 3, 1, 1, 2, 3}, {2, 5, 3, 4, 6, 7});
  return datasets;
}

const Eigen::Matrix4d W{{2, 0, 0, 5}, {0, 3, 0, 0}, {0, 4, 6, 0}, {0, 0, 0, 7}};

/// One contact in 2D between a body of inertia M and the ground.
Datasets global_problem() {
  Datasets datasets{{"/fclib_global/spacedim", Integers{2}},
                    {"/fclib_global/vectors/mu", Reals{0.3}},
                    {"/fclib_global/vectors/f", Reals{1, 2, 3}},
                    {"/fclib_global/vectors/w", Reals{0.5, -0.5}}};
  put_matrix(datasets, "/fclib_global/M", 3, 3, 5, {0, 0, 1, 1, 2}, {0, 1, 0, 1, 2}, {4, 1, 1, 3, 2});
  put_matrix(datasets, "/fclib_global/H", 3, 2, 4, {0, 2, 1, 2}, {0, 0, 1, 1}, {1, -1, 1, 0.5});
  return datasets;
}

/// The message with which a problem is refused after `damage`.
std::string refusal(Datasets datasets, const std::function<void(Datasets&)>& damage) {
  damage(datasets);
  try {
    read(datasets);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

bool mentions(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("triplets, compressed columns and compressed rows are the same matrix") {
  Datasets columns = local_problem(), rows = local_problem();
  put_matrix(columns, "/fclib_local/W", 4, 4, -1, {0, 1, 2, 2, 0, 3}, {0, 1, 3, 4, 6}, {2, 3, 4, 6, 5, 7});
  put_matrix(rows, "/fclib_local/W", 4, 4, -2, {0, 3, 1, 1, 2, 3}, {0, 2, 3, 5, 6}, {2, 5, 3, 4, 6, 7});
  for (const Datasets& datasets : {local_problem(), columns, rows}) {
    const ContactProblem problem = read(datasets).problem;
    CHECK(problem.dimension == 2);
    CHECK(problem.contacts() == 2);
    CHECK(dense_W(problem) == W);
    CHECK(problem.q == Reals{-1, 2, -3, 4});
    CHECK(problem.friction == Reals{0.3, 0.4});
  }
}

TEST_CASE("room that a matrix has allocated but not used is not read") {
  Datasets datasets = local_problem();
  put_matrix(datasets, "/fclib_local/W", 4, 4, 6, {0, 0, 1, 2, 2, 3, -77}, {0, 3, 1, 1, 2, 3, 99},
             {2, 5, 3, 4, 6, 7, std::nan("")});
  CHECK(dense_W(read(datasets).problem) == W);
}

TEST_CASE("a global problem becomes local by W = H^T M^-1 H and q = H^T M^-1 f + w") {
  const ContactProblem problem = read(global_problem()).problem;
  const Eigen::Matrix3d M{{4, 1, 0}, {1, 3, 0}, {0, 0, 2}};
  const Eigen::Matrix<double, 3, 2> H{{1, 0}, {0, 1}, {-1, 0.5}};
  CHECK((dense_W(problem) - H.transpose() * M.inverse() * H).norm() < 1e-14);
  const Eigen::Vector2d q =
      H.transpose() * M.inverse() * Eigen::Vector3d(1, 2, 3) + Eigen::Vector2d(0.5, -0.5);
  CHECK((vector_of(problem.q) - q).norm() < 1e-14);
}

TEST_CASE("a damaged problem is refused with the name of the dataset and what it should be") {
  const auto replaced = [](const std::string& path, std::variant<Reals, Integers> values) {
    return refusal(local_problem(), [&](Datasets& datasets) { datasets[path] = values; });
  };
  const std::string W_group = "/fclib_local/W";
  CHECK(mentions(replaced("/fclib_local/spacedim", Integers{4}),
                 "'/fclib_local/spacedim' is 4, must be 2 to 3"));
  CHECK(mentions(replaced("/fclib_local/spacedim", Reals{2}), "must hold integers"));
  CHECK(mentions(replaced("/fclib_local/spacedim", Integers{2, 2}), "holds 2 numbers, needs 1"));
  CHECK(mentions(replaced("/fclib_local/vectors/mu", Reals{0.3, -0.1}), "holds -0.1, must be >= 0"));
  CHECK(mentions(replaced("/fclib_local/vectors/mu", Reals{0.3, std::nan("")}), "has nan as its number 1"));
  CHECK(mentions(replaced("/fclib_local/vectors/mu", Reals{0.3}), "holds 4 numbers, needs 2"));
  CHECK(mentions(replaced("/fclib_local/vectors/q", Reals{1, 2, 3}),
                 "'/fclib_local/vectors/q' holds 3 numbers, needs 4"));
  CHECK(mentions(replaced("/fclib_local/vectors/q", Reals{1, 2, 3, INFINITY}), "has inf as its number 3"));
  CHECK(mentions(replaced(W_group + "/m", Integers{5}), "is 5, but the vectors need 4 rows"));
  CHECK(mentions(replaced(W_group + "/n", Integers{-4}), "is -4, must be 0 to"));
  CHECK(mentions(replaced(W_group + "/nz", Integers{-3}), "is -3, must be -2 to"));
  CHECK(mentions(replaced(W_group + "/nz", Integers{7}), "is 7, but 6 entries are stored"));
  CHECK(mentions(replaced(W_group + "/nz", Integers{1ll << 40}), "must be -2 to"));
  CHECK(mentions(replaced(W_group + "/i", Integers{0, 0, 1, 2, 2, 4}), "entry 5 at (4, 3), outside 4 x 4"));
  CHECK(mentions(replaced(W_group + "/p", Integers{0, 0, 1, -1, 2, 3}), "entry 3 at (2, -1), outside 4 x 4"));
  CHECK(mentions(replaced(W_group + "/x", Reals{2, 5, std::nan(""), 4, 6, 7}), "'/fclib_local/W/x' has nan"));
}

TEST_CASE("start pointers that lead nowhere are refused") {
  const auto pointers = [](const Integers& p) {
    return refusal(local_problem(), [&](Datasets& datasets) {
      put_matrix(datasets, "/fclib_local/W", 4, 4, -2, {0, 3, 1, 1, 2, 3}, p, {2, 5, 3, 4, 6, 7});
    });
  };
  CHECK(mentions(pointers({0, 2, 3, 6}), "'/fclib_local/W/p' holds 4 pointers, needs 5"));
  CHECK(mentions(pointers({1, 2, 3, 5, 6}), "must start with 0"));
  CHECK(mentions(pointers({0, 3, 2, 5, 6}), "pointers that decrease"));
  CHECK(mentions(pointers({0, 2, 3, 5, 1ll << 40}), "counts 1099511627776 entries, but 6 are stored"));
}

TEST_CASE("a dataset that is missing is named") {
  for (const auto& dataset : local_problem()) {
    const std::string& path = dataset.first;
    if (path.ends_with("nzmax")) continue;  // says nothing that the arrays do not
    CAPTURE(path);
    CHECK(mentions(refusal(local_problem(), [&](Datasets& datasets) { datasets.erase(path); }),
                   "'" + path + "' is missing"));
  }
  CHECK(mentions(refusal({{"/something", Reals{1}}}, [](Datasets&) {}),
                 "'/fclib_local' is missing, and '/fclib_global' too"));
}

TEST_CASE("global problems that cannot become local are refused") {
  const auto message = [](const std::function<void(Datasets&)>& damage) {
    return refusal(global_problem(), damage);
  };
  CHECK(mentions(message([](Datasets& d) { d["/fclib_global/M/x"] = Reals{1, 1, 1, 1, 2}; }), "is singular"));
  CHECK(mentions(message([](Datasets& d) {
                   d["/fclib_global/vectors/f"] = Reals{1, 2};
                 }),
                 "the vectors need 2 rows"));
  CHECK(mentions(message([](Datasets& d) {
                   d["/fclib_global/vectors/w"] = Reals{1, 2, 3};
                 }),
                 "holds 3 numbers, needs 2"));
  CHECK(mentions(message([](Datasets& d) { d["/fclib_global/vectors/b"] = Reals{1}; }),
                 "equality constraints"));
}

TEST_CASE("a problem with rolling friction is refused as one") {
  for (const char* path : {"/fclib_global_rolling/spacedim", "/fclib_local/vectors/mu_r"}) {
    CAPTURE(path);
    CHECK_THROWS_WITH_AS(read({{path, Integers{5}}}), doctest::Contains("rolling friction"), UsageError);
  }
}

TEST_CASE("what is no HDF5 file, or half of one, is the user's mistake") {
  const TemporaryDirectory directory;
  CHECK_THROWS_WITH_AS(read_fclib(directory.path() / "none"), doctest::Contains("no such file"), UsageError);
  CHECK_THROWS_WITH_AS(read_fclib(directory.file("text", "hello")), doctest::Contains("FCLIB"), UsageError);
  CHECK_THROWS_AS(read_fclib(directory.file("empty", "")), UsageError);
  CHECK_THROWS_AS(read_fclib(directory.path()), UsageError);
  const std::string whole =
      read_text(std::filesystem::path(SOFTGRAIN_TEST_DATA) / "contact" / "FrictionContactProblem00071.hdf5");
  for (const double part : {0.1, 0.5, 0.9})
    CHECK_THROWS_AS(
        read_fclib(directory.file(
            "half", whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))))),
        UsageError);
}

TEST_CASE("a problem that is written comes back with every entry, and its solution too") {
  const SolvedContactProblem solved{
      .problem = {.dimension = 2,
                  .W = {{0, 0, 2}, {3, 0, 5}, {1, 1, 3}, {2, 2, 6}, {1, 2, 4}, {3, 3, 7}},
                  .q = {-1, 2, -3, 4},
                  .friction = {0.3, 0.4}},
      .impulse = {0.5, 0.1, 0.5, -0.2}};
  const TemporaryDirectory directory;
  const auto path = directory.path() / "problem.hdf5";
  write_fclib(path, solved);
  const FclibFile file = read_fclib(path);
  CHECK(file.problem.q == solved.problem.q);
  CHECK(file.problem.friction == solved.problem.friction);
  CHECK(file.problem.dimension == 2);
  CHECK(file.stored_impulse == solved.impulse);
  Eigen::Matrix4d read = Eigen::Matrix4d::Zero(), written = read;
  for (const MatrixEntry& entry : file.problem.W) read(entry.row, entry.column) += entry.value;
  for (const MatrixEntry& entry : solved.problem.W) written(entry.row, entry.column) += entry.value;
  CHECK(read == written);
  const Eigen::Vector4d u = written * Eigen::Vector4d(0.5, 0.1, 0.5, -0.2) + Eigen::Vector4d(-1, 2, -3, 4);
  for (int k = 0; k < 4; ++k) CHECK(file.stored_velocity[k] == doctest::Approx(u[k]));
}
