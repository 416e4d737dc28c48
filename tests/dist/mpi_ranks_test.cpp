// umbrick render under mpirun, whose ranks share frames and samples.
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/sanitized.h"
#include "tools/frames_workplace.h"
#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Tells whether ranks can be started, or says why they cannot.
bool canStartRanks() {
  std::string why = UMBRICK_MPI_MISSING;
  if (why.empty() && std::system("mpirun --version >/dev/null 2>&1") != 0) why = "mpirun (openmpi-bin) is missing";
  // Open MPI leaves memory to the end of the process, in libraries that are unloaded by then.
  if (why.empty() && kSanitized) why = "the leak check takes what MPI keeps to its end for leaks";
  if (!why.empty()) std::cout << "SKIPPED: " << why << '\n';
  return why.empty();
}

struct MpiWorkplace : FramesWorkplace {
  // Writes a script that is one of the ranks, and returns what starts them. Each leaves its number as a process.
  std::string ranks(int count, const std::string& arguments) const {
    writeBytes(folder.path() / ".rank",
               "echo $$ >.pid.$OMPI_COMM_WORLD_RANK\nexec '" UMBRICK_PROGRAM "' " + arguments + "\n");
    const std::string asRoot = getuid() == 0 ? "--allow-run-as-root " : "";
    return "mpirun " + asRoot + "--oversubscribe --bind-to none -n " + std::to_string(count) + " sh .rank";
  }
  ProgramResult runRanks(int count, const std::string& arguments) const {
    ProgramResult result = runShell(folder, ranks(count, arguments));
    INFO(arguments << ": " << result.err);
    return result;
  }
  std::string bytes(const std::string& name) const { return readBytes(folder.path() / name); }
};

// The lines that the program says of errors.
std::size_t complaints(const std::string& err) { return count("\n" + err, "\numbrick: "); }

}  // namespace

TEST_CASE("Ranks draw the frames of a sequence as one process does, and one of them speaks", "[dist]") {
  if (!canStartRanks()) return;
  const MpiWorkplace at;
  for (const int n : {1, 2, 3, 4, 6, 7}) at.addFrame(n);
  at.addFrame(5, "1 1 2");  // unlike the others
  const std::string job =
      "f_%02d.nrrd --backend cpu --skip-missing --overwrite --samples 2 --shutter 0.5 --orbit 90 " + kSeen;
  const ProgramResult one = at.render(job + "-o a_%d.exr --stats a.json");
  const ProgramResult many = at.runRanks(3, "render " + job + "-o b_%d.exr --stats b.json");
  CHECK(many.status == 0);
  CHECK(many.out == "b_1.exr\nb_2.exr\nb_3.exr\nb_4.exr\nb_6.exr\nb_7.exr\n");
  CHECK(count(many.err, "frame 5: f_05.nrrd: its voxels are of another size") == 1);
  CHECK(count(many.err, "\n") == count(one.err, "\n"));
  for (const int n : {1, 2, 3, 4, 6, 7}) {
    const std::string name = "_" + std::to_string(n) + ".exr";
    CHECK((at.pixels("a" + name) == at.pixels("b" + name)));
    CHECK(at.sceneOf("a" + name) == at.sceneOf("b" + name));
  }
  const auto stats = nlohmann::json::parse(at.bytes("b.json")), own = nlohmann::json::parse(at.bytes("a.json"));
  REQUIRE(stats.size() == own.size());
  for (std::size_t i = 0; i < own.size(); ++i) CHECK(stats[i].at("frame") == own[i].at("frame"));
}

TEST_CASE("Ranks draw the samples of a picture as one process does", "[dist]") {
  if (!canStartRanks()) return;
  const MpiWorkplace at;
  at.addFrame(4);
  const std::string job = "render f_04.nrrd --backend cpu --samples 7 --layers " + kSeen;
  REQUIRE(at.run(job + "-o a.exr").status == 0);
  const ProgramResult many = at.runRanks(2, job + "-o b.exr --stats b.json");
  CHECK(many.status == 0);
  CHECK(many.out == "b.exr\n");
  const ExrFile a = readExr(at.folder.path() / "a.exr"), b = readExr(at.folder.path() / "b.exr");
  REQUIRE(a.layers.size() == b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    CHECK(a.layers[i].name == b.layers[i].name);
    CHECK((a.layers[i].image.pixels == b.layers[i].image.pixels));
  }
  CHECK(a.metadata.at("umbrick.scene") == b.metadata.at("umbrick.scene"));
  CHECK(nlohmann::json::parse(at.bytes("b.json")).at("ranks") == 2);
}

TEST_CASE("A rank that is killed ends the job in one line and leaves whole frames", "[dist]") {
  if (!canStartRanks()) return;
  const MpiWorkplace at;
  at.addFrame(4);
  // So many frames that the job cannot end before.
  const std::string job =
      "render f_04.nrrd --backend cpu --count 3000 --orbit 360 --samples 8 " + kSeen + "-o o_%04d.exr";
  const ProgramResult killed = runShell(at.folder, at.ranks(3, job) +
                                                       " & until [ -e o_0005.exr ]; do sleep 0.02; done; "
                                                       "kill -9 $(cat .pid.1); wait $!");
  CHECK(killed.status != 0);
  CHECK(complaints(killed.err) == 1);
  CHECK_THAT(killed.err, Contains("umbrick: interrupted after ") && Contains("the same command goes on"));
  std::vector<int> there;
  for (int i = 0; i < 3000; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "o_%04d.exr", i);
    if (!at.has(name)) continue;
    there.push_back(i);
    CHECK(at.pixels(name).size() == 40 * 30 * 4);  // or else it throws
  }
  CHECK(there.size() >= 3);
  CHECK(there.size() < 3000);
  CHECK_FALSE(at.has("o_2999.exr"));
}

TEST_CASE("What is wrong is said once, however many ranks there are", "[dist]") {
  if (!canStartRanks()) return;
  const MpiWorkplace at;
  for (const int n : {1, 2, 3, 4}) at.addFrame(n);
  writeBytes(at.folder.path() / "f_03.nrrd", header("dimension: 3\nsizes: 12 12 12\n") + "short");
  const auto refused = [&](const std::string& arguments, int status, const std::string& what) {
    const ProgramResult result = at.runRanks(2, arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.status == status);
    CHECK(complaints(result.err) == 1);
    CHECK_THAT(result.err, Contains("umbrick: " + what));
    CHECK(result.out.empty());
  };
  refused("render f_01.nrrd --fov 500 -o o.png", 1, "--fov");
  refused("render f_%02d.nrrd --backend cpu --frames 1-4 " + kSeen + "-o -", 2,
          "-: the frames of 2 ranks have no order on a stream");
  // One rank meets the error of a frame; frames before it are there.
  const ProgramResult damaged = at.runRanks(2, "render f_%02d.nrrd --backend cpu " + kSeen + "-o o_%d.exr");
  CAPTURE(damaged.err);
  CHECK(damaged.status == 1);
  CHECK(complaints(damaged.err) == 1);
  CHECK_THAT(damaged.err, Contains("f_03.nrrd"));
}
