// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/printable.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "core/json_writer.h"
#include "umbrick/core/random.h"

using namespace umbrick;

TEST_CASE("Text stays as it is, and what a terminal would obey does not", "[printable]") {
  for (const char* text : {"", "a b", "C:\\x", "\u00e9\u00e0\u4e2d\U0001f600", "\u0300"}) {
    CHECK(printable(text) == text);
    CHECK(asUtf8(text) == text);
  }
  CHECK(printable("a\nb\tc\rd") == "a\\nb\\tc\\rd");
  CHECK(printable("\x1b[2Jx\x7f") == "\\x1b[2Jx\\x7f");
  CHECK(printable("\u009b") == "\\xc2\\x9b");           // the control sequence introducer of C1
  CHECK(printable("a\u202eb") == "a\\xe2\\x80\\xaeb");  // writes the rest from right to left
  CHECK(printableLines("a\nb\x1b") == "a\nb\\x1b");
  CHECK(asUtf8("a\nb\x1b") == "a\nb\x1b");
}

TEST_CASE("Bytes that are no UTF-8 are escaped one by one", "[printable]") {
  CHECK(printable("\xff") == "\\xff");
  CHECK(printable("a\xc3") == "a\\xc3");                           // cut off
  CHECK(printable("\xc0\xaf") == "\\xc0\\xaf");                    // longer than it must be
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // half of a pair of UTF-16
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  CHECK(printable("\xe9t\xe9") == "\\xe9t\\xe9");                  // Latin-1
  CHECK(asUtf8("\xe9t\xc3\xa9\n") == "\\xe9t\xc3\xa9\n");
}

// The parser of JSON is an independent judge of UTF-8.
TEST_CASE("Whatever the bytes are, JSON takes what becomes of them", "[printable]") {
  Random rng(11);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes(1 + i % 9, '\0');
    for (char& byte : bytes) byte = static_cast<char>(rng.uniform() * 256);
    CAPTURE(i);
    CHECK(nlohmann::json::parse(jsonString(bytes)).get<std::string>() == asUtf8(bytes));
    const std::string shown = printable(bytes);
    CHECK_NOTHROW(nlohmann::json(shown).dump());
    for (const char c : shown) CHECK((static_cast<unsigned char>(c) >= 0x20 && c != 0x7f));
  }
}
