// SPDX-License-Identifier: MIT
// Minimum degree: a permutation that fills as little as known for simple patterns.
#include "core/solve/order/ordering.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;

namespace {

using Pairs = std::vector<std::pair<int32_t, int32_t>>;

using Neighbours = std::vector<std::set<int32_t>>;

Neighbours neighbours_of(int32_t n, const Pairs& pairs) {
  Neighbours neighbours(static_cast<size_t>(n));
  for (const auto& [a, b] : pairs) {
    neighbours[static_cast<size_t>(a)].insert(b);
    neighbours[static_cast<size_t>(b)].insert(a);
  }
  return neighbours;
}

// Removes a node and joins its neighbours to each other. @return those
std::set<int32_t> eliminate(int32_t k, Neighbours* neighbours) {
  const std::set<int32_t> clique = (*neighbours)[static_cast<size_t>(k)];
  for (const int32_t a : clique) {
    std::set<int32_t>& of_a = (*neighbours)[static_cast<size_t>(a)];
    of_a.erase(k);
    of_a.insert(clique.begin(), clique.end());
    of_a.erase(a);
  }
  return clique;
}

/// @param first_late 0: none is to come late
std::vector<int32_t> order_of(int32_t n, const Pairs& pairs, int32_t first_late = 0) {
  const Neighbours neighbours = neighbours_of(n, pairs);
  std::vector<int32_t> start{0};
  std::vector<int32_t> list;
  for (const auto& of_one : neighbours) {
    list.insert(list.end(), of_one.begin(), of_one.end());
    start.push_back(static_cast<int32_t>(list.size()));
  }
  std::vector<int32_t> work(
      static_cast<size_t>(minimum_degree_workspace(n, static_cast<int64_t>(list.size()) / 2)));
  std::vector<int32_t> order(static_cast<size_t>(n), -1);
  minimum_degree_order({start.data(), n + 1}, {list.data(), static_cast<int32_t>(list.size())},
                       first_late, {work.data(), static_cast<int32_t>(work.size())},
                       {order.data(), n});
  return order;
}

bool is_permutation_of_all(std::vector<int32_t> order) {
  std::sort(order.begin(), order.end());
  for (size_t i = 0; i < order.size(); ++i) {
    if (order[i] != static_cast<int32_t>(i)) return false;
  }
  return true;
}

// Off-diagonal blocks of the factor, by eliminating one node after another.
size_t fill(int32_t n, const Pairs& pairs, const std::vector<int32_t>& order) {
  Neighbours neighbours = neighbours_of(n, pairs);
  size_t blocks = 0;
  for (const int32_t k : order) blocks += eliminate(k, &neighbours).size();
  return blocks;
}

Pairs random_pairs(unisim_test::Random& random, int32_t n, int32_t count) {
  Pairs pairs;
  for (int32_t k = 0; k < count; ++k) {
    const int32_t a = random.below(n);
    const int32_t b = random.below(n);
    if (a != b) pairs.emplace_back(a, b);
  }
  return pairs;
}

// Exact minimum degree by sets: the yardstick for the approximate degrees.
std::vector<int32_t> exact_minimum_degree(int32_t n, const Pairs& pairs) {
  Neighbours neighbours = neighbours_of(n, pairs);
  std::vector<bool> done(static_cast<size_t>(n), false);
  std::vector<int32_t> order;
  for (int32_t step = 0; step < n; ++step) {
    int32_t best = -1;
    for (int32_t i = 0; i < n; ++i) {
      const size_t at = static_cast<size_t>(i);
      if (!done[at] &&
          (best < 0 || neighbours[at].size() < neighbours[static_cast<size_t>(best)].size()))
        best = i;
    }
    done[static_cast<size_t>(best)] = true;
    order.push_back(best);
    eliminate(best, &neighbours);
  }
  return order;
}

}  // namespace

TEST_CASE("a chain and a star fill nothing") {
  Pairs chain;
  Pairs star;
  for (int32_t i = 1; i < 50; ++i) {
    chain.emplace_back(i - 1, i);
    star.emplace_back(0, i);
  }
  CHECK(fill(50, chain, order_of(50, chain)) == 49);
  CHECK(fill(50, star, order_of(50, star)) == 49);
}

TEST_CASE("nodes that are to come late have none of the others above them") {
  unisim_test::Random random(21);
  for (int32_t repetition = 0; repetition < 60; ++repetition) {
    const int32_t n = 2 + random.below(80);
    const int32_t first_late = random.below(n + 1);
    const Pairs pairs = random_pairs(random, n, 3 * n);
    const std::vector<int32_t> order = order_of(n, pairs, first_late);
    REQUIRE(is_permutation_of_all(order));
    Neighbours neighbours = neighbours_of(n, pairs);
    for (const int32_t k : order) {
      for (const int32_t above : eliminate(k, &neighbours)) {
        CHECK((k < first_late || above >= first_late));
      }
    }
  }
}

TEST_CASE("isolated nodes, one node and a clique are ordered too") {
  CHECK(is_permutation_of_all(order_of(1, {})));
  CHECK(is_permutation_of_all(order_of(5, {{1, 3}})));
  Pairs clique;
  for (int32_t a = 0; a < 9; ++a) {
    for (int32_t b = a + 1; b < 9; ++b) clique.emplace_back(a, b);
  }
  CHECK(is_permutation_of_all(order_of(9, clique)));
  CHECK(fill(9, clique, order_of(9, clique)) == 36);
}

TEST_CASE("random patterns: a permutation whose fill is close to exact minimum degree") {
  unisim_test::Random random(5);
  size_t approximate = 0;
  size_t exact = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int32_t n = 2 + random.below(80);
    const Pairs pairs = random_pairs(random, n, random.below(4 * n));
    const std::vector<int32_t> order = order_of(n, pairs);
    REQUIRE(is_permutation_of_all(order));
    approximate += fill(n, pairs, order);
    exact += fill(n, pairs, exact_minimum_degree(n, pairs));
  }
  CHECK(static_cast<double>(approximate) < 1.08 * static_cast<double>(exact));
}

TEST_CASE("keyframes in windows with submaps fill as little as exact minimum degree") {
  // 300 keyframes in a chain, windows of 16 overlapping by 2, one submap each, a loop every 40
  // frames
  Pairs pairs;
  for (int32_t i = 1; i < 300; ++i) pairs.emplace_back(i - 1, i);
  int32_t submap = 300;
  for (int32_t first = 0; first + 16 <= 300; first += 14, ++submap) {
    for (int32_t i = first; i < first + 16; ++i) pairs.emplace_back(i, submap);
    if (first > 0) pairs.emplace_back(submap - 1, submap);
  }
  for (int32_t i = 150; i + 8 < 300; i += 40, ++submap) {
    for (int32_t k = 0; k < 8; ++k) {
      pairs.emplace_back(i + k, submap);
      pairs.emplace_back(i - 140 + k, submap);
    }
  }
  const std::vector<int32_t> order = order_of(submap, pairs);
  REQUIRE(is_permutation_of_all(order));
  const size_t exact = fill(submap, pairs, exact_minimum_degree(submap, pairs));
  CHECK(static_cast<double>(fill(submap, pairs, order)) < 1.05 * static_cast<double>(exact));
}
