#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/core/shared_loop.hpp"
#include "softgrain/core/shared_row.hpp"
#include "softgrain/core/shared_sum.hpp"

using namespace softgrain;

namespace {

/// What each rank has written in each exchange. Ranks of one process take turns: each goes on until it would
/// have to wait for another, and begins anew in its next turn.
struct Board {
  std::map<int, std::map<int, std::vector<std::byte>>> gathered;                  // [exchange][rank]
  std::map<std::tuple<int, int, int>, std::vector<std::vector<std::byte>>> sent;  // [from, to, label]
};
struct MustWait {};

class OneOfSeveral final : public Communicator {
 public:
  OneOfSeveral(int rank, int ranks, Board& board) : rank_(rank), ranks_(ranks), board_(board) {}
  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }
  void gather(std::span<std::byte> all, std::span<const std::size_t> begin) override {
    auto& parts = board_.gathered[exchange_++];
    const auto part = [&](int r) { return all.subspan(begin[r], begin[r + 1] - begin[r]); };
    parts[rank_].assign(part(rank_).begin(), part(rank_).end());
    for (int r = 0; r < ranks_; ++r) {
      if (!parts.contains(r)) throw MustWait();
      REQUIRE(parts[r].size() == part(r).size());
      std::copy(parts[r].begin(), parts[r].end(), part(r).begin());
    }
  }
  void swap(std::span<const Parcel> parcels) override {
    for (const Parcel& parcel : parcels) {
      if (parcel.out.empty()) continue;
      auto& line = board_.sent[{rank_, parcel.rank, parcel.label}];
      const std::size_t number = sent_[{parcel.rank, parcel.label}]++;
      if (line.size() <= number) line.resize(number + 1);
      line[number].assign(parcel.out.begin(), parcel.out.end());
    }
    for (const Parcel& parcel : parcels) {
      if (parcel.in.empty()) continue;
      const auto& line = board_.sent[{parcel.rank, rank_, parcel.label}];
      const std::size_t number = received_[{parcel.rank, parcel.label}]++;
      if (line.size() <= number) throw MustWait();
      REQUIRE(line[number].size() == parcel.in.size());
      std::copy(line[number].begin(), line[number].end(), parcel.in.begin());
    }
  }
  std::int64_t largest(std::int64_t number) override {
    std::vector<std::int64_t> all(ranks_);
    all[rank_] = number;
    std::vector<std::size_t> begin;
    for (int r = 0; r <= ranks_; ++r) begin.push_back(r * sizeof number);
    gather(std::as_writable_bytes(std::span(all)), begin);
    return *std::max_element(all.begin(), all.end());
  }

 private:
  int rank_, ranks_, exchange_ = 0;
  std::map<std::pair<int, int>, std::size_t> sent_, received_;  // [other rank, label]
  Board& board_;
};

/// What work(rank) returns on each rank.
template <class Work>
auto on_ranks(int ranks, const Work& work) {
  Board board;
  std::vector<decltype(work(0))> result(ranks);
  for (int waiting = 1, turn = 0; waiting > 0; ++turn) {
    REQUIRE(turn < 100);
    waiting = 0;
    for (int r = 0; r < ranks; ++r) {
      use_communicator(std::make_unique<OneOfSeveral>(r, ranks, board));
      try {
        result[r] = work(r);
      } catch (const MustWait&) {
        ++waiting;
      }
    }
  }
  use_communicator(std::make_unique<Communicator>());
  return result;
}

}  // namespace

TEST_CASE("ranks have units side by side, each about an equal part of their weight") {
  for (const int ranks : {1, 2, 3, 4, 7, 20}) {
    const std::vector<double> weight{1, 1, 1, 5, 1, 1, 1, 1, 2, 2, 2, 2};  // 20 in all
    const auto first = on_ranks(ranks, [&](int rank) {
      const Shares shares(weight);
      int mine = 0;
      double of_mine = 0;
      for (int u = 0; u < 12; ++u)
        if (shares.mine(u)) ++mine, of_mine += weight[u];
      CHECK(of_mine <= 20.0 / ranks + 5);  // never more than the largest unit above its part
      const std::vector<int> begin =
          ranks == 1 ? std::vector{0, 12} : shares.first_items(12, [](int u) { return u; });
      CHECK(begin.front() == 0);
      CHECK(begin.back() == 12);
      CHECK(begin[rank + 1] - begin[rank] == mine);
      return mine;
    });
    CHECK(std::accumulate(first.begin(), first.end(), 0) == 12);  // each has one owner
  }
}

TEST_CASE("a shared loop leaves what its results name with all ranks, and nothing else") {
  struct Result {
    std::vector<double> squares, own;
    std::vector<std::vector<int>> divisors;
  };
  const std::vector<int> units{0, 2, 3, 5, 6, 7};  // items need not be of all units
  const auto results = on_ranks(3, [&](int) {
    const Shares shares(std::vector<double>(8, 1.0));
    Result result{std::vector<double>(8), std::vector<double>(8), std::vector<std::vector<int>>(6)};
    shared_for(
        shares, 6, [&](int i) { return units[i]; },
        [&](int i) { result.squares[units[i]] = result.own[units[i]] = units[i] * units[i]; },
        [&](int i, Message& message) { message(result.squares[units[i]]); });
    shared_for(
        shares, 6, [&](int i) { return units[i]; },
        [&](int i) {
          for (int d = 1; d <= units[i]; ++d)
            if (units[i] % d == 0) result.divisors[i].push_back(d);
        },
        [&](int i, Message& message) { message.list(result.divisors[i]); }, Lengths::told);
    return result;
  });
  int own = 0;
  for (const Result& result : results) {
    CHECK(result.squares == std::vector<double>{0, 0, 4, 9, 0, 25, 36, 49});
    CHECK(result.divisors == std::vector<std::vector<int>>{{}, {1, 2}, {1, 3}, {1, 5}, {1, 2, 3, 6}, {1, 7}});
    own +=
        static_cast<int>(std::count_if(result.own.begin(), result.own.end(), [](double x) { return x > 0; }));
  }
  CHECK(own == 5);
}

TEST_CASE("all ranks get the error of the first item that failed, whichever rank has it") {
  const auto loop = [](int) {
    const Shares shares(std::vector<double>(8, 1.0));
    try {
      shared_for(
          shares, 8,
          [](int i) {
            if (i == 5) throw NumericalError("grain 5");
            if (i == 7) throw IoError("grain 7");
          },
          [](int, Message&) {});
    } catch (const NumericalError& error) {
      return std::string("numerical: ") + error.what();
    } catch (const std::exception& error) {
      return std::string("other: ") + error.what();
    }
    return std::string("none");
  };
  for (const std::string& told : on_ranks(4, loop)) CHECK(told == "numerical: grain 5");
  const auto writes = [](int rank) {
    try {
      together(rank == 0, [] { throw IoError("the disk is full"); });
    } catch (const IoError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  for (const std::string& told : on_ranks(3, writes)) CHECK(told == "the disk is full");
}

TEST_CASE("sweeps along a row of groups have the bits of one process, a message per neighbour and half") {
  // group k averages the bodies 3k .. 3k + 5, half of which the next group has too
  for (const bool ring : {false, true}) {
    constexpr int groups = 8, each = 3;
    const int bodies = each * (ring ? groups : groups + 1);
    const auto sweeps = [&](int) {
      SharedRow row(std::vector<double>{1, 1, 4, 1, 1, 1, 5, 1}, ring);
      std::vector<double> value(bodies);
      for (int i = 0; i < bodies; ++i) value[i] = std::sin(1.0 + i);
      for (int sweep = 0; sweep < 3; ++sweep)
        row.alternate(
            groups,
            [&](int group) {
              for (int k = 0; k + 1 < 2 * each; ++k) {
                double &a = value[(each * group + k) % bodies], &b = value[(each * group + k + 1) % bodies];
                a += 0.3 * (b - a), b += 0.3 * (a - b);
              }
            },
            [&](std::size_t seam, Message& message) {
              const int first = each * row.seams()[seam].right;
              message(std::span(value).subspan(static_cast<std::size_t>(first % bodies), each));
            });
      row.tell(groups, [&](int group, Message& message) {
        for (int k = 0; k < 2 * each; ++k) message(value[(each * group + k) % bodies]);
      });
      return value;
    };
    const std::vector<double> alone = on_ranks(1, sweeps).front();
    for (const int ranks : {2, 3, 5, 12})
      for (const std::vector<double>& value : on_ranks(ranks, sweeps)) CHECK(value == alone);
  }
}

TEST_CASE("a sum over items has the bits of one process wherever ranks cut it") {
  constexpr int count = 3 * detail::chunk + 100;
  for (const std::vector<int>& cuts :
       {std::vector<int>{1000, 3000}, {500, 600}, {2048, 4096}, {100, 6000}, {6143, 6145}}) {
    std::vector<int> first{0};
    first.insert(first.end(), cuts.begin(), cuts.end());
    first.push_back(count);
    const auto sums = [&](int) {
      const Shares shares(std::vector<double>(first.size() - 1, 1.0));
      return shared_sum<double>(shares, first, [&](int begin, int end, double sum) {
        for (int i = begin; i < end; ++i) sum += std::sin(1.0 + i);
        return sum;
      });
    };
    const double alone = on_ranks(1, sums).front();
    CHECK(alone == parallel_sum<double>(count, [](int begin, int end) {
            double sum = 0;
            for (int i = begin; i < end; ++i) sum += std::sin(1.0 + i);
            return sum;
          }));
    for (const int ranks : {2, 3, 5})
      for (const double sum : on_ranks(ranks, sums)) CHECK(sum == alone);
  }
}

TEST_CASE("the first rank collects what it writes, the others learn nothing") {
  const auto results = on_ranks(3, [](int) {
    const Shares shares(std::vector<double>(6, 1.0));
    std::vector<std::vector<int>> lists(6);
    own_for(shares, 6, [&](int i) { lists[i].assign(i, i); });
    collect(
        shares, 6, [](int i) { return i; }, [&](int i, Message& message) { message.list(lists[i]); });
    return lists;
  });
  CHECK(results[0] ==
        std::vector<std::vector<int>>{{}, {1}, {2, 2}, {3, 3, 3}, {4, 4, 4, 4}, {5, 5, 5, 5, 5}});
  CHECK(results[1] == std::vector<std::vector<int>>{{}, {}, {2, 2}, {3, 3, 3}, {}, {}});
  const auto told_by_first = on_ranks(3, [](int rank) {
    double number = 10.0 + rank;
    tell_all(number);
    return number;
  });
  CHECK(told_by_first == std::vector<double>{10, 10, 10});
}

TEST_CASE("the first rank is told what one rank has worked on, and nothing where its work failed") {
  struct Heard {
    std::vector<int> numbers;
    std::string error;
  };
  for (const int worker : {0, 2})
    for (const bool fails : {false, true}) {
      CAPTURE(worker);
      CAPTURE(fails);
      const auto heard = on_ranks(3, [&](int rank) {
        Heard mine;
        try {
          tell_first(
              worker,
              [&] {
                CHECK(rank == worker);
                mine.numbers = {3, 1, 4};
                if (fails) throw NumericalError("turned inside out");
              },
              [&](Message& message) { message.list(mine.numbers); });
        } catch (const NumericalError& error) {
          mine.error = error.what();
        }
        return mine;
      });
      CHECK(heard[0].numbers == (fails && worker != 0 ? std::vector<int>{} : std::vector{3, 1, 4}));
      CHECK(heard[1].numbers.empty());
      for (int rank = 0; rank < 3; ++rank)
        CHECK(heard[rank].error == (fails && rank == worker ? "turned inside out" : ""));
    }
}
