// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_table.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "study/invented_study.h"

using namespace umbrick;
using Catch::Contains;

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

}  // namespace

TEST_CASE("The table has a row per case with as many columns as the head, and its numbers read back", "[report]") {
  const StudyRecord record = inventedStudy();
  const std::vector<std::string> lines = split(printTable(record), '\n');
  REQUIRE(lines.size() == 1 + record.cases.size());
  const std::vector<std::string> head = split(lines[0], ',');
  const auto column = [&](const std::string& name) {
    const auto at = std::find(head.begin(), head.end(), name);
    REQUIRE(at != head.end());
    return static_cast<std::size_t>(at - head.begin());
  };
  for (std::size_t i = 0; i < record.cases.size(); ++i) {
    const std::vector<std::string> cells = split(lines[i + 1], ',');
    REQUIRE(cells.size() == head.size());
    CHECK(cells[column("id")] == record.cases[i].what.id());
    CHECK(std::stod(cells[column("rmse")]) == record.cases[i].error.rmse);
    CHECK(std::stod(cells[column("time_ratio")]) == record.cases[i].timeRatio.median);
    CHECK(std::stod(cells[column("reference_error_rmse")]) == 0.001);
  }
  // Only ordinates has windows; the shares of the passes are those of the case's picture.
  for (const std::string& line : std::vector<std::string>(lines.begin() + 1, lines.end())) {
    const std::vector<std::string> cells = split(line, ',');
    const bool windows = cells[column("method")] == "ordinates";
    CHECK(cells[column("window_texel_world")].empty() == !windows);
    CHECK(cells[column("windows_share")] == (windows ? "0.375" : "0"));
    CHECK(cells[column("eye_share")] == (windows ? "0.5" : "1"));
  }
  // Milliseconds tell something only of hardware.
  CHECK(std::find(head.begin(), head.end(), "case_ms") == head.end());
  StudyRecord hardware = record;
  hardware.machine.software = false;
  CHECK_THAT(split(printTable(hardware), '\n')[0], Contains(",case_ms,baseline_ms"));
}
