// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/program.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

struct Failing {
  TemporaryFolder folder;
  // One line of message, the status, and no file left behind.
  void check(const std::string& arguments, int status, const std::string& message) const {
    CAPTURE(arguments);
    const std::size_t before = filesIn(folder);
    const ProgramResult result = runProgram(folder, arguments);
    CHECK(result.status == status);
    CHECK_THAT(result.err, Contains(message));
    CHECK(result.out.empty());
    if (status == 1) CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(filesIn(folder) == before);
  }
};

}  // namespace

TEST_CASE("The head scan converts, and info tells what is in the result", "[tools]") {
  const TemporaryFolder folder;
  const ProgramResult convert =
      runProgram(folder, "convert " + kHead +
                             "--spacing 0.8 0.8 1.5 --origin -100 -100 10 --clip-below 501 --name ct -o head.vdb");
  CHECK(convert.status == 0);
  CHECK(convert.err.empty());  // no progress bar in a pipe
  CHECK_THAT(convert.out, Contains("2299643 of 6160384 (37.33 %)") && Contains("maximum error   0"));
  const ProgramResult info = runProgram(folder, "info head.vdb --json --bins 4");
  REQUIRE(info.status == 0);
  const nlohmann::json parsed = nlohmann::json::parse(info.out);
  const nlohmann::json& grid = parsed.at("grids").at(0);
  CHECK(grid.at("name") == "ct");
  CHECK(grid.at("type") == "float");
  CHECK(grid.at("class") == "fog volume");
  CHECK(grid.at("active_voxels") == 2299643);
  CHECK(grid.at("values").at("min") == 501);
  CHECK(grid.at("values").at("max") == 4095);
  CHECK(grid.at("values").at("histogram").size() == 4);
  CHECK(grid.at("voxel_size").at(2).get<double>() == Approx(1.5));
  CHECK(grid.at("index_to_world").at(0).at(3) == -100);
  CHECK(grid.at("world_bounds").at("min").at(2).get<double>() ==
        Approx(10 + 1.5 * grid.at("index_box").at("min").at(2).get<double>()));
  CHECK_THAT(runProgram(folder, "info head.vdb").out, Contains("grid \"ct\"") && Contains("2299643"));
}

TEST_CASE("A .vdb converts to .vdb grid by grid", "[tools]") {
  const TemporaryFolder folder;
  CHECK(runProgram(folder, "convert " + kSmoke + "-o both.vdb").status == 0);
  CHECK(runProgram(folder, "convert " + kSmoke + "--grid heat --half --tolerance 0.01 -o heat.vdb").status == 0);
  const auto grids = [&](const std::string& file) {
    return nlohmann::json::parse(runProgram(folder, "info --json " + file).out).at("grids");
  };
  CHECK(grids("both.vdb").size() == 2);
  CHECK(grids("both.vdb").at(0).at("active_voxels") == 6124);
  CHECK(grids("heat.vdb").size() == 1);
  CHECK(grids("heat.vdb").at(0).at("saved_as_half") == true);
  CHECK(grids("heat.vdb").at(0).at("voxel_size") == grids("both.vdb").at(1).at("voxel_size"));
}

TEST_CASE("Formats are listed, told by their first bytes, and keep what they say about themselves", "[tools]") {
  const TemporaryFolder folder;
  const ProgramResult list = runProgram(folder, "convert --list-formats");
  CHECK(list.status == 0);
  CHECK_THAT(list.out, Contains("NIfTI and Analyze: .nii .nii.gz") && Contains("OpenVDB: .vdb"));
  const nlohmann::json parsed = nlohmann::json::parse(runProgram(folder, "convert --list-formats-json").out);
  CHECK(parsed.size() == static_cast<std::size_t>(std::count(list.out.begin(), list.out.end(), '\n')));
  writeBytes(folder.path() / "unnamed",
             "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nModality = MET_MOD_CT\n"
             "ElementDataFile = LOCAL\nabcdefgh");
  CHECK_THAT(runProgram(folder, "convert unnamed -o v.vdb").out, Contains("8 of 8"));
  CHECK_THAT(runProgram(folder, "info v.vdb").out,
             Contains("source_format  MetaImage\n") && Contains("source_file    unnamed\n") &&
                 Contains("modality       CT\n") && Contains("space          LPS\n"));
  CHECK(runProgram(folder, "convert unnamed --spacing 1 1 2 -o w.vdb").status == 2);
}

TEST_CASE("NRRD and pipes convert", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\nabcdefgh");
  CHECK_THAT(runProgram(folder, "convert v.nrrd -o v.vdb").out, Contains("8 of 8"));
  fs::rename(folder.path() / "v.nrrd", folder.path() / "unnamed");
  CHECK_THAT(runProgram(folder, "convert unnamed -o v.vdb").out, Contains("8 of 8"));
  writeBytes(folder.path() / "v.raw", "abcdefgh");
  CHECK_THAT(runProgram(folder, "convert /dev/stdin --dims 2 2 2 --type u8 -o v.vdb < v.raw").out, Contains("8 of 8"));
}

TEST_CASE("What is left out is chosen by the border, a threshold, a range, a mask and a box", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", "aaaaaaabcdefaaaa");
  writeBytes(folder.path() / "m.raw", std::string(7, '\0') + "\1\1" + std::string(7, '\0'));
  const auto convert = [&](const std::string& options) {
    return runProgram(folder, "convert v.raw --dims 16 1 1 --type u8 --verify -o v.vdb " + options).out;
  };
  CHECK_THAT(convert("--background auto"), Contains("background 97, ") && Contains("active voxels   5 of 16"));
  CHECK_THAT(convert("--threshold 97"), Contains("5 of 16"));
  CHECK_THAT(convert("--clip-below 97"), Contains("16 of 16"));
  CHECK_THAT(convert("--range 98 100"), Contains("3 of 16") && Contains("13 voxels, by up to 102"));
  CHECK_THAT(convert("--mask m.raw"), Contains("2 of 16") && Contains("masked          14 voxels"));
  CHECK_THAT(convert("--crop 6 0 0 8 0 0"), Contains("3 of 3"));
  CHECK_THAT(convert("--max-error 2"), Contains("stored as       half") && Contains("maximum error   0"));
}

TEST_CASE("Failed conversions exit 1 with one line and leave nothing behind", "[tools]") {
  const Failing failing;
  writeBytes(failing.folder.path() / "short.raw", std::string(100, 'x'));
  writeBytes(failing.folder.path() / "broken.vdb", readBytes(UMBRICK_ASSETS "/densityAndHeat.vdb").substr(0, 60000));
  const std::string raw = " --dims 4 5 6 --type u8 -o o.vdb";
  failing.check("convert none.raw" + raw, 1, "umbrick: none.raw: no such file");
  failing.check("convert short.raw" + raw, 1, "short.raw: expected 4 x 5 x 6 u8 = 120 bytes, found 100");
  failing.check("convert short.raw --dims 4 5 4 --type u8 --strict -o o.vdb", 1,
                "found 100; does it begin with a header");
  failing.check("convert ." + raw, 1, "expected a file, found a directory");
  failing.check("convert short.raw --dims 10 10 1 --type u8 -o none/o.vdb", 1, "none/o.vdb: cannot write");
  failing.check("convert none.nrrd -o o.vdb", 1, "none.nrrd: cannot read: No such file");
  failing.check("convert broken.vdb -o o.vdb", 1, "broken.vdb: truncated or corrupt");
  failing.check("convert " + kSmoke + "--grid smoke -o o.vdb", 1,
                "no grid \"smoke\": the file has \"density\" (float), \"heat\" (float)");
  failing.check("convert short.raw --dims 10 10 1 --type u8 --crop 0 0 0 9 10 0 -o o.vdb", 1,
                "inside (0 0 0) to (9 9 0), found (0 0 0) to (9 10 0)");
  failing.check("info broken.vdb", 1, "truncated or corrupt");
  failing.check("info short.raw", 1, "headerless raw");
  failing.check("info none.vdb", 1, "no such file");
  // No file says how much there is: what would not fit is refused before it is asked for.
  failing.check("convert /dev/zero --dims 1000000 1000000 8 --type u8 -o x.vdb", 1,
                "/dev/zero: dims: two slabs of 1000000 x 1000000 x 8 voxels take ");
}

TEST_CASE("Wrong usage exits 2", "[tools]") {
  const Failing failing;
  writeBytes(failing.folder.path() / "v.raw", std::string(120, 'x'));
  const std::string start = "convert v.raw -o o.vdb --dims 4 5 6 --type u8 ";
  failing.check("convert v.raw -o o.vdb", 2,
                "v.raw: taken for headerless raw, which needs dims and type: give --dims and --type");
  failing.check("convert v.raw", 2, "--output is required");
  failing.check("convert v.raw -o o.vdb --dims 4 5 --type u8", 2, "--dims");
  failing.check("convert v.raw -o o.vdb --dims 4 5 x --type u8", 2, "--dims");
  failing.check("convert v.raw -o o.vdb --dims 4 0 6 --type u8", 2, "dims: expected each from 1");
  failing.check("convert v.raw -o o.vdb --dims 4 -5 6 --type u8", 2, "dims: expected each from 1");
  failing.check("convert v.raw -o o.vdb --dims 4 5 6 --type u12", 2, "u12");
  failing.check("convert v.raw -o o.mha --dims 4 5 6 --type u8", 2, "ends in .vdb, .nvdb, .mhd or .nrrd");
  failing.check(start + "--spacing 1 0 1", 2, "spacing: expected positive");
  failing.check(start + "--spacing 1 nan 1", 2, "spacing: expected positive");
  failing.check(start + "--bits-stored 9", 2, "bits stored: expected 1 to 8");
  failing.check(start + "--range 3 2", 2, "expected the lower limit first, found 3 2");
  failing.check(start + "--half --max-error 1", 2, "--max-error");
  failing.check("convert v.vdb --name n -o o.vdb", 2, "--name is for volumes");
  failing.check("convert /dev/null -o o.vdb --dims 1 1 1 --type u8 --background auto", 2, "found a pipe");
  failing.check(start + "--tolerance -1", 2, "--tolerance");
  failing.check(start + "--background nan", 2, "--background");
  failing.check(start + "--endian middle", 2, "--endian");
  failing.check("convert v.nrrd --dims 4 5 6 --type u8 -o o.vdb", 2, "for headerless raw");
  failing.check("info", 2, "file is required");
  failing.check("info v.vdb --bins 0", 2, "--bins");
  failing.check("nonsense", 2, "");
}
