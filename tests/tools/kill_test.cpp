// Ends the program at random moments, many times: what it writes is the old file or the new one, and whole.
//   UMBRICK_KILLS=1000 ctest -L kill    ends it so often in each test case, in place of 40 times
//   UMBRICK_SEED=2                      at other moments
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tools/ball_workplace.h"
#include "tools/ended.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

int numberOf(const char* variable, int usual) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : usual;
}

// What is written to, and the commands that write the old and the new content.
struct Job {
  std::vector<std::string> files;
  std::string before, after;
};

std::vector<Job> jobs() {
  const std::string picture = "reference ball.vdb --tf ball.json --size 40x40 --azimuth 0 --up z ";
  const auto pictures = [&](const std::string& file) {
    return Job{
        {file}, picture + "--model emission -o " + file, picture + "--model emission --sigma-scale 2 -o " + file};
  };
  const auto grids = [](const std::vector<std::string>& files) {
    const std::string convert = "convert ball.vdb -o " + files.front();
    return Job{files, convert, convert + " --threshold 0.5"};
  };
  return {pictures("a.png"), pictures("a.exr"),         grids({"a.nvdb"}),
          grids({"a.nrrd"}), grids({"a.mhd", "a.raw"}), grids({"a.vdb"})};
}

// A job in a folder of its own, with the content that its files have before and after it.
class Bench {
 public:
  explicit Bench(const Job& job) : job_(job) {
    using Clock = std::chrono::steady_clock;
    after_ = contentOf(job.after);
    before_ = contentOf(job.before);
    // The shortest of some runs, since moments are wanted amid the work also where the machine was busy once.
    for (int i = 0; i < 3; ++i) {
      const auto begin = Clock::now();
      contentOf(job.before);
      seconds_ = std::min(seconds_, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    files_ = filesIn(at_.folder);
  }
  const TemporaryFolder& folder() const { return at_.folder; }
  /// Puts the old content there, starts the job, and waits for a moment of it.
  pid_t start(std::mt19937& random) {
    for (const auto& [name, bytes] : stored_) writeBytes(at_.folder.path() / name, bytes);
    const pid_t program = startProgram(at_.folder, job_.after);
    const double share = std::uniform_real_distribution(0.0, 1.1)(random);
    std::this_thread::sleep_for(std::chrono::duration<double>(share * seconds_));
    return program;
  }
  /// Tells whether the old or the new content stands there, whole. @param isNew  becomes whether it is the new one
  bool isWhole(bool& isNew) {
    const std::string now = content();
    isNew = now == after_;
    return isNew || now == before_;
  }
  /// Runs the job to its end. @return whether its files are all that is there
  bool finish() {
    for (const char* name : {".out", ".err"}) fs::remove(at_.folder.path() / name);
    return contentOf(job_.after) == after_ && filesIn(at_.folder) == files_;
  }
  bool hasLeftovers() {
    for (const char* name : {".out", ".err"}) fs::remove(at_.folder.path() / name);
    return filesIn(at_.folder) != files_;
  }

 private:
  // The bytes of all files of the job. Since a .vdb has an identity of its own, its grids stand for it; and a pair
  // whose writer was killed amid its steps may have its data elsewhere, so that what is read of it counts.
  std::string content() const {
    const std::string& first = job_.files.front();
    if (first == "a.vdb") {
      const std::string info = at_.run("info a.vdb").out;
      return info.substr(std::min(info.size(), info.find('\n')));
    }
    if (first != "a.mhd") return readBytes(at_.folder.path() / first);
    const std::string header = readBytes(at_.folder.path() / first);
    const std::size_t name = header.find("ElementDataFile = ") + 18;
    const std::string data = header.substr(name, header.find('\n', name) - name);
    return header.substr(0, name) + readBytes(at_.folder.path() / data);
  }
  std::string contentOf(const std::string& command) {
    const ProgramResult result = at_.run(command);
    INFO(command << ": " << result.err);
    REQUIRE(result.status == 0);
    for (const std::string& file : job_.files) stored_[file] = readBytes(at_.folder.path() / file);
    return content();
  }

  BallWorkplace at_;
  Job job_;
  std::string before_, after_;
  std::map<std::string, std::string> stored_;  // of what was written last
  double seconds_ = 1e9;
  std::size_t files_ = 0;
};

}  // namespace

TEST_CASE("A program killed at any moment leaves the old or the new file, and the next one nothing else",
          "[tools][kill][slow]") {
  const int kills = numberOf("UMBRICK_KILLS", 40);
  std::mt19937 random(static_cast<unsigned>(numberOf("UMBRICK_SEED", 1)));
  int done = 0, replaced = 0;
  for (const Job& job : jobs()) {
    Bench bench(job);
    for (int i = 0; i < kills; ++i) {
      CAPTURE(job.after, i);
      const pid_t program = bench.start(random);
      ::kill(program, SIGKILL);
      waitFor(program);
      bool isNew = false;
      CHECK(bench.isWhole(isNew));
      ++done;
      replaced += isNew;
      if (i % 10 == 9) {
        CHECK(bench.finish());
        bool ignored = false;
        CHECK(bench.isWhole(ignored));
      }
    }
  }
  // The moments are spread over the work: neither are all of them before its end nor after it.
  CAPTURE(done, replaced);
  CHECK(replaced > 0);
  CHECK(replaced < done);
}

TEST_CASE("A program ended by a signal at any moment leaves the old or the new file and nothing else",
          "[tools][kill][slow]") {
  const int kills = numberOf("UMBRICK_KILLS", 40);
  std::mt19937 random(static_cast<unsigned>(numberOf("UMBRICK_SEED", 1)) + 1);
  for (const Job& job : jobs()) {
    Bench bench(job);
    for (int i = 0; i < kills; ++i) {
      const int number = std::array{SIGINT, SIGTERM, SIGHUP}[static_cast<std::size_t>(i) % 3];
      CAPTURE(job.after, i, number);
      const pid_t program = bench.start(random);
      ::kill(program, number);
      waitFor(program);
      CHECK_FALSE(bench.hasLeftovers());
      bool isNew = false;
      // What is done of a reference is kept, and its picture is neither the old nor the new one then.
      if (!job.after.starts_with("reference")) CHECK(bench.isWhole(isNew));
    }
  }
}

TEST_CASE("Programs that write one pair at the same time leave the pair of one of them", "[tools][kill][slow]") {
  const int rounds = numberOf("UMBRICK_KILLS", 40) / 4;
  const BallWorkplace at;
  const auto pair = [&] { return readBytes(at.folder.path() / "a.mhd") + readBytes(at.folder.path() / "a.raw"); };
  const std::string ways[]{"--threshold 0.2", "--threshold 0.5", "--threshold 0.8"};
  std::vector<std::string> wanted;
  for (const std::string& way : ways) {
    REQUIRE(at.run("convert ball.vdb -o a.mhd " + way).status == 0);
    wanted.push_back(pair());
  }
  const std::size_t before = filesIn(at.folder);
  for (int i = 0; i < rounds; ++i) {
    std::vector<pid_t> programs;
    for (const std::string& way : ways) programs.push_back(startProgram(at.folder, "convert ball.vdb -o a.mhd " + way));
    for (const pid_t program : programs) CHECK(waitFor(program) == 0);
    takeResult(at.folder, 0);
    CHECK(std::count(wanted.begin(), wanted.end(), pair()) == 1);
    CHECK(filesIn(at.folder) == before);
  }
}
