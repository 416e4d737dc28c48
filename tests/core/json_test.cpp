// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/json_reader.h"
#include "core/json_writer.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
using Catch::Matchers::StartsWith;

TEST_CASE("A wrong JSON value is reported with line, column and path", "[core]") {
  const JsonDocument document("{\n  \"name\": \"a:,\\\"b\",\n  \"points\": [1, -2.5e3 , {\"x\": [true, null]}]\n}",
                              "f.json");
  const JsonValue points = document.root().at("points");
  CHECK(document.root().at("name").string() == "a:,\"b");
  CHECK(points.items()[1].number() == -2500);
  CHECK_THROWS_WITH(points.items()[1].string(), "f.json:3:17: points[1]: expected a string, found -2.5e3");
  CHECK_THROWS_WITH(points.items()[2].at("x").items()[1].number(),
                    "f.json:3:39: points[2].x[1]: expected a number, found null");
  CHECK_THROWS_WITH(points.items()[2].at("x").items(3),
                    "f.json:3:32: points[2].x: expected an array of 3, found an array of 2");
  CHECK_THROWS_WITH(document.root().at("nothing"), "f.json:1:1: the field 'nothing' is missing");
  CHECK_THROWS_WITH(document.root().at("name").integer(), "f.json:2:11: name: expected a number, found 'a:,\"b'");
  CHECK_THROWS_WITH(document.closest("points[2].x[7].y").fail("!"), "f.json:3:32: points[2].x: !");
}

TEST_CASE("Columns count characters, also after a byte-order mark", "[core]") {
  const JsonDocument document("\xEF\xBB\xBF{\"\xC3\xA4\xE2\x82\xAC\": 1}", "f");
  CHECK_THROWS_WITH(document.root().find("\xC3\xA4\xE2\x82\xAC")->string(), StartsWith("f:1:8: "));
}

TEST_CASE("For unknown fields and names the message suggests what was meant", "[core]") {
  const JsonDocument document(R"({"theat": 1, "mode": "konus", "colour": 2})", "f");
  CHECK_THROWS_WITH(document.root().allowFields({"theta", "mode", "colour"}),
                    "f:1:11: theat: unknown field; did you mean 'theta'?");
  CHECK_THROWS_WITH(document.root().allowFields({"theat", "mode", "size"}),
                    "f:1:41: unknown field; known are theat, mode, size");
  const std::pair<std::string_view, int> names[]{{"cone", 1}, {"emission", 2}};
  CHECK_THROWS_WITH(document.root().at("mode").choice<int>(names),
                    "f:1:22: mode: expected one of cone, emission, found 'konus'");
}

TEST_CASE("Text that is not JSON is refused with its place", "[core]") {
  const auto message = [](std::string_view text) {
    try {
      const JsonDocument document(text, "f");
    } catch (const IoError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK_THAT(message(""), StartsWith("f:1:1: not JSON: ") && Contains("unexpected end"));
  CHECK_THAT(message("{\"a\": 1,\n \"b\": NaN}"), StartsWith("f:2:7: not JSON: ") && Contains("invalid literal"));
  CHECK_THAT(message("[1, Infinity]"), StartsWith("f:1:5: "));
  CHECK_THAT(message("[1, 1e999]"), Contains("1e999"));
  CHECK_THAT(message("[1, 2"), Contains("unexpected end"));
  CHECK_THAT(message("[1, 2] x"), StartsWith("f:1:8: "));
  CHECK_THAT(message("{\"a\": 1, // no\n}"), StartsWith("f:1:10: "));
  CHECK_THAT(message("\"\xFF\""), Contains("UTF-8"));
  CHECK(message("{\"a\": {\"b\": 1},\n \"a\": 2}") == "f:2:2: a field is given twice");
  CHECK(message("{\"a\": {\"b\": 1}, \"b\": [{\"a\": 2}, {\"a\": 3}]}") == "accepted");
}

TEST_CASE("Nesting of any depth is read without the stack", "[core]") {
  const std::size_t depth = 1'000'000;
  const JsonDocument deep(std::string(depth, '[') + std::string(depth, ']'), "f");
  CHECK(deep.root().items().size() == 1);
  CHECK_THROWS_AS(JsonDocument(std::string(depth, '['), "f"), IoError);
}

TEST_CASE("A number is read as a whole number only if it is one and in range", "[core]") {
  const JsonDocument document("[3, 3.0, 3.5, 3e9, -1, 18446744073709551615]", "f");
  const std::vector<JsonValue> items = document.root().items();
  CHECK(items[0].integer() == 3);
  CHECK(items[1].integer() == 3);
  CHECK_THROWS_WITH(items[2].integer(), Contains("[2]: expected a whole number, found 3.5"));
  CHECK_THROWS_WITH(items[3].integer(), Contains("found 3e9"));
  CHECK(items[3].unsignedInteger() == 3'000'000'000u);
  CHECK_THROWS_WITH(items[4].unsignedInteger(), Contains("found -1"));
  CHECK_THROWS_WITH(items[5].unsignedInteger(), Contains("2^53"));
}

TEST_CASE("Numbers and angles come back to the last bit", "[core]") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-300, 300), turn(-7, 7);
  for (int i = 0; i < 20'000; ++i) {
    const double number = std::pow(10.0, exponent(random)) * (i % 2 ? 1 : -1), radians = turn(random);
    const JsonDocument document(jsonArray({jsonNumber(number), jsonDegrees(radians)}), "f");
    REQUIRE(document.root().items()[0].number() == number);
    REQUIRE(document.root().items()[1].degrees() == radians);
  }
  CHECK(jsonDegrees(1.0471975511965976) == "60");
  CHECK(jsonDegrees(0.5235987755982988) == "30");
  CHECK_THROWS_AS(jsonNumber(std::numeric_limits<double>::quiet_NaN()), InvalidArgument);
}

TEST_CASE("Written JSON is indented where it is long, and escaped where it must be", "[core]") {
  CHECK(jsonObject({{"a", jsonNumbers({1, 2.5})}, {"b\n", jsonString("\"x\"")}}) ==
        "{\"a\": [1, 2.5], \"b\\n\": \"\\\"x\\\"\"}");
  const std::string longText =
      jsonObject({{"a", jsonString(std::string(90, 'x'))}, {"b", jsonString(std::string(90, 'y'))}});
  CHECK_THAT(longText, StartsWith("{\n  \"a\": "));
  CHECK(JsonDocument(longText, "f").root().at("b").string() == std::string(90, 'y'));
  CHECK(jsonString("\xFF") == "\"\\\\xff\"");  // no UTF-8, which JSON cannot hold
}
