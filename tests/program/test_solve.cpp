#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/io/format/fclib.hpp"
#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

const std::string folder = SOFTGRAIN_TEST_DATA "/contact/";
const std::string small = folder + "FrictionContactProblem00071.hdf5";

ProcessResult solve(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {SOFTGRAIN_PROGRAM, "solve"});
  return run(arguments);
}

}  // namespace

TEST_CASE("solve converges on all problems by default and says so as JSON") {
  struct Problem {
    const char* name;
    int contacts, dimension;
  };
  for (const Problem& problem :
       {Problem{"FrictionContactProblem00071", 89, 2}, Problem{"FrictionContactProblem00237", 376, 2},
        Problem{"fc2d_granularflowonwall_02020_00213", 2020, 2}, Problem{"local_problem_test", 48, 3},
        Problem{"LMGC_100_PR_PerioBox-i00361-60-03000", 60, 3}, Problem{"Box_Stacks-i0122-82-5", 82, 3}}) {
    CAPTURE(problem.name);
    const std::string file = folder + problem.name + ".hdf5";
    const ProcessResult result = solve({file, "--json"});
    CHECK(result.exit_code == 0);
    CHECK(result.err.empty());
    const auto json = nlohmann::json::parse(result.out);
    CHECK(json.at("file") == file);
    // where Gauss-Seidel that starts ahead is there first
    CHECK(json.at("method") == (problem.name == std::string("local_problem_test") ? "nlgs" : "nesterov"));
    CHECK(json.at("contacts") == problem.contacts);
    CHECK(json.at("dimension") == problem.dimension);
    CHECK(json.at("sweeps") > 10);
    CHECK(json.at("natural_map_residual") <= 1e-8);
    CHECK(json.at("energy") < 0);
    CHECK(json.at("cpu_seconds") > 0);
    CHECK(json.at("converged") == true);
    CHECK(json.at("tolerance") == 1e-8);
  }
}

TEST_CASE("solve shows a table to people") {
  const ProcessResult result = solve({small, "--method", "nlgs", "--tolerance", "1e-5"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("89 contacts in 2D") != std::string::npos);
  CHECK(result.out.find("nlgs, 30 sweeps") != std::string::npos);
  CHECK(result.out.find("converged to 1e-05") != std::string::npos);
}

TEST_CASE("solve writes impulses and velocities beside the problem, and what is read back is the solution") {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "solution.hdf5").string();
  const ProcessResult result = solve({small, "-o", file, "--json"});
  REQUIRE(result.exit_code == 0);
  const FclibFile written = read_fclib(file), original = read_fclib(small);
  CHECK(written.problem.q == original.problem.q);
  CHECK(written.problem.friction == original.problem.friction);
  // u = W r + q with the W of the problem that was given, and the residual that was printed
  std::vector<double> u = original.problem.q;
  REQUIRE(written.stored_impulse.size() == u.size());
  for (const MatrixEntry& entry : original.problem.W)
    u[entry.row] += entry.value * written.stored_impulse[entry.column];
  for (std::size_t k = 0; k < u.size(); ++k)
    CHECK(written.stored_velocity[k] == doctest::Approx(u[k]).epsilon(1e-9));
  const double residual = assess_impulses({original.problem, written.stored_impulse}, 1).residual;
  CHECK(residual ==
        doctest::Approx(nlohmann::json::parse(result.out).at("natural_map_residual")).epsilon(1e-3));

  CHECK(solve({file, "-o", file}).exit_code == 2);  // never over the problem
  CHECK(solve({small, "-o", (directory.path() / "no/such/folder.hdf5").string()}).exit_code == 4);
}

TEST_CASE("solve that does not converge ends with exit code 3 and prints what it has") {
  const ProcessResult result = solve({small, "--max-sweeps", "7", "--json"});
  CHECK(result.exit_code == 3);
  const auto json = nlohmann::json::parse(result.out);
  CHECK(json.at("converged") == false);
  CHECK(json.at("sweeps") == 7);
  CHECK(json.at("natural_map_residual") > 1e-8);
}

TEST_CASE("solve refuses wrong arguments and files with exit code 2") {
  CHECK(solve({small, "--method", "newton"}).exit_code == 2);
  CHECK(solve({small, "--tolerance", "-1"}).exit_code == 2);
  CHECK(solve({small, "--tolerance", "nan"}).exit_code == 2);
  CHECK(solve({small, "--max-sweeps", "-1"}).exit_code == 2);
  CHECK(solve({}).exit_code == 2);
  const ProcessResult text = solve({folder + "README.md"});
  CHECK(text.exit_code == 2);
  CHECK(text.out.empty());
  CHECK(text.err.find("README.md: not an HDF5 file") != std::string::npos);
  CHECK(text.err.find("HDF5-DIAG") == std::string::npos);
}
