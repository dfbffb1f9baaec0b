// The only file that knows MPI; part of softgrain-mpi alone.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

using Clock = std::chrono::steady_clock;

/// How often a rank looks whether an exchange is over before it sleeps between two looks: some 0.1 ms. Not at
/// all where ranks wait for one another's cores.
constexpr int looks_before_sleep = 1000;
constexpr int shortest_sleep = 20, longest_sleep = 500;  // [us]

/// How long an exchange may take at most: SOFTGRAIN_WATCHDOG in s, or 10 min.
std::chrono::seconds longest_wait() {
  constexpr int seconds = 600;
  const char* wish = std::getenv("SOFTGRAIN_WATCHDOG");
  const int wanted = wish != nullptr ? std::atoi(wish) : 0;
  return std::chrono::seconds(wanted > 0 ? wanted : seconds);
}

/// Counts what all ranks exchange, or messages to single ones, and their CPU time.
class Timed {
 public:
  explicit Timed(SharingAccount& account) : account_(account) {}
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;
  ~Timed() { account_.cpu_exchanges += process_seconds() - begin_; }

 private:
  SharingAccount& account_;
  double begin_ = process_seconds();
};

/// Ranks of MPI_COMM_WORLD. An error of MPI ends all of them.
class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator(int& argc, char**& argv) {
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
    MPI_Comm on_host = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &on_host);
    MPI_Comm_size(on_host, &ranks_on_host_);
    MPI_Comm_free(&on_host);
    if (ranks_on_host_ <= sysconf(_SC_NPROCESSORS_ONLN)) looks_ = looks_before_sleep;
    find_hosts();
  }

  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }
  int ranks_on_host() const override { return ranks_on_host_; }

  std::vector<std::string> hosts() const override { return hosts_; }

  void gather(std::span<std::byte> all, std::span<const std::size_t> begin) override {
    const Timed timed(account);
    ++account.exchanges;
    constexpr std::size_t most = 1U << 30U;  // MPI 3 counts in int
    if (all.size() > most)
      throw NumericalError(fmt::format(
          "ranks exchange {} bytes at once, more than {}: the packing is too large for this version",
          all.size(), most));
    std::vector<int> count, displacement;
    for (int r = 0; r < ranks_; ++r) {
      count.push_back(static_cast<int>(begin[r + 1] - begin[r]));
      displacement.push_back(static_cast<int>(begin[r]));
    }
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all.data(), count.data(), displacement.data(),
                    MPI_BYTE, MPI_COMM_WORLD, &request);
    wait_for(request);
    account.bytes_sent += count[rank_];
    account.bytes_received += static_cast<std::int64_t>(begin[ranks_]) - count[rank_];
  }

  void swap(std::span<const Parcel> parcels) override {
    if (parcels.empty()) return;
    const Timed timed(account);
    std::vector<MPI_Request> requests;
    for (const Parcel& parcel : parcels) {
      const auto send = static_cast<int>(parcel.out.size()), receive = static_cast<int>(parcel.in.size());
      MPI_Request& request = requests.emplace_back(MPI_REQUEST_NULL);
      if (send > 0)
        MPI_Isend(parcel.out.data(), send, MPI_BYTE, parcel.rank, parcel.label, MPI_COMM_WORLD, &request);
      else if (receive > 0)
        MPI_Irecv(parcel.in.data(), receive, MPI_BYTE, parcel.rank, parcel.label, MPI_COMM_WORLD, &request);
      account.messages += send > 0 ? 1 : 0;
      account.bytes_sent += send;
      account.bytes_received += receive;
    }
    for (MPI_Request& request : requests) wait_for(request);
  }

  std::int64_t largest(std::int64_t number) override {
    const Timed timed(account);
    ++account.exchanges;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(MPI_IN_PLACE, &number, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD, &request);
    wait_for(request);
    return number;
  }

  double sum(double number) override {
    const Timed timed(account);
    ++account.exchanges;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(MPI_IN_PLACE, &number, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD, &request);
    wait_for(request);
    return number;
  }

  bool wait_for_all() override {
    constexpr std::chrono::seconds patience(10);
    MPI_Request all_here = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &all_here);
    return ends_within(all_here, patience);
  }

  void leave(bool all_are_here, int exit_code) override {
    if (!all_are_here) MPI_Abort(MPI_COMM_WORLD, exit_code);
    MPI_Finalize();
  }

 private:
  bool ends_within(MPI_Request& request, std::chrono::seconds most) const {
    const auto begin = Clock::now();
    int sleep = shortest_sleep;
    for (int look = 0, done = 0;; ++look) {
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      if (done != 0) return true;
      if (look < looks_) continue;
      usleep(sleep);
      sleep = std::min(longest_sleep, sleep + sleep / 4);
      if (Clock::now() - begin > most) return false;
    }
  }

  /// A rank that has lost the others asks to be started again. mpirun or srun then end the others.
  void wait_for(MPI_Request& request) const {
    if (ends_within(request, longest_wait_)) return;
    constexpr int requeue = 75;
    const std::string text = "error: ranks have not heard from one another for longer than " +
                             std::to_string(longest_wait_.count()) + " s (SOFTGRAIN_WATCHDOG)\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    _exit(requeue);
  }

  void find_hosts() {
    constexpr std::size_t longest = MPI_MAX_PROCESSOR_NAME;
    std::vector<char> own(longest), names(ranks_ * longest);
    int length = 0;
    MPI_Get_processor_name(own.data(), &length);
    MPI_Allgather(own.data(), longest, MPI_CHAR, names.data(), longest, MPI_CHAR, MPI_COMM_WORLD);
    for (int r = 0; r < ranks_; ++r) {
      const std::string host(&names[r * longest]);
      if (std::find(hosts_.begin(), hosts_.end(), host) == hosts_.end()) hosts_.push_back(host);
    }
  }

  int rank_ = 0, ranks_ = 1, ranks_on_host_ = 1, looks_ = 0;
  std::chrono::seconds longest_wait_ = longest_wait();
  std::vector<std::string> hosts_;
};

}  // namespace

std::unique_ptr<Communicator> mpi_communicator(int& argc, char**& argv) {
  return std::make_unique<MpiCommunicator>(argc, argv);
}

}  // namespace softgrain
