// Damaged files through the program: whatever the damage, it ends by itself, in one line and with nothing half done.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/ball_workplace.h"
#include "umbrick/core/random.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/scene.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

// A good file, and what is done with each that is made from it. "FILE" stands for its name.
struct Subject {
  std::string name, bytes, arguments, output;
};

std::string corpus(const std::string& file) { return readBytes(fs::path(UMBRICK_FUZZ_CORPUS) / file); }

// Makes environment.exr, scene.json and files of grids in the folder.
std::vector<Subject> subjects(const BallWorkplace& at) {
  const std::string reference = "--size 4x4 --model emission -o out.exr";
  REQUIRE(at.run("convert ball.vdb -o ball.nvdb").status == 0);
  REQUIRE(at.run("reference ball.vdb --tf ball.json --size 8x8 --model emission -o sky.exr").status == 0);
  const std::string scene = R"({"volume": {"file": "ball.vdb"}, "transfer": "smoke", "model": "emission",
    "camera": {"size": [4, 4], "azimuth": 30}, "clip": {"planes": [[1, 0, 0, 4]]},
    "light": {"ambient": [1, 0.5, 0.25], "sources": [{"type": "cone", "theta": 30, "axis": [0, 0, 1]}]}})";
  const std::string lit = R"({"volume": {"file": "ball.vdb"}, "transfer": "smoke", "model": "lights",
    "light": {"sources": [{"type": "environment", "file": "FILE"}]}, "camera": {"size": [2, 2]}})";
  writeBytes(at.folder.path() / "lit.json", [&] {
    std::string text = lit;
    return text.replace(text.find("FILE"), 4, "sky-damaged.exr");
  }());
  const auto bytes = [&](const char* name) { return readBytes(at.folder.path() / name); };
  std::vector<Subject> all{
      {"ball-damaged.vdb", bytes("ball.vdb"), "convert FILE -o out.vdb", "out.vdb"},
      {"info-damaged.vdb", bytes("ball.vdb"), "info FILE --json", ""},
      {"ball-damaged.nvdb", bytes("ball.nvdb"), "convert FILE -o out.vdb", "out.vdb"},
      {"tf-damaged.json", bytes("ball.json"), "reference ball.vdb --tf FILE " + reference, "out.exr"},
      {"scene-damaged.json", scene, "reference FILE -o out.exr", "out.exr"},
      {"sky-damaged.exr", bytes("sky.exr"), "reference lit.json -o out.exr", "out.exr"},
  };
  for (const auto& [kind, extension] : std::vector<std::pair<std::string, std::string>>{{"dicom", ".dcm"},
                                                                                        {"hdf5", ".h5"},
                                                                                        {"metaimage", ".mha"},
                                                                                        {"nifti", ".nii"},
                                                                                        {"npy", ".npy"},
                                                                                        {"nrrd", ".nrrd"},
                                                                                        {"png", ".png"},
                                                                                        {"tiff", ".tif"},
                                                                                        {"vti", ".vti"},
                                                                                        {"vtk", ".vtk"}})
    all.push_back({kind + extension, corpus(kind + "/seed"), "convert FILE -o out.vdb", "out.vdb"});
  return all;
}

// Changes some bytes, most of them near the beginning, where headers are; cuts, repeats or takes out a part.
std::string damaged(std::string bytes, Random& rng) {
  const auto below = [&](std::size_t end) {
    return std::min(static_cast<std::size_t>(rng.uniform() * static_cast<double>(end)), end - 1);
  };
  const std::size_t changes = 1 + below(4);
  for (std::size_t i = 0; i < changes && !bytes.empty(); ++i) {
    const std::size_t at = below(rng.uniform() < 0.7 ? std::min<std::size_t>(bytes.size(), 600) : bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(16, bytes.size() - at));
    switch (below(7)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes[at] = '\xff';
        break;
      case 3:
        bytes.resize(at);
        break;
      case 4:
        bytes.erase(at, length);
        break;
      case 5:
        bytes.insert(at, bytes.substr(at, length));
        break;
      default:
        bytes.replace(at, length, std::string(length, '9'));
    }
  }
  return bytes;
}

long fromEnvironment(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atol(text) : otherwise;
}

}  // namespace

// Some 40 seconds on two cores; a nightly run sets more (tests/fuzz/nightly).
TEST_CASE("Files that are damaged at random are read or refused in one line, and nothing else happens",
          "[tools][fuzz]") {
  const long count = fromEnvironment("UMBRICK_MUTATIONS", 192), seed = fromEnvironment("UMBRICK_MUTATION_SEED", 1);
  const double mostMs = fromEnvironment("UMBRICK_MUTATION_SECONDS", 50) * 1000.0;
  const BallWorkplace at;
  const std::vector<Subject> all = subjects(at);
  Random rng(static_cast<std::uint64_t>(seed));
  const Stopwatch time;
  long done = 0, read = 0;
  for (; done < count && time.elapsedMs() < mostMs; ++done) {
    const Subject& subject = all[static_cast<std::size_t>(done) % all.size()];
    writeBytes(at.folder.path() / subject.name, damaged(subject.bytes, rng));
    const std::size_t files = filesIn(at.folder);
    std::string arguments = subject.arguments;
    if (const std::size_t place = arguments.find("FILE"); place != arguments.npos)
      arguments.replace(place, 4, subject.name);
    const ProgramResult result = at.run(arguments);
    const auto lines = std::count(result.err.begin(), result.err.end(), '\n');
    const bool made = !subject.output.empty() && fs::exists(at.folder.path() / subject.output);
    bool good = result.status == 0 ? (made || subject.output.empty())
                                   : (result.status == 1 || result.status == 2) && !made && lines <= 2 &&
                                         result.err.find("umbrick: ") != std::string::npos;
    good = good && filesIn(at.folder) == files + (made ? 1 : 0);
    if (!good) {
      // What fails is kept, beside what repeats it.
      const fs::path kept =
          fs::temp_directory_path() / ("umbrick-mutation-" + std::to_string(done) + "-" + subject.name);
      fs::copy_file(at.folder.path() / subject.name, kept, fs::copy_options::overwrite_existing);
      CAPTURE(seed, done, arguments, kept, result.status, result.err);
      CHECK(good);
    }
    if (result.status == 0) ++read;
    if (made) fs::remove(at.folder.path() / subject.output);
    fs::remove(at.folder.path() / subject.name);
  }
  WARN("seed " << seed << ": " << done << " damaged files, of which " << read << " were read all the same");
  CHECK(done > 0);
}
