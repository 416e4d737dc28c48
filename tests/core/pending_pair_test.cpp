// What stands there when a program ends between two steps of writing a header and its data.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_pair.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <string_view>
#include <vector>

#include "support/files.h"
#include "support/temporary_folder.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

// The process ends before the call that changes a folder for which this is 0; less than 0 means that it never ends so.
int callsLeft = -1;
bool hardLinks = true;
std::string failingTarget;  // a rename to this name fails

void count() {
  if (callsLeft == 0) _exit(9);
  --callsLeft;
}

}  // namespace

// These take the place of the functions of the C library, for all of this program.
extern "C" int rename(const char* from, const char* to) noexcept {
  count();
  if (!failingTarget.empty() && to == failingTarget) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
extern "C" int linkat(int fromFolder, const char* from, int toFolder, const char* to, int flags) noexcept {
  count();
  const bool unnamed = std::string_view(from).starts_with("/proc/");  // every file may be given a first name
  if (hardLinks || unnamed) return static_cast<int>(syscall(SYS_linkat, fromFolder, from, toFolder, to, flags));
  errno = EPERM;
  return -1;
}
extern "C" int unlink(const char* path) noexcept {
  count();
  return unlinkat(AT_FDCWD, path, 0);
}

namespace {

struct Pair {
  TemporaryFolder folder;
  fs::path header = folder.path() / "v.mhd", data = folder.path() / "v.raw";

  void write(const std::string& version) const {
    PendingPair pending(header, data);
    pending.data().write(version + " voxels");
    pending.writeHeader([&](const std::string& name) { return version + ' ' + name; });
    CHECK(readBytes(pending.headerPath()) == version + ' ' + pending.data().path().filename().string());
    pending.commit();
  }
  // Writes a new pair in a process of its own, which ends before call number `calls`.
  // @return whether the process came to its end
  bool writeKilled(int calls) const {
    const pid_t child = fork();
    if (child == 0) {
      callsLeft = calls;
      write("new");
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  std::string version() const { return readBytes(header).substr(0, 3); }
  // Returns the content of the file that the header names.
  std::string voxels() const { return readBytes(folder.path() / readBytes(header).substr(4)); }
};

}  // namespace

TEST_CASE("A pair that is killed at any step is the old one or the new one", "[core]") {
  for (const bool old : {true, false}) {
    int calls = 0;
    for (bool done = false; !done; ++calls) {
      CAPTURE(old, calls);
      const Pair pair;
      if (old) pair.write("old");
      done = pair.writeKilled(calls);
      if (fs::exists(pair.header)) {
        CHECK(pair.voxels() == pair.version() + " voxels");
        if (done) CHECK(pair.version() == "new");
      } else {
        CHECK_FALSE((old || done));
      }
      if (done) CHECK(std::distance(fs::directory_iterator(pair.folder.path()), fs::directory_iterator()) == 2);
    }
    // The calls replace the header, make a second name, rename the data, replace the header, remove the first name.
    CHECK(calls >= 5);
  }
}

TEST_CASE("Where a file cannot have two names, no header describes other data than its own", "[core]") {
  hardLinks = false;
  int missing = 0, calls = 0;
  for (bool done = false; !done; ++calls) {
    const Pair pair;
    pair.write("old");
    done = pair.writeKilled(calls);
    const std::string voxels = pair.voxels();
    missing += voxels.empty();
    CHECK((voxels.empty() || voxels == pair.version() + " voxels"));
  }
  CHECK(missing == 1);  // between the renames of the data and of the header
  hardLinks = true;
}

TEST_CASE("A rename of the data that fails leaves the old pair, and nothing beside it", "[core]") {
  for (const bool old : {true, false}) {
    CAPTURE(old);
    const Pair pair;
    if (old) pair.write("old");
    failingTarget = pair.data.string();
    CHECK_THROWS_WITH(pair.write("new"), Catch::Contains("v.raw: cannot write: Input/output error"));
    failingTarget.clear();
    if (old) CHECK(pair.voxels() == "old voxels");
    CHECK(std::distance(fs::directory_iterator(pair.folder.path()), fs::directory_iterator()) == (old ? 2 : 0));
  }
}

TEST_CASE("After a pair that was killed at any step, the next one leaves two files", "[core]") {
  int calls = 0;
  for (bool done = false; !done; ++calls) {
    CAPTURE(calls);
    const Pair pair;
    pair.write("old");
    done = pair.writeKilled(calls);
    // The one that comes next may be killed before it begins to change anything, and spares what a header names.
    pair.writeKilled(0);
    CHECK(pair.voxels() == pair.version() + " voxels");
    pair.write("end");
    CHECK(pair.voxels() == "end voxels");
    std::string names;
    for (const auto& entry : fs::directory_iterator(pair.folder.path()))
      names += entry.path().filename().string() + ' ';
    CAPTURE(names);
    CHECK(std::distance(fs::directory_iterator(pair.folder.path()), fs::directory_iterator()) == 2);
  }
}

TEST_CASE("Many writers of one pair at once leave the pair of one of them", "[core]") {
  constexpr int kRounds = 10, kWriters = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Pair pair;
    std::vector<pid_t> writers;
    for (int i = 0; i < kWriters; ++i) {
      writers.push_back(fork());
      if (writers.back() > 0) continue;
      for (int turn = 0; turn < 5; ++turn) pair.write("w" + std::to_string(i) + std::to_string(turn));
      _exit(0);
    }
    for (const pid_t writer : writers) {
      int status = 0;
      waitpid(writer, &status, 0);
      CHECK(status == 0);
    }
    CHECK(pair.voxels() == pair.version() + " voxels");
    CHECK(std::distance(fs::directory_iterator(pair.folder.path()), fs::directory_iterator()) == 2);
  }
}

TEST_CASE("A pair is not written to a stream", "[core]") {
  const Pair pair;
  CHECK_THROWS_WITH(PendingPair("/dev/null", pair.data), Catch::Contains("is one file, where a pair has two"));
}

TEST_CASE("A pair that is not committed leaves the old one, and nothing beside it", "[core]") {
  const Pair pair;
  pair.write("old");
  {
    PendingPair pending(pair.header, pair.data);
    pending.data().write("half");
  }
  CHECK(pair.voxels() == "old voxels");
  CHECK(std::distance(fs::directory_iterator(pair.folder.path()), fs::directory_iterator()) == 2);
}
