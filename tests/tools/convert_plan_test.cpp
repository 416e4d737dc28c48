// What a conversion would make, without making it.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "tools/program.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("A plan of a small volume says what the conversion then says, and writes nothing", "[tools]") {
  const TemporaryFolder folder;
  const std::string head = "convert " + kHead + "--clip-below 501 ";
  const ProgramResult plan = runProgram(folder, head + "--plan");
  CHECK(plan.status == 0);
  CHECK(plan.err.empty());
  CHECK_THAT(plan.out, Contains("from 100 % of its voxels: 12 of 12 layers of 8 slices\n") &&
                           Contains("active voxels   2299643 of 6160384 (37.33 %)\n") && Contains(" MB, blosc\n"));
  CHECK(filesIn(folder) == 0);
  CHECK_THAT(runProgram(folder, head + "--plan --crop 0 0 0 255 255 7 --max-error 1 --codec zip -o o.vdb").out,
             Contains("1 of 1 layers") && Contains("stored as       half") && Contains(" MB, zip\n"));
  CHECK(filesIn(folder) == 0);
}

TEST_CASE("A plan of a large volume reads a tenth of it", "[tools]") {
  const TemporaryFolder folder;
  // 256 x 256 x 400 voxels, of which none takes room on the disk.
  CHECK(std::system(("truncate -s 26214400 '" + (folder.path() / "v.raw").string() + "'").c_str()) == 0);
  CHECK_THAT(runProgram(folder, "convert v.raw --dims 256 256 400 --type u8 --plan").out,
             Contains("plan of v.raw, from 10 % of its voxels: 5 of 50 layers of 8 slices\n") &&
                 Contains("active voxels   0 +- 4718592 of 26214400 (0.00 %)\n"));
  CHECK_THAT(runProgram(folder, "convert v.raw --dims 256 256 400 --type u8 --plan --background 1").out,
             Contains("active voxels   26214400 of 26214400 (100.00 %)\n") && Contains("leaves          0\n"));
}

TEST_CASE("Plans of what cannot be planned are wrong usage", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", "abcdefgh");
  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    CHECK(expectRefusal(folder, "convert " + arguments, status, message).out.empty());
  };
  const std::string raw = " --dims 2 2 2 --type u8 ";
  refused("v.raw" + raw, 2, "--output is required");
  refused("v.raw --plan --verify" + raw, 2, "--verify excludes --plan");
  refused("v%d.raw --plan" + raw, 2, "--plan: expected volumes, found a sequence: v%d.raw");
  refused("v.raw --plan --frames 2" + raw, 2, "--plan: expected volumes, found a sequence");
  refused("'" UMBRICK_ASSETS "/densityAndHeat.vdb' --plan", 2, "--plan is for volumes: of a grid umbrick info tells");
  refused("v.raw --plan --dims 2 2 3 --type u8", 1, "v.raw: expected 2 x 2 x 3 u8 = 12 bytes, found 8");
}
