// SPDX-License-Identifier: Apache-2.0
#include "core/mebibytes.h"

#include <catch2/catch.hpp>

using namespace umbrick;

TEST_CASE("A size is printed in mebibytes, rounded up to a tenth", "[core]") {
  constexpr std::uint64_t kMebibyte = 1 << 20;
  CHECK(mebibytes(0) == "0 MiB");
  CHECK(mebibytes(1) == "0.1 MiB");
  CHECK(mebibytes(kMebibyte) == "1 MiB");
  CHECK(mebibytes(kMebibyte + 1) == "1.1 MiB");
  CHECK(mebibytes(2 * kMebibyte - 1) == "2 MiB");
  CHECK(mebibytes(66 * 66 * 66 * 4) == "1.1 MiB");
  CHECK(mebibytes(~std::uint64_t{0}) == "17592186044416 MiB");
}
