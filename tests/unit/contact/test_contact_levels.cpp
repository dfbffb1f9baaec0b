#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "softgrain/contact/contact_levels.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

struct Pairs {
  std::vector<int> a, b;
};

/// Contacts of bodies on a line with some of their neighbours and with walls, in any order.
Pairs random_pairs(int bodies, int contacts, int reach, test::RandomNumbers& random) {
  Pairs pairs;
  for (int c = 0; c < contacts; ++c) {
    const int a = static_cast<int>(random.uniform(0, bodies));
    const int b = std::clamp(a + static_cast<int>(random.uniform(-reach, reach + 1)), 0, bodies - 1);
    pairs.a.push_back(a);
    pairs.b.push_back(b == a ? -1 : b);
  }
  return pairs;
}

std::set<int> bodies_of(const Pairs& pairs, const ContactLevels& levels, int group) {
  std::set<int> bodies;
  for (int k = levels.begin[group]; k < levels.begin[group + 1]; ++k) {
    bodies.insert(pairs.a[levels.contact[k]]);
    if (pairs.b[levels.contact[k]] >= 0) bodies.insert(pairs.b[levels.contact[k]]);
  }
  return bodies;
}

}  // namespace

TEST_CASE("groups of contacts that are not next to each other share no body") {
  test::RandomNumbers random(8);
  for (const int least : {1, 10, 60}) {
    const Pairs pairs = random_pairs(300, 900, 3, random);
    const ContactLevels levels = contact_levels(pairs.a, pairs.b, 300, least);
    CHECK(levels.groups() > 5);
    for (int k = 0; k < levels.groups(); ++k) {
      const std::set<int> bodies = bodies_of(pairs, levels, k);
      for (int other = k + 2; other < levels.groups(); ++other)
        for (const int body : bodies_of(pairs, levels, other)) CHECK(bodies.count(body) == 0);
      if (k + 1 < levels.groups()) CHECK(levels.begin[k + 1] - levels.begin[k] >= least);
      CHECK(std::is_sorted(levels.contact.begin() + levels.begin[k],
                           levels.contact.begin() + levels.begin[k + 1]));
    }
    // every contact once
    std::vector<int> all = levels.contact, expected(pairs.a.size());
    std::sort(all.begin(), all.end());
    std::iota(expected.begin(), expected.end(), 0);
    CHECK(all == expected);
  }
}

TEST_CASE("a chain of bodies has a level for each, and few contacts are one group") {
  const std::vector<int> a{0, 1, 2, 3}, b{1, 2, 3, -1};
  const ContactLevels each = contact_levels(a, b, 4, 1);
  CHECK(each.begin == std::vector<int>{0, 1, 2, 3, 4});
  const ContactLevels one = contact_levels(a, b, 4, 256);
  CHECK(one.begin == std::vector<int>{0, 4});
  CHECK(one.contact == std::vector<int>{0, 1, 2, 3});
  CHECK(contact_levels({}, {}, 4, 256).groups() == 0);
}

TEST_CASE("bodies without a contact between them are taken one after the other") {
  const std::vector<int> a{4, 2, 0}, b{5, 3, 1};  // three pairs apart
  const ContactLevels levels = contact_levels(a, b, 6, 1);
  CHECK(levels.contact == std::vector<int>{2, 1, 0});
  CHECK(levels.groups() == 3);
}
