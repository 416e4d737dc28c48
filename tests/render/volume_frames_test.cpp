// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/volume_frames.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

// A volume of 4 x 4 x 4 bytes, all 0 but the voxel of that number.
VolumeReference bytesOf(const TemporaryFolder& folder, int value) {
  VolumeReference reference;
  reference.file = folder.path() / ("v" + std::to_string(value) + ".raw");
  reference.raw.emplace();
  reference.raw->dims = {4, 4, 4};
  reference.raw->type = "u8";
  std::ofstream out(reference.file, std::ios::binary);
  for (int i = 0; i < 64; ++i) out.put(static_cast<char>(i == value ? value : 0));
  return reference;
}

// The only voxel that is active.
int numberOf(const Volume& volume) {
  const Box box = volume.worldBounds();
  return static_cast<int>(box.min.x + 4 * box.min.y + 16 * box.min.z);
}

}  // namespace

TEST_CASE("Frames come in their order, one that cannot be read ends nothing but itself", "[render]") {
  const TemporaryFolder folder;
  VolumeReference missing = bytesOf(folder, 1);
  missing.file = folder.path() / "not_there.raw";
  VolumeFrames frames({bytesOf(folder, 3), bytesOf(folder, 0), missing, bytesOf(folder, 7), bytesOf(folder, 9)},
                      [](const Volume& volume, std::size_t) -> std::unique_ptr<Bricks> {
                        if (numberOf(volume) == 9) throw InvalidArgument("not this one");
                        return nullptr;
                      });
  CHECK(numberOf(*frames.next().volume) == 3);
  CHECK(frames.next().volume == nullptr);  // holds nothing
  CHECK_THROWS_AS(frames.next(), IoError);
  CHECK(numberOf(*frames.next().volume) == 7);
  CHECK_FALSE(frames.done());
  CHECK_THROWS_WITH(frames.next(), "not this one");
  CHECK(frames.done());
}

TEST_CASE("One frame is read ahead and no more", "[render]") {
  const TemporaryFolder folder;
  std::atomic<int> cut = 0;
  VolumeFrames frames({bytesOf(folder, 1), bytesOf(folder, 2), bytesOf(folder, 3)},
                      [&](const Volume&, std::size_t index) {
                        CHECK(index == static_cast<std::size_t>(cut));
                        ++cut;
                        return std::unique_ptr<Bricks>();
                      });
  const auto settles = [&](int expected) {
    for (int i = 0; i < 6000 && cut < expected; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // in which another would begin
    return cut == expected;
  };
  CHECK(settles(1));
  frames.next();
  CHECK(settles(2));
  frames.next();
  CHECK(settles(3));
}

TEST_CASE("A wait for a frame can be given up and begun again", "[render]") {
  const TemporaryFolder folder;
  std::atomic<bool> mayEnd = false;
  VolumeFrames frames({bytesOf(folder, 5)}, [&](const Volume&, std::size_t) {
    while (!mayEnd) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return std::unique_ptr<Bricks>();
  });
  CHECK_THROWS_WITH(frames.next([] { throw Error("enough"); }), "enough");
  CHECK_FALSE(frames.done());
  mayEnd = true;
  CHECK(numberOf(*frames.next().volume) == 5);
}
