// SPDX-License-Identifier: Apache-2.0
#include "dist/picture_bytes.h"

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick::tools {
namespace {

// Appends to bytes.
class Packer {
 public:
  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void operator()(const Number& number) { add(&number, sizeof number); }
  void operator()(const std::string& text) { addSeveral(text.data(), text.size(), 1); }
  void operator()(const std::vector<float>& numbers) { addSeveral(numbers.data(), numbers.size(), sizeof(float)); }
  std::string bytes;

 private:
  void add(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  void addSeveral(const void* data, std::size_t count, std::size_t size) {
    (*this)(static_cast<std::uint64_t>(count));
    add(data, count * size);
  }
};

// Reads what a Packer has made, in the same order.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : left_(bytes) {}
  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void operator()(Number& number) { take(&number, sizeof number); }
  void operator()(std::string& text) {
    text.resize(takeCount(1));
    take(text.data(), text.size());
  }
  void operator()(std::vector<float>& numbers) {
    numbers.resize(takeCount(sizeof(float)));
    take(numbers.data(), numbers.size() * sizeof(float));
  }
  bool done() const { return left_.empty(); }

 private:
  void need(std::size_t size) const {
    if (left_.size() < size)
      throw Error("a picture of another rank: expected " + std::to_string(size) + " more bytes, found " +
                  std::to_string(left_.size()));
  }
  void take(void* data, std::size_t size) {
    need(size);
    if (size > 0) std::memcpy(data, left_.data(), size);
    left_.remove_prefix(size);
  }
  std::size_t takeCount(std::size_t size) {
    std::uint64_t count = 0;
    take(&count, sizeof count);
    if (count > left_.size() / size) need(left_.size() + 1);
    return count;
  }

  std::string_view left_;
};

template <class Visit, class AnImage>
void visitImage(AnImage& image, Visit& visit) {
  visit(image.width);
  visit(image.height);
  visit(image.channels);
  visit(image.pixels);
}

// The names are all members in their order, so that one that is added to the statistics is not forgotten here.
template <class Visit, class Stats>
void visitStats(Stats& stats, Visit& visit) {
  auto& [slices, bricks, visibleBricks, polygons, fragments, brickSlots, uploadedBricks, textureBytes, textures,
         textureEdge, bufferBytes, directions, windowTexel, windowBytes, windowUpdates, lightMs, lightSpacing,
         lightSpacingError, lightOnGl, lightNote, passes, formatError, geometryMs, uploadMs, sweepMs, readMs] = stats;
  const auto all = [&](auto&... members) { (visit(members), ...); };
  all(slices, bricks, visibleBricks, polygons, fragments, brickSlots, uploadedBricks, textureBytes, textures,
      textureEdge, bufferBytes, directions, windowTexel, windowBytes, windowUpdates, lightMs, lightSpacing,
      lightSpacingError, lightOnGl, lightNote, passes, formatError, geometryMs, uploadMs, sweepMs, readMs);
}

}  // namespace

std::string bytesOfPicture(const Picture& picture) {
  Packer pack;
  for (const Image* image : {&picture.colour, &picture.visibility, &picture.depth, &picture.opacity})
    visitImage(*image, pack);
  pack(static_cast<std::uint64_t>(picture.layers.size()));
  for (const ImageLayer& layer : picture.layers) {
    pack(layer.name);
    pack(layer.exact);
    visitImage(layer.image, pack);
  }
  visitStats(picture.stats, pack);
  return std::move(pack.bytes);
}

Picture pictureOfBytes(std::string_view bytes) {
  Picture picture;
  Unpacker unpack(bytes);
  for (Image* image : {&picture.colour, &picture.visibility, &picture.depth, &picture.opacity})
    visitImage(*image, unpack);
  std::uint64_t layers = 0;
  unpack(layers);
  for (std::uint64_t i = 0; i < layers; ++i) {
    ImageLayer& layer = picture.layers.emplace_back();
    unpack(layer.name);
    unpack(layer.exact);
    visitImage(layer.image, unpack);
  }
  visitStats(picture.stats, unpack);
  if (!unpack.done()) throw Error("a picture of another rank: more bytes than a picture has");
  return picture;
}

}  // namespace umbrick::tools
