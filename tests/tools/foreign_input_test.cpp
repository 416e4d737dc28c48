// What others send, by any name: what is refused, what is escaped, and what files may name.
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/sanitized.h"
#include "tools/ball_workplace.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string kReferenceOptions = "--size 8x8 --model emission --azimuth 0 --elevation 0 --up z ";

bool isPlain(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7f;
  });
}

std::string nhdr(const std::string& dataFile, const std::string& more = "") {
  return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n" + more + "data file: " + dataFile + "\n";
}

}  // namespace

TEST_CASE("Pipes and devices are no scene, transfer function, environment or header", "[tools][foreign]") {
  const BallWorkplace at;
  const fs::path& folder = at.folder.path();
  for (const char* name : {"pipe.json", "pipe.nrrd", "pipe.exr"}) REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
  for (const char* name : {"zero.json", "zero.nrrd", "zero.exr"}) fs::create_symlink("/dev/zero", folder / name);
  writeBytes(folder / "lit.json", R"({"volume": {"file": "ball.vdb"}, "model": "lights",
      "light": {"sources": [{"type": "environment", "file": "zero.exr"}]}})");
  const std::string pipe = "is a pipe", device = "is a device";
  expectRefusal(at.folder, "reference pipe.json -o a.exr", 1, pipe);
  expectRefusal(at.folder, "reference zero.json -o a.exr", 1, device);
  expectRefusal(at.folder, "reference /proc/self/environ -o a.exr", 1, "made up by the system");
  expectRefusal(at.folder, "reference lit.json -o a.exr", 1, device);
  expectRefusal(at.folder, "reference ball.vdb --tf pipe.json " + kReferenceOptions + "-o a.exr", 1, pipe);
  expectRefusal(at.folder, "reference ball.vdb --tf /dev/zero " + kReferenceOptions + "-o a.exr", 1, device);
  REQUIRE(mkfifo((folder / "pipe.vdb").c_str(), 0600) == 0);
  expectRefusal(at.folder, "info pipe.vdb", 1, "found a pipe or device");
  expectRefusal(at.folder, "convert pipe.nrrd -o a.vdb", 1, pipe);
  expectRefusal(at.folder, "convert zero.nrrd -o a.vdb", 1, device);
  expectRefusal(at.folder, "compare zero.exr pipe.exr", 1, device);
  // Headerless raw is read from a pipe, as ever.
  const ProgramResult piped = runProgram(at.folder, "convert /dev/stdin --dims 4 4 4 --type u8 -o a.vdb < /dev/null");
  CHECK(piped.status == 1);
}

TEST_CASE("Each input of each command refuses links to what is no ordinary file", "[tools][foreign]") {
  const BallWorkplace at;
  const fs::path& folder = at.folder.path();
  REQUIRE(at.run("reference ball.vdb --tf ball.json " + kReferenceOptions + "-o good.exr -o good.png").status == 0);
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  const std::string shown = "ball.vdb --azimuth 0 --elevation 0 --up z ", study = "study " + shown + "--quick --tf ";
  const std::vector<std::string> commands{"convert x.nrrd -o a.vdb",
                                          "convert x.nvdb -o a.vdb",
                                          "convert x.tif -o a.vdb",
                                          "convert x.h5 -o a.vdb",
                                          "convert x.mhd -o a.vdb",
                                          "convert header.nhdr -o a.vdb",
                                          "convert header.mhd -o a.vdb",
                                          "convert ball.vdb --mask x.nrrd -o a.vdb",
                                          "convert ball.vdb --mask x.vdb -o a.vdb",
                                          "info x.nii",
                                          "info x.vdb",
                                          "tf auto x.vti -o a.json",
                                          "compare x.exr good.exr",
                                          "compare good.exr x.exr",
                                          "compare good.png x.png",
                                          "reference x.json -o a.exr",
                                          "render x.json -o a.exr",
                                          "render " + shown + "--tf x.json -o a.exr",
                                          "render lit.json -o a.exr",
                                          "check x.nrrd",
                                          "check x.json",
                                          "check " + shown + "--tf x.json",
                                          study + "smoke --compare x.json -o a",
                                          study + "smoke -o report",
                                          study + "x.json -o a"};
  writeBytes(folder / "header.nhdr", nhdr("x.raw"));
  writeBytes(folder / "header.mhd",
             "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n"
             "ElementDataFile = x.raw\n");
  writeBytes(folder / "lit.json", R"({"volume": {"file": "ball.vdb"}, "transfer": "smoke", "model": "lights",
      "light": {"sources": [{"type": "environment", "file": "x.exr"}]}})");
  fs::create_directory(folder / "report");
  std::vector<fs::path> links{"report/study.json"};
  for (const char* extension : {"nrrd", "nvdb", "vdb", "tif", "h5", "mhd", "nii", "vti", "exr", "png", "json", "raw"})
    links.push_back(std::string("x.") + extension);
  for (const fs::path& target : {fs::path("/dev/zero"), fs::path("/dev/full"), folder / "pipe",
                                 fs::path("/proc/self/environ"), fs::path("/proc/self/status")}) {
    for (const fs::path& link : links) {
      fs::remove(folder / link);
      fs::create_symlink(target, folder / link);
    }
    const std::size_t files = filesIn(at.folder);
    for (const std::string& command : commands) {
      // What would be read without end is ended, with the status 124.
      const ProgramResult result = runShell(at.folder, "timeout 100 $umbrick " + command);
      CAPTURE(target, command, result.err);
      CHECK(result.status == 1);
      CHECK(result.out.empty());
      CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
      CHECK_THAT(result.err, Contains("cannot read: is ") || Contains("found a pipe or device") ||
                                 Contains("found other first bytes") || Contains("is read-only; --force"));
      CHECK(filesIn(at.folder) == files);
    }
  }
}

TEST_CASE("A name that is no UTF-8 is escaped in what is written about it", "[tools][foreign]") {
  const BallWorkplace at;
  const std::string name = "b\xe9ll\x1b[2J";
  fs::copy_file(at.folder.path() / "ball.vdb", at.folder.path() / (name + ".vdb"));
  const ProgramResult made = at.run("reference '" + name + ".vdb' --tf ball.json " + kReferenceOptions +
                                    "-o a.exr -o a.png --stats a.stats.json");
  CHECK(made.status == 0);
  CHECK(isPlain(made.err));
  const std::string scene = at.exr("a.exr").metadata.at("umbrick.scene");
  CHECK_THAT(nlohmann::json::parse(scene)["volume"]["file"].get<std::string>(), Contains("b\\xe9ll\x1b[2J.vdb"));
  CHECK(at.json("a.stats.json")["scene"]["volume"]["file"].get<std::string>().find("\\xe9") != std::string::npos);
  const ProgramResult info = at.run("info '" + name + ".vdb'");
  CHECK(info.status == 0);
  CHECK_THAT(info.out, Contains("b\\xe9ll\\x1b[2J.vdb: "));
  CHECK(isPlain(info.out));
  const ProgramResult none = at.run("convert '" + name + ".nrrd' -o x.vdb");
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("b\\xe9ll\\x1b[2J.nrrd: "));
  CHECK(isPlain(none.err));
}

TEST_CASE("Control characters of a header reach no terminal", "[tools][foreign]") {
  const TemporaryFolder folder;
  const std::string evil = "\x1b]0;owned\x07\x1b[31m";
  writeBytes(folder.path() / "a.nhdr", nhdr("a.raw", "content: " + evil + "\nspace: " + evil + "\n"));
  writeBytes(folder.path() / "b.nhdr", nhdr(evil));
  writeBytes(folder.path() / "c.mhd", "ObjectType = Image\nNDims = " + evil + "\n");
  writeBytes(folder.path() / "d.json", "{\"" + evil + "\": 1}");
  writeBytes(folder.path() / "a.raw", std::string(64, '\1'));
  for (const char* arguments : {"convert a.nhdr -o a.vdb", "convert b.nhdr -o b.vdb", "convert c.mhd -o c.vdb",
                                "reference d.json -o d.exr", "info a.vdb", "convert a.nhdr a.nhdr --name x -o y.vdb"}) {
    const ProgramResult result = runProgram(folder, arguments);
    CAPTURE(arguments, result.out, result.err);
    CHECK(isPlain(result.out));
    CHECK(isPlain(result.err));
  }
  // A line end in a name makes no second line.
  const std::string broken = "a\numbrick: all is well\n.nhdr";
  writeBytes(folder.path() / broken, "no header");
  const ProgramResult result = runProgram(folder, "convert '" + broken + "' -o x.vdb");
  CHECK(result.status == 1);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
}

// libhdf5 says as the process ends that it could not close all, in a line of a hundred words.
TEST_CASE("What libraries print as the program ends is no line of its own", "[tools][foreign]") {
  if (kSanitized) return;  // sanitizers write to stderr themselves, so that the program leaves it as it is
  const TemporaryFolder folder;
  fs::copy_file(fs::path(UMBRICK_FUZZ_CORPUS) / "hdf5" / "closing-library", folder.path() / "a.h5");
  expectRefusal(folder, "convert a.h5 -o a.vdb", 1, "a.h5: expected an HDF5 file, found: ");
}

TEST_CASE("A MetaImage of any name reads back, or is refused", "[tools][foreign]") {
  const BallWorkplace at;
  for (const std::string name : {"list of", " blank", "LIST", "a % b", "\"quoted\" x", "b\xe9", "tab\there", "100%"}) {
    CAPTURE(name);
    const ProgramResult made = at.run("convert ball.vdb -o '" + name + ".mhd' --verify");
    if (name == "a % b") {
      CHECK(made.status != 0);
      CHECK_THAT(made.err, Contains("found one with both a % and a blank"));
      continue;
    }
    CHECK(made.err == "");
    CHECK(at.run("convert '" + name + ".mhd' -o back.vdb").status == 0);
  }
  const ProgramResult broken = at.run("convert ball.vdb -o 'a\nb.mhd'");
  CHECK(broken.status != 0);
  CHECK_THAT(broken.err, Contains("an end of line"));
  CHECK_FALSE(fs::exists(at.folder.path() / "a\nb.mhd"));
}

TEST_CASE("With --beside-only, files of others name nothing but their own", "[tools][foreign]") {
  const BallWorkplace at;
  const fs::path in = at.folder.path() / "in";
  fs::create_directory(in);
  fs::copy_file(at.folder.path() / "ball.vdb", in / "own.vdb");
  writeBytes(at.folder.path() / "a.raw", std::string(64, '\1'));
  writeBytes(in / "a.nhdr", nhdr("../a.raw"));
  CHECK(at.run("convert in/a.nhdr -o a.vdb").status == 0);
  expectRefusal(at.folder, "convert in/a.nhdr --beside-only -o b.vdb", 1, "expected only files beside or below it");
  const auto scene = [&](const std::string& volume, const std::string& transfer) {
    writeBytes(in / "s.json", R"({"volume": {"file": ")" + volume + R"("}, "transfer": ")" + transfer +
                                  R"(", "model": "emission", "camera": {"size": [8, 8]}})");
  };
  const auto run = [&](const std::string& more) { return at.run("reference in/s.json " + more + "-o a.exr"); };
  const std::string beside = "expected a file beside or below the scene";
  scene("own.vdb", "fog");
  scene("own.vdb", "smoke");
  CHECK(run("--beside-only ").status == 0);
  scene("../ball.vdb", "smoke");
  CHECK(run("").status == 0);
  CHECK_THAT(run("--beside-only ").err, Contains("volume.file: " + beside));
  scene("own.vdb", "../ball.json");
  CHECK(run("").status == 0);
  CHECK_THAT(run("--beside-only ").err, Contains("transfer: " + beside));
  // The volume that a scene names is kept to its folder as well.
  scene("a.nhdr", "smoke");
  CHECK(run("").status == 0);
  CHECK_THAT(run("--beside-only ").err, Contains("expected only files beside or below it"));
}

TEST_CASE("A scene that is somebody's private file is not quoted", "[tools][foreign]") {
  const TemporaryFolder folder;
  for (const std::string text : {"root:$6$abcd:1:2:3:::\n", "{\"aws_secret\": \"AKIAabcd\"}", "AKIAabcd = 7\n"}) {
    writeBytes(folder.path() / "private.json", text);
    const ProgramResult result = runProgram(folder, "reference private.json -o a.exr");
    CAPTURE(text, result.err);
    CHECK(result.status == 1);
    for (const char* secret : {"root", "$6$", "aws", "AKIA", "abcd"}) CHECK_THAT(result.err, !Contains(secret));
  }
}
