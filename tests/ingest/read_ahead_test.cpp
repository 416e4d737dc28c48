// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/read_ahead.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "support/complaint.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/raw_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Voxels with values known from their index, and counters of what was done.
struct Counts {
  std::atomic<int> opened = 0, slices = 0, closed = 0;
};
class CountingSource : public VoxelSource {
 public:
  CountingSource(const glm::i64vec3& dims, int start, Counts& counts, std::int64_t fails = -1)
      : start_(start), fails_(fails), counts_(counts) {
    info_.dims = dims;
    info_.name = "volume " + std::to_string(start);
    ++counts.opened;
  }
  ~CountingSource() override { ++counts_.closed; }
  double readSlab(std::int64_t count, std::span<float> out) override {
    if (fails_ >= 0 && at_ + count > fails_) throw IoError(info_.name + ": broken");
    const std::int64_t slice = info_.dims.x * info_.dims.y;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = float((start_ + at_ * slice + std::int64_t(i)) % 65536);
    at_ += count;
    counts_.slices += static_cast<int>(count);
    return 0.25 * start_;
  }

 private:
  int start_;
  std::int64_t fails_, at_ = 0;
  Counts& counts_;
};

const glm::i64vec3 kBig(1024, 1024, 7);  // slabs of two slices, 8 MiB

std::vector<ReadAhead::Open> volumes(Counts& counts, int count, std::int64_t lastFails = -1) {
  std::vector<ReadAhead::Open> out;
  for (int i = 0; i < count; ++i)
    out.push_back([&counts, i, fails = i == count - 1 ? lastFails : -1] {
      return std::make_unique<CountingSource>(kBig, i, counts, fails);
    });
  return out;
}

// Waits for the other thread; fails when that takes a minute.
template <class Condition>
void waitUntil(const Condition& condition) {
  for (int i = 0; i < 60'000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  REQUIRE(condition());
}

}  // namespace

TEST_CASE("Volumes that are read ahead equal those that are read one by one", "[ingest]") {
  Counts counts, plain;
  ReadAhead ahead(volumes(counts, 3));
  for (int i = 0; i < 3; ++i) {
    const auto source = ahead.next();
    CHECK(source->info().name == "volume " + std::to_string(i));
    CHECK_FALSE(source->storedType());
    CHECK(readVolume(*source) == readVolume(*std::make_unique<CountingSource>(kBig, i, plain)));
  }
}

TEST_CASE("Volumes are read while nobody takes them, up to a limit of bytes", "[ingest]") {
  Counts counts;
  std::vector<float> slab(2 << 20);
  {
    ReadAhead ahead(volumes(counts, 4), std::int64_t(5) << 23);  // a volume has slabs of 8, 8, 8 and 4 MiB
    waitUntil([&] { return counts.slices == 9; });               // 28 MiB and 8 of the next; 8 more would be too much
    CHECK(counts.opened == 2);
    CHECK(counts.closed == 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK(counts.slices == 9);
    const auto source = ahead.next();
    CHECK(source->readSlab(2, slab) == 0);
    waitUntil([&] { return counts.slices == 11; });
    // The rest of the first is dropped.
    CHECK(ahead.next()->readSlab(1, std::span(slab).first(1 << 20)) == 0.25);
    CHECK(slab[0] == 1);
  }
  CHECK(counts.closed == counts.opened);
}

TEST_CASE("Errors of a volume come where they were met, after what was good", "[ingest]") {
  Counts counts;
  ReadAhead ahead(volumes(counts, 2, /*lastFails=*/3));
  CHECK(readVolume(*ahead.next()).size() == 7u << 20);
  const auto source = ahead.next();
  std::vector<float> slab(2 << 20);
  CHECK(source->readSlab(2, slab) == 0.25);
  for (int again = 0; again < 2; ++again)
    CHECK_THAT(complaint<IoError>([&] { source->readSlab(2, slab); }), Contains("volume 1: broken"));
  ReadAhead none({[]() -> std::unique_ptr<VoxelSource> { throw IoError("missing"); }});
  CHECK_THAT(complaint<IoError>([&] { none.next(); }), Contains("missing"));
}

TEST_CASE("Volumes read ahead keep their stored type, bytes and floats alike", "[ingest]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", std::string("\1\0\2\0\3\0\4\1", 8));
  const auto open = [&] { return openRaw(folder.path() / "v.raw", {{2, 1, 2}, VoxelType::u16, std::endian::big}); };
  ReadAhead ahead({open, open});
  const auto stored = ahead.next();
  CHECK(stored->storedType() == VoxelType::u16);
  std::vector<std::uint16_t> values(4);
  stored->readStored(1, std::as_writable_bytes(std::span(values).first(2)));
  stored->readStored(1, std::as_writable_bytes(std::span(values).subspan(2)));
  CHECK(values == std::vector<std::uint16_t>{256, 512, 768, 1025});
  CHECK(readVolume(*ahead.next()) == std::vector<float>{256, 512, 768, 1025});
}
