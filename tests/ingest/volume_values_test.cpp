// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/volume_values.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/memory_source.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

VolumeValues valuesOf(const std::vector<float>& voxels, int bins) {
  const auto count = static_cast<std::int64_t>(voxels.size());
  return volumeValues([&] { return std::make_unique<MemorySource>(glm::i64vec3(count, 1, 1), voxels); }, bins);
}

}  // namespace

TEST_CASE("Values of a volume fall into equal bins, both ends included", "[ingest]") {
  const VolumeValues found = valuesOf({-1, 0, 1, 2, 3}, 4);
  CHECK(found.min == -1);
  CHECK(found.max == 3);
  CHECK(found.histogram == std::vector<std::uint64_t>{1, 1, 1, 2});
  CHECK(found.nonFinite == 0);
}

TEST_CASE("Voxels that are no numbers are counted and left out, and one value is one bin", "[ingest]") {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  const VolumeValues mixed = valuesOf({nan, 2, infinity, 2, -infinity}, 3);
  CHECK(mixed.nonFinite == 3);
  CHECK(mixed.histogram == std::vector<std::uint64_t>{2, 0, 0});
  const VolumeValues none = valuesOf({nan, nan}, 3);
  CHECK(std::isnan(none.min));
  CHECK(none.histogram.empty());
  const float largest = std::numeric_limits<float>::max();
  CHECK(valuesOf({-largest, largest}, 2).histogram == std::vector<std::uint64_t>{1, 1});
  CHECK_THROWS_AS(valuesOf({1}, 0), InvalidArgument);
}
