// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/read_ahead.h"

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "ingest/streams/decode.h"

namespace umbrick {
namespace {

constexpr std::int64_t kSlabVoxels = std::int64_t(1) << 21;

// What is known of a volume before its first slab.
struct Head {
  VolumeInfo info;
  std::optional<VoxelType> stored;
};

// One thing that the thread has read: a head, slices, or an error in their place.
struct Item {
  std::optional<Head> head;
  std::unique_ptr<std::byte[]> slab;
  std::int64_t bytes = 0;
  double conversionError = 0;
  std::exception_ptr failure;
};

}  // namespace

struct ReadAhead::Queue {
  std::vector<Open> volumes;
  std::int64_t maxBytes = 0;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Item> items;  // this and what follows: under the mutex
  std::int64_t bytes = 0;
  bool stop = false;
  std::thread thread;

  /// Waits for room for so many bytes. @return false when nobody waits for them
  bool waitForRoom(std::int64_t more) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return stop || items.empty() || bytes + more <= maxBytes; });
    return !stop;
  }
  void push(Item item) {
    const std::scoped_lock lock(mutex);
    bytes += item.bytes;
    items.push_back(std::move(item));
    changed.notify_all();
  }
  /// Waits for the next item. @throw Error  that the thread met in its place
  Item pop() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return !items.empty(); });
    if (items.front().failure) std::rethrow_exception(items.front().failure);
    Item item = std::move(items.front());
    items.pop_front();
    bytes -= item.bytes;
    changed.notify_all();
    return item;
  }

  void readAll() {
    try {
      for (const Open& open : volumes)
        if (!read(open())) return;
    } catch (...) {
      Item item;
      item.failure = std::current_exception();
      push(std::move(item));
    }
  }

  // @return false when nobody waits for more
  bool read(std::unique_ptr<VoxelSource> source) {
    const glm::i64vec3 dims = source->info().dims;
    const std::optional<VoxelType> stored = source->storedType();
    Item head;
    head.head = Head{source->info(), stored};
    push(std::move(head));
    const std::int64_t sliceNumbers = dims.x * dims.y * source->info().valuesPerVoxel;
    const std::int64_t sliceBytes = sliceNumbers * voxelBytes(stored.value_or(VoxelType::f32));
    const std::int64_t atOnce = std::max<std::int64_t>(kSlabVoxels / sliceNumbers, 1);
    for (std::int64_t first = 0; first < dims.z; first += atOnce) {
      const std::int64_t slices = std::min(atOnce, dims.z - first);
      Item item;
      item.bytes = slices * sliceBytes;
      if (!waitForRoom(item.bytes)) return false;
      item.slab = std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(item.bytes));
      if (stored)
        source->readStored(slices, {item.slab.get(), static_cast<std::size_t>(item.bytes)});
      else
        item.conversionError = source->readSlab(
            slices, {reinterpret_cast<float*>(item.slab.get()), static_cast<std::size_t>(slices * sliceNumbers)});
      if (first + slices == dims.z) source.reset();  // what it counted is complete when its last slab is there
      push(std::move(item));
    }
    return true;
  }
};

namespace {

class AheadSource : public VoxelSource {
 public:
  AheadSource(Head head, ReadAhead::Queue& queue) : queue_(queue), stored_(head.stored) {
    info_ = std::move(head.info);
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    if (!stored_) return take(std::as_writable_bytes(out));
    std::vector<std::byte> bytes(out.size() * static_cast<std::size_t>(voxelBytes(*stored_)));
    readStored(count, bytes);
    return decodeVoxels({*stored_, std::endian::native}, bytes, out);
  }
  std::optional<VoxelType> storedType() const override { return stored_; }
  void readStored(std::int64_t, std::span<std::byte> out) override { take(out); }

 private:
  double take(std::span<std::byte> out) {
    double error = 0;
    while (!out.empty()) {
      if (used_ == slab_.bytes) {
        slab_ = queue_.pop();
        used_ = 0;
      }
      const auto part = static_cast<std::size_t>(std::min<std::int64_t>(slab_.bytes - used_, std::ssize(out)));
      std::memcpy(out.data(), slab_.slab.get() + used_, part);
      error = std::max(error, slab_.conversionError);
      used_ += static_cast<std::int64_t>(part);
      out = out.subspan(part);
    }
    return error;
  }

  ReadAhead::Queue& queue_;
  std::optional<VoxelType> stored_;
  Item slab_;
  std::int64_t used_ = 0;
};

}  // namespace

ReadAhead::ReadAhead(std::vector<Open> volumes, std::int64_t maxBytes) : queue_(std::make_unique<Queue>()) {
  queue_->volumes = std::move(volumes);
  queue_->maxBytes = maxBytes;
  queue_->thread = std::thread([queue = queue_.get()] { queue->readAll(); });
}

ReadAhead::~ReadAhead() {
  {
    const std::scoped_lock lock(queue_->mutex);
    queue_->stop = true;
    queue_->changed.notify_all();
  }
  queue_->thread.join();
}

std::unique_ptr<VoxelSource> ReadAhead::next() {
  for (;;) {
    Item item = queue_->pop();
    if (item.head) return std::make_unique<AheadSource>(std::move(*item.head), *queue_);
  }
}

}  // namespace umbrick
