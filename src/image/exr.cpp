// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>

#include "core/input_file.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/printable.h"

namespace umbrick {
namespace {

constexpr std::array<const char*, 4> kSuffixes{"R", "G", "B", "A"};
constexpr const char* kDepth = "Z";
constexpr float kLargestHalf = 65504;

// Returns what channel `c` of a layer is called in the file.
std::string channelName(const ImageLayer& layer, int c) {
  if (layer.name.empty()) return layer.image.channels == 1 ? "Y" : kSuffixes[static_cast<std::size_t>(c)];
  return layer.image.channels == 1 ? layer.name : layer.name + "." + kSuffixes[static_cast<std::size_t>(c)];
}

void checkLayers(const std::vector<ImageLayer>& layers) {
  if (layers.empty()) throw InvalidArgument("EXR: no layers");
  const Image& first = layers.front().image;
  if (first.width < 1 || first.height < 1)
    throw InvalidArgument("EXR: the image is " + std::to_string(first.width) + " x " + std::to_string(first.height));
  std::set<std::string> channels;
  for (const ImageLayer& layer : layers) {
    const std::string at = "EXR: layer '" + layer.name + "': ";
    const Image& image = layer.image;
    if (image.width != first.width || image.height != first.height)
      throw InvalidArgument(at + std::to_string(image.width) + " x " + std::to_string(image.height) + " beside " +
                            std::to_string(first.width) + " x " + std::to_string(first.height));
    if (image.channels < 1 || image.channels > 4 || (layer.name.empty() && image.channels == 2))
      throw InvalidArgument(at + std::to_string(image.channels) + " channels");
    if (layer.name.find('.') != std::string::npos) throw InvalidArgument(at + "a name with a dot is two names in EXR");
    for (int c = 0; c < image.channels; ++c)
      if (!channels.insert(channelName(layer, c)).second)
        throw InvalidArgument(at + "there is a channel '" + channelName(layer, c) + "' already");
  }
}

// One channel as it goes to the file, with rows from the top.
struct ChannelRows {
  std::string name;
  Imf::PixelType type = Imf::FLOAT;
  std::vector<char> bytes;
};

template <typename T, typename Convert>
std::vector<char> planeOf(const Image& image, int c, Convert convert) {
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  std::vector<char> bytes(count * sizeof(T));
  T* out = reinterpret_cast<T*>(bytes.data());
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x) *out++ = convert(image.at(x, y)[c]);
  return bytes;
}

half toHalf(float value) { return half(std::isfinite(value) ? std::clamp(value, -kLargestHalf, kLargestHalf) : value); }

// What OpenEXR writes to.
class ExrStream : public Imf::OStream {
 public:
  ExrStream(std::ostream& out, const std::string& name) : OStream(name.c_str()), out_(out) {}
  void write(const char bytes[], int count) override { out_.write(bytes, count); }
  std::uint64_t tellp() override { return static_cast<std::uint64_t>(std::streamoff(out_.tellp())); }
  void seekp(std::uint64_t place) override { out_.seekp(static_cast<std::streamoff>(place)); }

 private:
  std::ostream& out_;
};

void writePlanes(std::ostream& out, const std::string& name, int width, int height,
                 const std::vector<ChannelRows>& planes, const std::map<std::string, std::string>& metadata) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [key, text] : metadata) header.insert(key, Imf::StringAttribute(asUtf8(text)));
  Imf::FrameBuffer buffer;
  for (const ChannelRows& plane : planes) {
    header.channels().insert(plane.name, Imf::Channel(plane.type));
    const std::size_t size = plane.type == Imf::HALF ? sizeof(half) : sizeof(float);
    buffer.insert(plane.name, Imf::Slice(plane.type, const_cast<char*>(plane.bytes.data()), size,
                                         size * static_cast<std::size_t>(width)));
  }
  ExrStream stream(out, name);
  Imf::OutputFile file(stream, header);
  file.setFrameBuffer(buffer);
  file.writePixels(height);
}

// Returns the layer's name and the channel's suffix: "V" is the layer V, "light.R" is the channel R of the layer light,
// and "R" is of the main layer.
std::pair<std::string, std::string> splitName(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  if (dot != std::string::npos) return {channel.substr(0, dot), channel.substr(dot + 1)};
  const bool isMain = channel == "Y" || std::find(kSuffixes.begin(), kSuffixes.end(), channel) != kSuffixes.end();
  return isMain ? std::pair{std::string(), channel} : std::pair{channel, std::string()};
}

// Sorts suffixes: RGBA first, in this order, then the others by the alphabet.
int suffixRank(const std::string& suffix) {
  const auto at = std::find(kSuffixes.begin(), kSuffixes.end(), suffix);
  return static_cast<int>(at - kSuffixes.begin());
}

struct FileLayer {
  std::string name;
  std::vector<std::string> channels;  // full names in the file
};

std::vector<FileLayer> layersOf(const Imf::ChannelList& list) {
  std::map<std::string, std::vector<std::pair<int, std::string>>> groups;  // by layer; the main layer, "", sorts first
  for (auto channel = list.begin(); channel != list.end(); ++channel) {
    const auto [layer, suffix] = splitName(channel.name());
    groups[layer].emplace_back(suffixRank(suffix), channel.name());
  }
  std::vector<FileLayer> layers;
  for (auto& [name, channels] : groups) {
    std::sort(channels.begin(), channels.end());
    layers.push_back({name, {}});
    for (const auto& channel : channels) layers.back().channels.push_back(channel.second);
  }
  return layers;
}

ExrFile readOpened(Imf::InputFile& file) {
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  const auto width = static_cast<std::int64_t>(window.max.x) - window.min.x + 1;
  const auto height = static_cast<std::int64_t>(window.max.y) - window.min.y + 1;
  // A damaged header must not ask for more memory than any picture needs.
  constexpr std::int64_t kMostPixels = std::int64_t(1) << 28;
  if (width < 1 || height < 1 || width > kMostPixels / height)
    throw IoError("an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  ExrFile result;
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      result.metadata[attribute.name()] = text->value();

  const std::vector<FileLayer> layers = layersOf(header.channels());
  std::size_t channels = 0;
  for (const FileLayer& layer : layers) channels += layer.channels.size();
  requireMemory(
      std::to_string(width) + " x " + std::to_string(height) + " pixels of " + std::to_string(channels) + " channels",
      double(sizeof(float)) * double(width) * double(height) * double(channels));
  if (layers.empty()) throw IoError("no channels");
  Imf::FrameBuffer buffer;
  for (const FileLayer& layer : layers) {
    const auto layerChannels = static_cast<int>(layer.channels.size());
    result.layers.push_back({layer.name, Image(static_cast<int>(width), static_cast<int>(height), layerChannels)});
    Image& image = result.layers.back().image;
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
      const Imf::Channel& channel = header.channels()[layer.channels[c].c_str()];
      if (channel.xSampling != 1 || channel.ySampling != 1)
        throw IoError("channel '" + layer.channels[c] + "' has a lower resolution than the image");
      const std::size_t pixel = sizeof(float) * layer.channels.size();
      buffer.insert(layer.channels[c], Imf::Slice::Make(Imf::FLOAT, image.pixels.data() + c, window, pixel,
                                                        pixel * static_cast<std::size_t>(width)));
    }
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  // The first row of the file is the top one.
  for (ImageLayer& layer : result.layers) {
    const auto row = static_cast<std::ptrdiff_t>(width) * layer.image.channels;
    const auto begin = layer.image.pixels.begin();
    for (std::ptrdiff_t low = 0, high = height - 1; low < high; ++low, --high)
      std::swap_ranges(begin + low * row, begin + (low + 1) * row, begin + high * row);
  }
  return result;
}

}  // namespace

void writeExr(const std::filesystem::path& path, const std::vector<ImageLayer>& layers, const ExrOptions& options) {
  checkLayers(layers);
  PendingFile pending(path);
  std::vector<ChannelRows> planes;
  for (const ImageLayer& layer : layers)
    for (int c = 0; c < layer.image.channels; ++c) {
      ChannelRows plane{channelName(layer, c), Imf::FLOAT, {}};
      if (options.pixel == ExrPixel::half && plane.name != kDepth && !layer.exact) {
        plane.type = Imf::HALF;
        plane.bytes = planeOf<half>(layer.image, c, toHalf);
      } else {
        plane.bytes = planeOf<float>(layer.image, c, [](float value) { return value; });
      }
      planes.push_back(std::move(plane));
    }
  try {
    const Image& first = layers.front().image;
    writePlanes(pending.stream(), path.string(), first.width, first.height, planes, options.metadata);
  } catch (const std::exception& error) {
    pending.flush();  // says why, where OpenEXR's words hide that the file could not be written
    throw IoError(path.string() + ": cannot write: " + error.what());
  }
  pending.commit();
}

ExrFile readExr(const std::filesystem::path& path) {
  ordinaryFileSize(path);
  bool tiled = false, deep = false;
  if (!Imf::isOpenExrFile(path.c_str(), tiled, deep)) throw IoError(path.string() + ": not an EXR file");
  if (deep) throw IoError(path.string() + ": a deep EXR file, which has no scan lines of pixels");
  try {
    Imf::InputFile file(path.c_str());
    if (!file.isComplete()) throw IoError("truncated: some scan lines are missing");
    return readOpened(file);
  } catch (const std::exception& error) {
    throw IoError(path.string() + ": cannot read: " + error.what());
  }
}

}  // namespace umbrick
