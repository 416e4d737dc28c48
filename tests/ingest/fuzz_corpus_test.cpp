// What tests/fuzz starts from and what broke a reader once.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "fuzz/readers.h"
#include "support/files.h"
#include "support/sanitized.h"
#include "support/temporary_folder.h"

using namespace umbrick;
namespace fs = std::filesystem;

TEST_CASE("Readers make a result or an Error of every file that fuzzing has kept", "[ingest]") {
  const TemporaryFolder folder;
  auto targets = fuzz::targets();
  targets.merge(fuzz::gridTargets());
  targets.merge(fuzz::studyTargets());
  for (const auto& [name, target] : targets) {
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(UMBRICK_FUZZ_CORPUS) / name)) {
      INFO(entry.path());
      // libhdf5 1.10 does not release all that it took for this file, which the sanitizer would count as a leak of
      // ours.
      if (kSanitized && entry.path().filename() == "closing-library") continue;
      const fs::path path = folder.path() / (name + std::to_string(files++) + target.extension);
      fs::copy_file(entry.path(), path);
      const std::string content = readBytes(path);
      CHECK_NOTHROW(fuzz::runTarget(target.run, path, content));
      // The seeds are good: each is read to its end.
      if (entry.path().filename().string().starts_with("seed")) CHECK_NOTHROW(target.run(path, content));
    }
    CHECK(files > 0);
  }
}
