// A folder with frames of a small volume, and what tests of umbrick render do there.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/program.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"

namespace umbrick {

inline constexpr int kEdge = 12;
inline const std::string kSeen = "--tf t.json --size 40x30 --azimuth 20 --elevation 10 --zoom 1 --exr-pixel float ";

inline std::string header(const std::string& more) { return "NRRD0004\ntype: uint8\n" + more + "encoding: raw\n\n"; }

// A ball of that radius around the middle, as bytes that grow with it.
inline std::string ball(double radius, int most) {
  std::string voxels;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const double far = std::hypot(x - 5.5, y - 5.5, z - 5.5);
        voxels += static_cast<char>(far < radius ? static_cast<int>(most * (1 - far / radius)) + 1 : 0);
      }
  return voxels;
}

struct FramesWorkplace {
  TemporaryFolder folder;

  FramesWorkplace() {
    writeBytes(folder.path() / "t.json", R"({"points": [{"value": 0, "albedo": [1, 0.6, 0.2], "sigma_t": 0},
                                                        {"value": 250, "albedo": [0.9, 0.8, 0.7], "sigma_t": 2}]})");
  }
  // A ball that grows with the number of its frame, as f_03.nrrd; sampled with that distance.
  void addFrame(int number, const std::string& spacing = "1 1 1") const {
    addVolume(number, ball(1.5 + number, 40 * number), spacing);
  }
  void addVolume(int number, const std::string& voxels, const std::string& spacing = "1 1 1") const {
    char name[32];
    std::snprintf(name, sizeof name, "f_%02d.nrrd", number);
    writeBytes(folder.path() / name, header("dimension: 3\nsizes: 12 12 12\nspacings: " + spacing + "\n") + voxels);
  }
  ProgramResult run(const std::string& arguments) const { return runProgram(folder, arguments); }
  ProgramResult render(const std::string& arguments) const {
    ProgramResult result = run("render " + arguments);
    INFO(arguments << ": " << result.err);
    REQUIRE(result.status == 0);
    return result;
  }
  std::vector<float> pixels(const std::string& name) const {
    const std::filesystem::path path = folder.path() / name;
    return path.extension() == ".exr" ? readExr(path).layers.at(0).image.pixels : readPng(path).pixels;
  }
  nlohmann::json sceneOf(const std::string& name) const {
    return nlohmann::json::parse(readExr(folder.path() / name).metadata.at("umbrick.scene"));
  }
  bool has(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }
};

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

inline double largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max<double>(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace umbrick
