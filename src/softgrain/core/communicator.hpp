#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace softgrain {

/// What sharing a run costs this rank, so far. CPU time that is neither shared nor of exchanges is spent on
/// what all ranks do alike.
struct SharingAccount {
  std::int64_t exchanges = 0;       ///< in which all ranks took part
  std::int64_t messages = 0;        ///< to single ranks
  std::int64_t bytes_sent = 0;      ///< to each other rank, or in messages to single ones
  std::int64_t bytes_received = 0;  ///< from all of them
  double cpu_exchanges = 0;         ///< CPU time of them, waiting included [s]
  double cpu_shared = 0;            ///< CPU time of this rank's share of shared loops [s]
};

/// A message between two ranks: what goes out to the other one, or what comes in from it.
struct Parcel {
  int rank = 0;   ///< the other one
  int label = 0;  ///< the same on both sides; different in all parcels that are on their way at once
  std::span<const std::byte> out{};
  std::span<std::byte> in{};
};

/// The processes that share one run, its ranks 0 .. ranks - 1. Those of a program that knows no MPI are one.
/// All ranks make the same calls in the same order.
class Communicator {
 public:
  Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  virtual ~Communicator() = default;

  virtual int rank() const { return 0; }
  virtual int ranks() const { return 1; }
  virtual int ranks_on_host() const { return 1; }
  virtual std::vector<std::string> hosts() const { return {}; }  ///< that have ranks

  /// Bytes begin[r] .. begin[r + 1] - 1 of `all` are those of rank r: in all ranks when it returns.
  virtual void gather(std::span<std::byte> /*all*/, std::span<const std::size_t> /*begin*/) {}
  /// Sends and receives these, and returns when all are where they should be. Whoever is named by another
  /// rank names that one too, with the same number of bytes.
  virtual void swap(std::span<const Parcel> /*parcels*/) {}
  /// The largest of all ranks' numbers; the sum.
  virtual std::int64_t largest(std::int64_t number) { return number; }
  virtual double sum(double number) { return number; }
  /// Before the process ends: true when all ranks are here, false if one is not within 10 s. Then leave.
  virtual bool wait_for_all() { return true; }
  /// Without all ranks here this ends them all with the exit code.
  virtual void leave(bool /*all_are_here*/, int /*exit_code*/) {}

  SharingAccount account;
};

/// Of this process: alone, until another is put in its place.
Communicator& communicator();
void use_communicator(std::unique_ptr<Communicator> communicator);

/// MPI's, of the program softgrain-mpi; called once, at its start.
std::unique_ptr<Communicator> mpi_communicator(int& argc, char**& argv);

/// Does work() on all ranks, or on those where `here` is true. If it throws on one of them, all ranks get the
/// error of the first: the same kind of error, with the same text. (Errors of other kinds than those of
/// core/error.hpp become std::runtime_error.)
void together(bool here, const std::function<void()>& work);

/// A number of each rank [any unit, >= 0]: their mean, and the largest to a millionth.
struct OverRanks {
  double mean = 0, largest = 0;

  /// Imbalance; 1 where there is nothing to share.
  double largest_over_mean() const { return mean > 0 ? largest / mean : 1; }
};
OverRanks over_ranks(double number);

/// CPU time of this process so far [s].
double process_seconds();

/// The text of rank `from`, on all ranks.
std::string told(const std::string& text, int from);

}  // namespace softgrain
