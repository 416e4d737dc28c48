// Messages that no page sends: what fuzzing has kept, and tens of thousands of damaged ones, the same in every run.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/readers.h"
#include "support/files.h"
#include "support/sanitized.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"
#include "view/page_message.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

// What a parser of JSON stumbles over more often than over single bytes.
constexpr std::string_view kPieces[]{"{",
                                     "}",
                                     "[",
                                     "]",
                                     ",",
                                     ":",
                                     "\"",
                                     "\\",
                                     "null",
                                     "true",
                                     "\"type\"",
                                     "1e999",
                                     "-0",
                                     "\\ud800",
                                     "\\u0000",
                                     "0x1",
                                     "\xff",
                                     "\xc3\x28",
                                     "//",
                                     "/**/",
                                     "1e",
                                     "-",
                                     "\n",
                                     "[[[[[[[[[[[[",
                                     "{\"a\":",
                                     "\"type\":\"edit\"",
                                     "18446744073709551616",
                                     "\xef\xbb\xbf"};
constexpr std::size_t kLongest = 4096;

class Mutations {
 public:
  Mutations(std::vector<std::string> seeds, std::uint64_t seed) : seeds_(std::move(seeds)), random_(seed) {}

  std::string next() {
    std::string text = seeds_[below(seeds_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(text);
    if (text.size() > kLongest) text.resize(kLongest);
    return text;
  }

 private:
  std::size_t below(std::size_t count) { return random_.next() % count; }

  void change(std::string& text) {
    const std::size_t at = below(text.size() + 1);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_.next());
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 2:
        text.insert(at, kPieces[below(std::size(kPieces))]);
        break;
      case 3:
        text.erase(at, 1 + below(8));
        break;
      case 4: {
        const std::string& other = seeds_[below(seeds_.size())];
        text = text.substr(0, at) + other.substr(below(other.size() + 1));
        break;
      }
      default: {
        const std::string piece = text.substr(at, 1 + below(40));
        for (std::size_t times = 1 + below(8); times > 0; --times) text.insert(at, piece);
      }
    }
  }

  std::vector<std::string> seeds_;
  Random random_;
};

}  // namespace

TEST_CASE("Messages that fuzzing has kept are read or refused, and the seeds are read", "[view]") {
  const fuzz::Target read = fuzz::messageTargets().at("message").run;
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(UMBRICK_FUZZ_CORPUS) / "message")) {
    INFO(entry.path());
    const std::string text = readBytes(entry.path());
    CHECK_NOTHROW(fuzz::runTarget(read, entry.path(), text));
    if (entry.path().filename().string().starts_with("seed")) CHECK_NOTHROW(read(entry.path(), text));
    ++files;
  }
  CHECK(files > 10);
}

// About 5 us a message; sanitizers take ten times as long, and get fewer.
TEST_CASE("A damaged message is read or refused, whatever the damage", "[view]") {
  std::vector<std::string> seeds;
  for (const auto& entry : fs::directory_iterator(fs::path(UMBRICK_FUZZ_CORPUS) / "message"))
    seeds.push_back(readBytes(entry.path()));
  std::sort(seeds.begin(), seeds.end());  // a folder lists its files in any order
  const fuzz::Target read = fuzz::messageTargets().at("message").run;
  Mutations mutations(seeds, 2026);
  std::size_t good = 0, refused = 0;
  const std::size_t count = kSanitized ? 10'000 : 50'000;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string text = mutations.next();
    try {
      read({}, text);
      ++good;
    } catch (const InvalidArgument&) {
      ++refused;
    } catch (...) {
      FAIL("another exception than InvalidArgument for " << text);
    }
  }
  // Both ways are taken often: the damage is neither too little nor too much.
  CHECK(good > count / 50);
  CHECK(refused > count / 2);
}
