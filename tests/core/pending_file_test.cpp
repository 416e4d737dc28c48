// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pending_file.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {
std::string readText(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}
}  // namespace

TEST_CASE("A pending file appears only when it is committed", "[core]") {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "a.txt";
  writeTextFile(target, "old");
  {
    PendingFile pending(target);
    pending.stream() << "half" << std::flush;
    CHECK(readText(target) == "old");
  }
  CHECK(readText(target) == "old");
  writeTextFile(target, "new");
  CHECK(readText(target) == "new");
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("An unwritable target is refused before anything is computed", "[core]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(PendingFile(folder.path()), Catch::Contains("is a directory"));
  CHECK_THROWS_WITH(PendingFile(folder.path() / "none" / "a.txt"), Catch::Contains("No such file"));
}
