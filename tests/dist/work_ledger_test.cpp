// Work is shared out once and its results come in order, whoever is how fast.
// SPDX-License-Identifier: Apache-2.0
#include "dist/work_ledger.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "umbrick/core/random.h"

using namespace umbrick;
using namespace umbrick::tools;
using Kind = WorkLedger::Kind;

TEST_CASE("Each item goes to one rank, and results are collected in their order", "[dist]") {
  constexpr int kRanks = 5;
  constexpr std::size_t kItems = 200, kWindow = 8;
  Random random(3, 0);
  WorkLedger ledger(kRanks);
  CHECK(ledger.take(false).kind == Kind::later);  // before the job has begun
  ledger.begin(kItems, kWindow);
  std::vector<std::vector<std::size_t>> held(kRanks);
  std::vector<int> given(kItems);
  std::vector<std::size_t> collected;
  // In random order ranks take an item, also a second one ahead, or put the oldest one that they have.
  while (collected.size() < kItems) {
    auto& own = held[static_cast<std::size_t>(random.uniform() * kRanks)];
    if (own.size() < 2 && random.uniform() < 0.5) {
      const WorkLedger::Answer answer = ledger.take(!own.empty());
      if (answer.kind != Kind::item) continue;
      REQUIRE(answer.item < kItems);
      ++given[answer.item];
      CHECK(answer.item < collected.size() + kWindow);
      own.push_back(answer.item);
    } else if (!own.empty()) {
      ledger.put({own.front(), std::to_string(own.front()), {}});
      own.erase(own.begin());
    }
    if (random.uniform() < 0.3)
      while (const auto result = ledger.collect()) {
        CHECK(result->bytes == std::to_string(result->item));
        collected.push_back(result->item);
      }
  }
  CHECK(std::ranges::all_of(given, [](int times) { return times == 1; }));
  CHECK(std::ranges::is_sorted(collected));
  CHECK(ledger.take(false).kind == Kind::none);
}

TEST_CASE("Nobody takes an item ahead that another rank could begin", "[dist]") {
  WorkLedger ledger(3);
  ledger.begin(4, 100);
  CHECK(ledger.take(false).item == 0);
  CHECK(ledger.take(true).item == 1);  // three are left for three ranks
  CHECK(ledger.take(true).kind == Kind::later);
  CHECK(ledger.take(false).item == 2);
  CHECK(ledger.take(false).item == 3);
  CHECK(ledger.take(true).kind == Kind::none);
}

TEST_CASE("A job that is stopped gives what was done, in order, once all ranks rest", "[dist]") {
  WorkLedger ledger(2);
  ledger.begin(10, 100);
  for (int i = 0; i < 4; ++i) ledger.take(false);
  ledger.put({3, {}, {}});
  ledger.put({1, {}, {}});
  CHECK_FALSE(ledger.collect());
  ledger.stop();
  CHECK(ledger.take(false).kind == Kind::none);
  ledger.rest(0);
  CHECK_FALSE(ledger.collect());  // the other rank may still put 0
  ledger.rest(1);
  CHECK(ledger.allRest());
  CHECK(ledger.collect()->item == 1);
  CHECK(ledger.collect()->item == 3);
  CHECK_FALSE(ledger.collect());
}

TEST_CASE("The first error of a rank ends the job", "[dist]") {
  WorkLedger ledger(2);
  ledger.begin(10, 100);
  ledger.fail("one");
  ledger.fail("two");
  CHECK(ledger.failure() == "one");
  CHECK(ledger.take(false).kind == Kind::none);
}

TEST_CASE("What is done is counted in items and in shares of those at hand", "[dist]") {
  WorkLedger ledger(2);
  ledger.begin(10, 100);
  ledger.take(false);
  ledger.take(false);
  ledger.show(0, 0.25);
  ledger.show(1, 0.5);
  ledger.put({0, {}, {}});
  CHECK(ledger.done().items == 1);
  CHECK(ledger.done().shares == 0.75);
  ledger.rest(1);
  CHECK(ledger.done().shares == 0.25);
}
