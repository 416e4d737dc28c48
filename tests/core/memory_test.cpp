// What is said where memory or threads are refused.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/memory.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <system_error>

#include "support/complaint.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("A step that fits is done, and one that no machine has the memory for is refused before", "[memory]") {
  CHECK(availableMemory().bytes > 0);
  CHECK_NOTHROW(requireMemory("step", 4096));
  const std::string said = complaint<MemoryError>([] { requireMemory("a.vdb: step", 0x1p60); });
  CHECK_THAT(said, Contains("a.vdb: step: needs 1.07e+09 GiB of memory, there is "));
  CHECK_THAT(said, Catch::EndsWith("(" + availableMemory().limit + ")"));
}

TEST_CASE("Refused memory and threads become an error that names the step, other errors pass", "[memory]") {
  const auto step = [] { return std::string("a.vdb: step"); };
  CHECK(withinMemory(step, [] { return 7; }) == 7);
  const auto saidOf = [&](const auto& error) {
    return complaint<MemoryError>([&] { withinMemory(step, [&]() -> int { throw error; }); });
  };
  CHECK_THAT(saidOf(std::bad_alloc()), Contains("a.vdb: step: out of memory, there is "));
  noteRefusedMemory(3 << 20);
  CHECK_THAT(saidOf(std::bad_alloc()), Contains("a.vdb: step: out of memory: asked for 3 MiB more, there is "));
  const std::error_code again = std::make_error_code(std::errc::resource_unavailable_try_again);
  CHECK_THAT(saidOf(std::system_error(again)), Contains("a.vdb: step: the system refuses another thread"));
  // As TBB throws it.
  CHECK_THAT(saidOf(std::runtime_error("pthread_create has failed: no")), Contains("refuses another thread"));
  CHECK_THROWS_AS(withinMemory(step, []() -> int { throw IoError("x"); }), IoError);
  CHECK_THROWS_AS(withinMemory(step, []() -> int { throw std::logic_error("x"); }), std::logic_error);
}
