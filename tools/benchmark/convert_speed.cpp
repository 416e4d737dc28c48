// What it costs to make a grid of a dense file: buildGrid, from the file, against OpenVDB's copyFromDense, from floats
// that are in memory already, and against copyFromDense with the reading that it needs.
//
//     ninja umbrick_convert_speed && umbrick_convert_speed FOLDER [EDGE=512 [ROUNDS=7]]
//
// Writes EDGE^3 u16 with blobs in 5 % of the volume to FOLDER, then lets the ways take turns, so that other load on the
// machine meets all of them; times are medians. The file comes from the page cache; reading it is the floor.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "umbrick/core/stopwatch.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/ingest/raw_volume.h"

namespace {
namespace fs = std::filesystem;
using namespace umbrick;

void writeBlobs(const fs::path& path, int edge) {
  std::ofstream out(path, std::ios::binary);
  std::vector<std::uint16_t> slice(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
  // One ball in each of 4^3 cells, of the radius that fills 5 % of them: 4/3 pi r^3 = 0.05.
  const double cell = edge / 4.0, radius = cell * std::cbrt(0.05 * 3 / (4 * 3.14159265358979));
  const auto fromCentre = [&](int i) { return std::fmod(i + 0.5, cell) - cell / 2; };
  for (int z = 0; z < edge; ++z) {
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) {
        const double r = std::hypot(fromCentre(x), fromCentre(y), fromCentre(z));
        slice[static_cast<std::size_t>(y * edge + x)] =
            r < radius ? static_cast<std::uint16_t>(1000 + 3000 * (1 - r / radius) + (x * 7 + y * 5 + z * 3) % 32) : 0;
      }
    out.write(reinterpret_cast<const char*>(slice.data()), static_cast<std::streamsize>(slice.size() * 2));
  }
  if (!out) throw std::runtime_error(path.string() + ": cannot write");
}

std::vector<std::uint16_t> readAll(const fs::path& path, std::size_t voxels) {
  std::vector<std::uint16_t> stored(voxels);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(stored.data()), static_cast<std::streamsize>(voxels * 2));
  if (!in) throw std::runtime_error(path.string() + ": cannot read");
  return stored;
}

void readOnly(const fs::path& path) {
  std::vector<char> chunk(4 << 20);
  std::ifstream in(path, std::ios::binary);
  while (in.read(chunk.data(), static_cast<std::streamsize>(chunk.size()))) continue;
}

openvdb::FloatGrid::Ptr copyDense(std::vector<float>& voxels, int edge) {
  auto grid = openvdb::FloatGrid::create(0);
  const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(edge - 1));
  const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, voxels.data());
  openvdb::tools::copyFromDense(dense, *grid, 0.0f);
  openvdb::tools::prune(grid->tree());
  return grid;
}

bool sameGrid(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
  if (!a.tree().hasSameTopology(b.tree())) return false;
  auto other = b.cbeginValueOn();
  for (auto value = a.cbeginValueOn(); value; ++value, ++other)
    if (value.getCoord() != other.getCoord() || *value != *other) return false;
  return true;
}

double statusMb(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(field + ':')) return std::strtod(line.c_str() + field.size() + 1, nullptr) / 1024;
  return 0;
}

struct Measured {
  std::vector<double> ms;
  double peakMb = 0;
};

// Linux forgets the peak so far when it is told to.
void measure(Measured& way, double memoryBefore, const std::function<void()>& work) {
  std::ofstream("/proc/self/clear_refs") << 5;
  const Stopwatch stopwatch;
  work();
  way.ms.push_back(stopwatch.elapsedMs());
  way.peakMb = std::max(way.peakMb, statusMb("VmHWM") - memoryBefore);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void run(const fs::path& folder, int edge, int rounds) {
  openvdb::initialize();
  const fs::path file = folder / ("blobs_" + std::to_string(edge) + ".raw");
  writeBlobs(file, edge);
  const auto voxels = static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge);
  RawOptions raw;
  raw.dims = glm::i64vec3(edge);
  raw.type = VoxelType::u16;
  std::map<std::string, Measured> ways;
  const std::string floor = "read the file", ours = "buildGrid from the file", theirs = "copyFromDense of floats",
                    whole = "read, to float, copyFromDense";
  for (int round = 0; round < rounds; ++round) {
    openvdb::FloatGrid::Ptr built, copied;
    const double before = statusMb("VmRSS");
    measure(ways[floor], before, [&] { readOnly(file); });
    measure(ways[ours], before, [&] { built = buildGrid(*openRaw(file, raw)).grid; });
    const double beforeWhole = statusMb("VmRSS");
    measure(ways[whole], beforeWhole, [&] {
      const std::vector<std::uint16_t> stored = readAll(file, voxels);
      std::vector<float> floats(stored.begin(), stored.end());
      copied = copyDense(floats, edge);
    });
    const std::vector<std::uint16_t> stored = readAll(file, voxels);
    const double beforeFloats = statusMb("VmRSS");
    std::vector<float> floats(stored.begin(), stored.end());
    measure(ways[theirs], beforeFloats, [&] { copied = copyDense(floats, edge); });
    if (!sameGrid(*built, *copied)) throw std::runtime_error("the grids differ");
    if (round == 0)
      std::printf("%d^3 u16, %.2f %% active, %d rounds\n", edge,
                  100.0 * static_cast<double>(built->activeVoxelCount()) / static_cast<double>(voxels), rounds);
  }
  const double unit = median(ways[ours].ms);
  for (const std::string& name : {floor, ours, theirs, whole})
    std::printf("%-30s %8.1f ms  %5.2f x  peak %6.0f MB\n", name.c_str(), median(ways[name].ms),
                median(ways[name].ms) / unit, ways[name].peakMb);
  fs::remove(file);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "usage: umbrick_convert_speed FOLDER [EDGE=512 [ROUNDS=7]]\n";
    return 2;
  }
  try {
    run(arguments[1], count > 2 ? std::atoi(arguments[2]) : 512, count > 3 ? std::atoi(arguments[3]) : 7);
  } catch (const std::exception& error) {
    std::cerr << "umbrick_convert_speed: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
