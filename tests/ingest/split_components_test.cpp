// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/split_components.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace umbrick;

namespace {

// 2 x 1 x 10 voxels of three numbers, which tell their places.
class CountedSource : public VoxelSource {
 public:
  explicit CountedSource(std::int64_t& read) : read_(read) {
    info_.dims = {2, 1, 10};
    info_.components = info_.valuesPerVoxel = 3;
  }
  double readSlab(std::int64_t count, std::span<float> out) override {
    for (std::int64_t z = 0; z < count; ++z, ++at_)
      for (std::int64_t i = 0; i < 6; ++i) out[static_cast<std::size_t>(6 * z + i)] = static_cast<float>(10 * at_ + i);
    read_ += count;
    return 0.25;
  }
  void skipSlices(std::int64_t count) override { at_ += count; }

 private:
  std::int64_t& read_;
  std::int64_t at_ = 0;
};

void checkSlab(VoxelSource& source, int component, int first, std::int64_t count) {
  std::vector<float> out(static_cast<std::size_t>(2 * count));
  CHECK(source.readSlab(count, out) == 0.25);
  for (std::int64_t z = 0; z < count; ++z)
    for (int x = 0; x < 2; ++x)
      CHECK(out[static_cast<std::size_t>(2 * z + x)] == static_cast<float>(10 * (first + z) + 3 * x + component));
}

}  // namespace

TEST_CASE("Components that are read in step read their file once", "[ingest]") {
  std::int64_t read = 0;
  const auto parts = splitComponents(std::make_unique<CountedSource>(read));
  REQUIRE(parts.size() == 3);
  CHECK(parts[0]->info().valuesPerVoxel == 1);
  for (const auto& [first, count] : {std::pair(0, 4), std::pair(4, 4), std::pair(8, 2)})
    for (int component = 0; component < 3; ++component) {
      checkSlab(*parts[static_cast<std::size_t>(component)], component, first, count);
      CHECK(read == first + count);
    }
}

TEST_CASE("Components may run ahead of each other, and what none wants is skipped", "[ingest]") {
  std::int64_t read = 0;
  const auto parts = splitComponents(std::make_unique<CountedSource>(read));
  for (const auto& part : parts) part->skipSlices(3);
  checkSlab(*parts[2], 2, 3, 2);
  CHECK(read == 2);
  checkSlab(*parts[2], 2, 5, 3);
  checkSlab(*parts[0], 0, 3, 5);
  CHECK(read == 5);
  parts[1]->skipSlices(2);
  checkSlab(*parts[1], 1, 5, 4);  // goes beyond what others have read
  CHECK(read == 6);
  checkSlab(*parts[0], 0, 8, 1);
  checkSlab(*parts[2], 2, 8, 1);
  for (const auto& part : parts) part->skipSlices(1);
  CHECK(read == 6);
}
