// SPDX-License-Identifier: Apache-2.0
#include "core/input_file.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/text_file.h"
#include "support/complaint.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("What has no end or is no storage is not read as a text", "[input-file]") {
  const TemporaryFolder folder;
  const fs::path text = folder.path() / "a.json", pipe = folder.path() / "pipe", link = folder.path() / "link";
  writeBytes(text, "12345");
  CHECK(ordinaryFileSize(text) == 5);
  CHECK(readTextFile(text) == "12345");
  writeBytes(text, "");
  CHECK(readTextFile(text).empty());
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", link);
  const auto refused = [](const fs::path& path) { return complaint<IoError>([&] { readTextFile(path); }); };
  CHECK_THAT(refused(pipe), Contains("pipe: cannot read: is a pipe"));  // and nobody waits for a writer
  CHECK_THAT(refused("/dev/zero"), Contains("is a device"));
  CHECK_THAT(refused(link), Contains("link: cannot read: is a device"));
  CHECK_THAT(refused("/proc/self/environ"), Contains("is made up by the system"));
  CHECK_THAT(refused(folder.path()), Contains("is a directory"));
  CHECK_THAT(refused(folder.path() / "none"), Contains("none: cannot read: No such file"));
  // A file of holes takes no room, whatever its size.
  fs::resize_file(text, std::uintmax_t(3) << 30);
  CHECK_THAT(refused(text), Contains("expected a text of at most 1073741824 bytes, found 3221225472"));
}

TEST_CASE("Beside is what lies in the folder or below it, by whatever way it is named", "[input-file]") {
  const TemporaryFolder folder, elsewhere;
  const fs::path top = folder.path() / "top";
  fs::create_directories(top / "below");
  writeBytes(top / "a", "");
  writeBytes(top / "below" / "b", "");
  writeBytes(folder.path() / "outside", "");
  writeBytes(elsewhere.path() / "c", "");
  fs::create_symlink(elsewhere.path() / "c", top / "out");
  fs::create_symlink("below/b", top / "in");
  fs::create_directory_symlink(elsewhere.path(), top / "door");
  const auto isBelow = [&](const fs::path& file) { return liesBelow(file, top); };
  for (const fs::path& file : {top / "a", top / "below" / "b", top / "in", top / "below" / ".." / "a", top / "none",
                               folder.path() / "top" / "." / "a"})
    CHECK(isBelow(file));
  for (const fs::path& file : {top / "out", top / "door" / "c", top / "..", top / ".." / "outside",
                               fs::path("/etc/passwd"), top / "door" / "none", fs::path(top.string() + "x") / "a"})
    CHECK_FALSE(isBelow(file));
  CHECK_NOTHROW(requireBeside(top / "a", top / "a"));
  CHECK_THAT(complaint<IoError>([&] { requireBeside(top / "out", top / "head.nhdr"); }),
             Contains("head.nhdr: expected only files beside or below it, found ") && Contains("top/out"));
}
