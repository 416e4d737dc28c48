// SPDX-License-Identifier: Apache-2.0
#include "check/kit_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "check/kit_table.h"
#include "core/input_file.h"
#include "core/json_reader.h"
#include "core/text_file.h"
#include "umbrick/core/error.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"
#include "umbrick/ingest/npy_volume.h"
#include "umbrick/scene/scene.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

constexpr long kMostIndex = 1L << 30;  // in size, of voxels of a kit

void requireFormat(const JsonValue& root) {
  const int format = root.at("format").integer();
  if (format != kKitFormat)
    root.at("format").failExpected("a kit of format " + std::to_string(kKitFormat) + " of this program");
}

// A name of the kit is one of a file in its folder, and leads nowhere else.
std::string nameIn(const JsonValue& value) {
  const std::string& name = value.string();
  if (name.empty() || name.find('/') != std::string::npos || name.starts_with('.'))
    value.failExpected("the name of a file in the kit");
  return name;
}

glm::ivec3 indicesOf(const JsonValue& value) {
  glm::ivec3 indices;
  const std::vector<double> numbers = value.numbers(3);
  for (int axis = 0; axis < 3; ++axis) {
    const double number = numbers[static_cast<std::size_t>(axis)];
    if (number != std::floor(number) || std::abs(number) > static_cast<double>(kMostIndex))
      value.failExpected("three whole numbers of at most 2^30");
    indices[axis] = static_cast<int>(number);
  }
  return indices;
}

std::vector<glm::ivec3> readOrigins(const fs::path& path) {
  const KitTable table(path);
  std::vector<glm::ivec3> origins(table.rows());
  constexpr const char* kColumns[]{"origin_i", "origin_j", "origin_k"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<long> column = table.wholeColumn(kColumns[axis]);
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (std::abs(column[i]) > kMostIndex)
        throw IoError(path.string() + ": " + kColumns[axis] + ": expected at most 2^30, found " +
                      std::to_string(column[i]));
      origins[i][axis] = static_cast<int>(column[i]);
    }
  }
  return origins;
}

std::vector<KitSample> readSamples(const fs::path& path, const BrickFinder& bricks) {
  const KitTable table(path);
  std::vector<KitSample> samples(table.rows());
  constexpr const char* kColumns[]{"i", "j", "k"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> column = table.column(kColumns[axis]);
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (!(std::abs(column[i]) < static_cast<double>(kMostIndex)))
        throw IoError(path.string() + ": " + kColumns[axis] + ": expected less than 2^30, found " +
                      tableNumber(column[i]));
      samples[i].index[axis] = column[i];
    }
  }
  const std::vector<double> values = table.column("value");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].value = values[i];
    samples[i].brick = bricks.at(samples[i].index);
    samples[i].place = placeOf(bricks, samples[i].index);
  }
  return samples;
}

Image layerOf(ExrFile& file, const std::string& name, int channels, const fs::path& path) {
  const auto layer =
      std::find_if(file.layers.begin(), file.layers.end(), [&](const auto& each) { return each.name == name; });
  if (layer == file.layers.end() || layer->image.channels != channels)
    throw IoError(path.string() + ": expected a layer " + (name.empty() ? "RGBA" : name) + " of " +
                  std::to_string(channels) + " channels, found none");
  return std::move(layer->image);
}

AskedPicture readPicture(const fs::path& folder, const JsonValue& json, const ScalarGrid& grid) {
  const fs::path reference = folder / nameIn(json.at("reference")), sceneFile = folder / nameIn(json.at("scene"));
  const Scene scene = readScene(sceneFile, true);
  AskedPicture picture{
      nameIn(json.at("name")), resolveScene(scene, grid.worldBounds(), grid.indexToWorld()), {}, {}, {}};
  ExrFile file = readExr(reference);
  picture.colour = layerOf(file, "", 4, reference);
  picture.errorBar = layerOf(file, kErrorBarLayer, 4, reference);
  picture.depth = layerOf(file, kDepthLayer, 1, reference);
  const Camera& camera = picture.scene.camera;
  if (picture.colour.width != camera.width || picture.colour.height != camera.height)
    throw IoError(reference.string() + ": expected " + std::to_string(camera.width) + " x " +
                  std::to_string(camera.height) + " pixels, as " + sceneFile.string() + " says, found " +
                  std::to_string(picture.colour.width) + " x " + std::to_string(picture.colour.height));
  return picture;
}

std::string sizeOf(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

// Files have the first row on top, and images at the bottom.
Image fromTopRow(const std::vector<float>& values, int width, int height, int channels) {
  Image image(width, height, channels);
  const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  for (int y = 0; y < height; ++y)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(y)), row,
                image.at(0, height - 1 - y));
  return image;
}

Image readNpyPicture(const fs::path& path) {
  const auto array = openNpy(path, {}, true);
  const glm::i64vec3 dims = array->info().dims;
  constexpr std::int64_t kMostPixels = 1 << 28;
  if (dims.x != 4 || dims.y * dims.z > kMostPixels)
    throw IoError(path.string() + ": expected an array of height x width x 4 numbers, found " + std::to_string(dims.z) +
                  " x " + std::to_string(dims.y) + " x " + std::to_string(dims.x));
  std::vector<float> values(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  array->readSlab(dims.z, values);
  return fromTopRow(values, static_cast<int>(dims.y), static_cast<int>(dims.z), 4);
}

Image readRawPicture(const fs::path& path, int width, int height) {
  const std::size_t count = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::int64_t bytes = ordinaryFileSize(path);
  if (bytes != static_cast<std::int64_t>(count * sizeof(float)))
    throw IoError(path.string() + ": expected " + sizeOf(width, height) + " of four 32-bit floats = " +
                  std::to_string(count * sizeof(float)) + " bytes, found " + std::to_string(bytes));
  std::vector<float> values(count);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), bytes);
  if (in.gcount() != bytes) throw IoError(path.string() + ": cannot read");
  return fromTopRow(values, width, height, 4);
}

Image readExrPicture(const fs::path& path) {
  ExrFile file = readExr(path);
  return layerOf(file, "", 4, path);
}

}  // namespace

std::vector<std::string> readKit(const KitFiles& files) {
  std::error_code error;
  if (!fs::exists(files.manifest(), error))
    throw IoError(files.root.string() + ": expected a kit with a kit.json, found none");
  const JsonDocument document(readTextFile(files.manifest()), files.manifest().string());
  requireFormat(document.root());
  std::vector<std::string> names;
  for (const JsonValue& name : document.root().at("cases").items()) names.push_back(nameIn(name));
  return names;
}

AskedCase readCase(const KitFiles& files, const std::string& name) {
  const fs::path folder = files.folder(name), description = files.description(name);
  const JsonDocument document(readTextFile(description), description.string());
  const JsonValue root = document.root(), volume = root.at("volume"), bricks = root.at("bricks");
  requireFormat(root);
  ScalarGrid grid = readScalarGrid(folder / nameIn(volume.at("vdb")), volume.at("grid").string());
  std::vector<glm::ivec3> origins = readOrigins(folder / nameIn(bricks.at("table")));
  const glm::ivec3 interior = indicesOf(bricks.at("interior"));
  if (interior.x < 1 || interior.y < 1 || interior.z < 1) bricks.at("interior").failExpected("three numbers above 0");
  const BrickFinder finder(interior, origins);
  const glm::ivec3 first = indicesOf(volume.at("first_voxel")), dims = indicesOf(volume.at("dims"));
  const std::vector<double> range = volume.at("value_range").numbers(2);
  AskedCase asked{name,
                  std::move(grid),
                  std::move(origins),
                  finder,
                  {first, first + dims - 1},
                  range[1] - range[0],
                  readSamples(folder / nameIn(root.at("samples").at("table")), finder),
                  {}};
  for (const JsonValue& picture : root.at("pictures").items())
    asked.pictures.push_back(readPicture(folder, picture, asked.grid));
  return asked;
}

std::optional<fs::path> findAnswer(const fs::path& folder, const std::string& stem,
                                   const std::vector<std::string>& extensions) {
  std::optional<fs::path> found;
  for (const std::string& extension : extensions) {
    const fs::path path = folder / (stem + extension);
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    if (found)
      throw InvalidArgument(path.string() + ": answers the same as " + found->filename().string() +
                            "; keep one of them");
    found = path;
  }
  return found;
}

Image readPictureAnswer(const fs::path& path, int width, int height) {
  const std::string extension = path.extension().string();
  if (extension == ".exr") return readExrPicture(path);
  if (extension == ".png") return readPng(path);
  if (extension == ".npy") return readNpyPicture(path);
  return readRawPicture(path, width, height);
}

std::vector<double> readSampleAnswer(const fs::path& path, std::size_t samples) {
  const KitTable table(path);
  const std::vector<long> ids = table.wholeColumn("id");
  const std::vector<double> answered = table.column("value");
  std::vector<double> values(samples);
  std::vector<bool> known(samples, false);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] < 0 || static_cast<std::size_t>(ids[i]) >= samples)
      throw IoError(path.string() + ": id: expected 0 to " + std::to_string(samples - 1) + ", found " +
                    std::to_string(ids[i]));
    const auto id = static_cast<std::size_t>(ids[i]);
    if (known[id]) throw IoError(path.string() + ": id: " + std::to_string(id) + " is there twice");
    known[id] = true;
    values[id] = answered[i];
  }
  const auto missing = std::find(known.begin(), known.end(), false);
  if (missing != known.end())
    throw IoError(path.string() + ": expected " + std::to_string(samples) + " samples, found " +
                  std::to_string(ids.size()) + "; the first that is missing is " +
                  std::to_string(missing - known.begin()));
  return values;
}

}  // namespace umbrick
