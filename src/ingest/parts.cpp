// SPDX-License-Identifier: Apache-2.0
#include "ingest/parts.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "ingest/header_text.h"
#include "ingest/streams/dense_source.h"
#include "ingest/volume_time.h"
#include "umbrick/core/error.h"

namespace umbrick {

/// A stream of a whole array, and how far it has been read.
struct KeptStream {
  std::unique_ptr<ByteStream> bytes;
  std::int64_t at = 0;
  std::string name;  // of the volume that it is of
};

namespace {

constexpr std::int64_t kPartNumbers = std::int64_t(1) << 22;  // that are read at once of an array with several parts

// Gives the stream back when it is dropped.
class LentStream : public ByteStream {
 public:
  LentStream(std::shared_ptr<KeptStream> owner, std::unique_ptr<ByteStream> bytes, std::int64_t at)
      : owner_(std::move(owner)), bytes_(std::move(bytes)), at_(at) {}
  ~LentStream() override {
    owner_->bytes = std::move(bytes_);
    owner_->at = at_;
  }
  LentStream(const LentStream&) = delete;
  LentStream& operator=(const LentStream&) = delete;
  std::size_t read(std::span<std::byte> out) override {
    const std::size_t got = bytes_->read(out);
    at_ += static_cast<std::int64_t>(got);
    return got;
  }
  std::int64_t skip(std::int64_t count) override {
    const std::int64_t done = bytes_->skip(count);
    at_ += done;
    return done;
  }
  bool skipsFast() override { return bytes_->skipsFast(); }

 private:
  std::shared_ptr<KeptStream> owner_;
  std::unique_ptr<ByteStream> bytes_;
  std::int64_t at_;
};

using OpenArray = std::function<std::unique_ptr<ByteStream>()>;

std::unique_ptr<ByteStream> openAt(const VolumeInfo& info, std::int64_t offset, const OpenArray& open,
                                   const std::shared_ptr<KeptStream>& kept) {
  std::unique_ptr<ByteStream> bytes;
  std::int64_t at = 0;
  if (kept && kept->bytes && kept->name == info.name && kept->at <= offset) {
    bytes = std::move(kept->bytes);
    at = kept->at;
  } else {
    bytes = open();
  }
  if (const std::int64_t skipped = bytes->skip(offset - at); skipped < offset - at)
    throw IoError(info.name + ": expected " + describeBytes(info) + ", found " + std::to_string(at + skipped));
  if (!kept) return bytes;
  kept->bytes.reset();
  kept->name = info.name;
  return std::make_unique<LentStream>(kept, std::move(bytes), offset);
}

// Distances in the array, in numbers.
struct Strides {
  std::int64_t x = 1, y = 1, z = 1, component = 1, frame = 1;
};

Strides stridesOf(const VolumeInfo& info, const PartAxes& axes) {
  Strides strides;
  std::int64_t next = 1;
  for (int place = 0; place <= 3; ++place) {
    for (const bool frames : {axes.framesFirst, !axes.framesFirst}) {
      if ((frames ? axes.frames : axes.components) != place) continue;
      (frames ? strides.frame : strides.component) = next;
      next *= frames ? info.frames : info.components;
    }
    if (place == 3) break;
    (place == 0 ? strides.x : place == 1 ? strides.y : strides.z) = next;
    next *= info.dims[place];
  }
  return strides;
}

// Copies numbers of some bytes from where they lie in slices of an array to where they belong in slices of a volume.
template <class T>
void gather(const std::byte* from, std::byte* to, const glm::i64vec3& dims, const Strides& strides,
            std::int64_t apart) {
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y) {
      const std::byte* row = from + (z * strides.z + y * strides.y) * std::int64_t(sizeof(T));
      std::byte* out = to + (z * dims.y + y) * dims.x * apart * std::int64_t(sizeof(T));
      for (std::int64_t x = 0; x < dims.x; ++x)
        std::memcpy(out + x * apart * std::int64_t(sizeof(T)), row + x * strides.x * std::int64_t(sizeof(T)),
                    sizeof(T));
    }
}

void gather(int bytes, const std::byte* from, std::byte* to, const glm::i64vec3& dims, const Strides& strides,
            std::int64_t apart) {
  if (bytes == 1) return gather<std::uint8_t>(from, to, dims, strides, apart);
  if (bytes == 2) return gather<std::uint16_t>(from, to, dims, strides, apart);
  gather<std::uint32_t>(from, to, dims, strides, apart);
}

// A volume out of arrays whose slices hold more than its own.
class PartSource : public VoxelSource {
 public:
  struct Pick {
    std::size_t array = 0;       // which of the arrays
    std::int64_t first = 0;      // of its slice, where the first voxel of the volume's slice is
    std::int64_t component = 0;  // of the volume
  };
  PartSource(VolumeInfo info, std::vector<std::unique_ptr<VoxelSource>> arrays, std::vector<Pick> picks,
             const Strides& strides)
      : arrays_(std::move(arrays)), picks_(std::move(picks)), strides_(strides) {
    info_ = std::move(info);
    const auto rescale = arrays_.front()->info().metadata.find("rescale");
    if (rescale != arrays_.front()->info().metadata.end()) info_.metadata["rescale"] = rescale->second;
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    double error = 0;
    read(count, std::as_writable_bytes(out), 4, [&](VoxelSource& array, std::int64_t slices, std::span<std::byte> to) {
      error = std::max(error, array.readSlab(slices, {reinterpret_cast<float*>(to.data()), to.size() / 4}));
    });
    return error;
  }
  void skipSlices(std::int64_t count) override {
    for (const auto& array : arrays_) array->skipSlices(count);
  }
  bool skipsFast() const override { return arrays_.front()->skipsFast(); }
  std::optional<VoxelType> storedType() const override { return arrays_.front()->storedType(); }
  void readStored(std::int64_t count, std::span<std::byte> out) override {
    read(count, out, voxelBytes(*storedType()),
         [](VoxelSource& array, std::int64_t slices, std::span<std::byte> to) { array.readStored(slices, to); });
  }

 private:
  template <class Read>
  void read(std::int64_t count, std::span<std::byte> out, int bytes, const Read& readArray) {
    // A few slices at a time, since those of an array may be hundreds of times as large as those of the volume.
    const std::int64_t atOnce = std::max<std::int64_t>(kPartNumbers / strides_.z, 1);
    const std::int64_t sliceBytes = info_.dims.x * info_.dims.y * info_.valuesPerVoxel * bytes;
    for (std::int64_t done = 0; done < count; done += atOnce)
      readSlices(std::min(atOnce, count - done), out.data() + done * sliceBytes, bytes, readArray);
  }

  template <class Read>
  void readSlices(std::int64_t count, std::byte* out, int bytes, const Read& readArray) {
    slab_.resize(static_cast<std::size_t>(strides_.z * count * bytes));
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      readArray(*arrays_[i], count, slab_);
      for (const Pick& pick : picks_)
        if (pick.array == i)
          gather(bytes, slab_.data() + pick.first * bytes, out + pick.component * bytes,
                 {info_.dims.x, info_.dims.y, count}, strides_, info_.valuesPerVoxel);
    }
  }

  std::vector<std::unique_ptr<VoxelSource>> arrays_;
  std::vector<Pick> picks_;
  Strides strides_;  // within the slices of an array
  std::vector<std::byte> slab_;
};

// One number of each voxel of a source that gives several.
class ComponentSource : public VoxelSource {
 public:
  ComponentSource(std::unique_ptr<VoxelSource> source, const PartChoice& choice)
      : source_(std::move(source)), component_(choice.component) {
    info_ = source_->info();
    info_.valuesPerVoxel = 1;
    if (!component_) info_.type = VoxelType::f32;
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const std::int64_t several = source_->info().valuesPerVoxel;
    slab_.resize(out.size() * static_cast<std::size_t>(several));
    const double error = source_->readSlab(count, slab_);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const float* voxel = slab_.data() + i * static_cast<std::size_t>(several);
      double squares = 0;
      for (std::int64_t k = 0; !component_ && k < several; ++k) squares += double(voxel[k]) * double(voxel[k]);
      out[i] = component_ ? voxel[*component_] : static_cast<float>(std::sqrt(squares));
    }
    return error;
  }
  void skipSlices(std::int64_t count) override { source_->skipSlices(count); }
  bool skipsFast() const override { return source_->skipsFast(); }

 private:
  std::unique_ptr<VoxelSource> source_;
  std::optional<std::int64_t> component_;
  std::vector<float> slab_;
};

std::string rangeText(std::int64_t count) { return count == 1 ? "0" : "0 to " + std::to_string(count - 1); }

}  // namespace

std::shared_ptr<KeptStream> keepStream() { return std::make_shared<KeptStream>(); }

void chooseComponent(const std::string& word, PartChoice& parts) {
  parts.component.reset();
  parts.magnitude = word == "magnitude";
  if (parts.magnitude) return;
  for (const std::string_view letters : {"xyz", "rgba"})
    if (const std::size_t at = letters.find(word); word.size() == 1 && at != std::string_view::npos)
      parts.component = static_cast<std::int64_t>(at);
  if (!parts.component) parts.component = integer(word);
  if (!parts.component || *parts.component < 0)
    throw InvalidArgument("component: expected a number from 0, x, y, z, r, g, b, a or magnitude, found " + word);
}

std::string meaningName(VoxelMeaning meaning) {
  return meaning == VoxelMeaning::colour ? "colour" : meaning == VoxelMeaning::vector ? "vector" : "number";
}

std::string componentName(const VolumeInfo& info, std::int64_t component) {
  static constexpr const char* kChannels = "rgba";
  if (info.meaning == VoxelMeaning::colour && component < 4)
    return std::string(1, kChannels[static_cast<std::size_t>(component)]);
  return std::to_string(component);
}

std::string usualGridName(const VolumeInfo& info) {
  if (info.components == 1) return "density";
  const auto array = info.metadata.find("array_name");
  if (array != info.metadata.end()) return array->second;
  return info.meaning == VoxelMeaning::colour ? "Cd" : info.meaning == VoxelMeaning::vector ? "v" : "density";
}

std::optional<std::int64_t> arrayBytes(const VolumeInfo& info) {
  std::optional<std::int64_t> bytes = volumeBytes(info.dims, info.type);
  for (const std::int64_t parts : {info.components, info.frames}) {
    std::int64_t all = 0;
    if (!bytes || parts < 1 || parts > 2147483647 || __builtin_mul_overflow(*bytes, parts, &all)) return std::nullopt;
    bytes = all;
  }
  return bytes;
}

void guessMeaning(VolumeInfo& info) {
  if (info.components == 1 || info.meaning != VoxelMeaning::scalar) return;
  const bool colour = info.type == VoxelType::u8 && (info.components == 3 || info.components == 4);
  info.meaning = colour ? VoxelMeaning::colour : VoxelMeaning::vector;
  info.notes.push_back("the file does not say what its " + std::to_string(info.components) +
                       " numbers a voxel are: they are taken for a " + meaningName(info.meaning));
}

void checkChoice(const VolumeInfo& info, const PartChoice& choice) {
  const auto refuse = [&](const char* what, std::int64_t count, std::int64_t found) {
    throw InvalidArgument(info.name + ": " + what + ": expected " + rangeText(count) + ", found " +
                          std::to_string(found));
  };
  if (choice.frame && (*choice.frame < 0 || *choice.frame >= info.frames)) refuse("frame", info.frames, *choice.frame);
  if (choice.component && (*choice.component < 0 || *choice.component >= info.components))
    refuse("component", info.components, *choice.component);
  if (!choice.frame && info.frames > 1)
    throw SeveralParts(info.name + ": a sequence of " + std::to_string(info.frames) + " volumes, frame " +
                           rangeText(info.frames) + ", of which one has to be chosen",
                       info);
  if (info.components > 1 && !choice.component && !choice.allComponents && !choice.magnitude)
    throw SeveralParts(info.name + ": voxels of " + std::to_string(info.components) + " numbers, component " +
                           rangeText(info.components) + ", of which one has to be chosen",
                       info);
}

OpenArray openOnceMore(std::unique_ptr<ByteStream> first, OpenArray again) {
  auto held = std::make_shared<std::unique_ptr<ByteStream>>(std::move(first));
  return [held, again = std::move(again)] { return *held ? std::move(*held) : again(); };
}

std::unique_ptr<VoxelSource> openParts(VolumeInfo info, const PartAxes& axes, const VoxelLayout& layout,
                                       const PartChoice& choice, const OpenArray& open, const std::string& hint) {
  checkChoice(info, choice);
  stateTime(info, {}, choice.frame);
  if (info.components == 1 && info.frames == 1)
    return std::make_unique<DenseSource>(std::move(info), layout, open(), hint);
  const std::int64_t width = voxelBytes(info.type), frame = choice.frame.value_or(0);
  const bool all = !choice.component || choice.magnitude;
  const Strides strides = stridesOf(info, axes);
  // A slice of the array has all parts that vary faster than z; the others lie whole volumes apart.
  const std::int64_t volume = strides.z * info.dims.z;
  const std::int64_t volumes = *arrayBytes(info) / width / volume;
  std::vector<std::int64_t> starts;
  std::vector<PartSource::Pick> picks;
  for (std::int64_t component = all ? 0 : *choice.component;
       component < (all ? info.components : *choice.component + 1); ++component) {
    // Parts inside of a slice have strides below that of z.
    std::int64_t start = 0, first = 0;
    (strides.component >= volume ? start : first) += component * strides.component;
    (strides.frame >= volume ? start : first) += frame * strides.frame;
    const auto found = std::find(starts.begin(), starts.end(), start);
    picks.push_back({static_cast<std::size_t>(found - starts.begin()), first, all ? component : 0});
    if (found == starts.end()) starts.push_back(start);
  }
  std::vector<std::unique_ptr<VoxelSource>> arrays;
  for (const std::int64_t start : starts) {
    VolumeInfo part;
    part.name = info.name;
    if (info.frames > 1) part.name += ": frame " + std::to_string(frame);
    part.type = info.type;
    part.dims = {strides.z / info.dims.y, info.dims.y, info.dims.z};
    if (!volumeBytes(part.dims, part.type))
      throw IoError(info.name + ": expected less than 2^31 numbers along an axis, found " + describeBytes(info));
    auto bytes = openAt(info, start * width, open, starts.size() == 1 ? choice.kept : nullptr);
    // Behind the last volume nothing may be left over, which the source sees.
    if (start / volume + 1 < volumes) bytes = firstBytes(std::move(bytes), volume * width);
    arrays.push_back(std::make_unique<DenseSource>(std::move(part), layout, std::move(bytes), hint));
  }
  info.valuesPerVoxel = all ? info.components : 1;
  auto source = std::make_unique<PartSource>(std::move(info), std::move(arrays), std::move(picks), strides);
  if (choice.magnitude && source->info().valuesPerVoxel > 1)
    return std::make_unique<ComponentSource>(std::move(source), PartChoice{});
  return source;
}

std::unique_ptr<VoxelSource> pickComponents(std::unique_ptr<VoxelSource> source, const PartChoice& choice) {
  checkChoice(source->info(), choice);
  if (source->info().valuesPerVoxel == 1 || (choice.allComponents && !choice.component && !choice.magnitude))
    return source;
  PartChoice one = choice;
  if (choice.magnitude) one.component.reset();
  return std::make_unique<ComponentSource>(std::move(source), one);
}

}  // namespace umbrick
