// What stands there when a program ends between two steps of writing a header and its data.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_pair.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>

#include "support/files.h"
#include "support/temporary_folder.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

// The process ends before the call that changes a folder for which this is 0; less than 0 means that it never ends so.
int callsLeft = -1;
bool hardLinks = true;

void count() {
  if (callsLeft == 0) _exit(9);
  --callsLeft;
}

}  // namespace

// These take the place of the functions of the C library, for all of this program.
extern "C" int rename(const char* from, const char* to) noexcept {
  count();
  return renameat(AT_FDCWD, from, AT_FDCWD, to);
}
extern "C" int link(const char* from, const char* to) noexcept {
  count();
  if (hardLinks) return linkat(AT_FDCWD, from, AT_FDCWD, to, 0);
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
    writeBytes(pending.dataPath(), version + " voxels");
    pending.writeHeader([&](const std::string& name) { return version + ' ' + name; });
    CHECK(readBytes(pending.headerPath()) == version + ' ' + pending.dataPath().filename().string());
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

TEST_CASE("A pair that is not committed leaves the old one, and nothing beside it", "[core]") {
  const Pair pair;
  pair.write("old");
  {
    PendingPair pending(pair.header, pair.data);
    writeBytes(pending.dataPath(), "half");
  }
  CHECK(pair.voxels() == "old voxels");
  CHECK(std::distance(fs::directory_iterator(pair.folder.path()), fs::directory_iterator()) == 2);
}
