// When a job says how far it is, and in which words.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "tools/program.h"
#include "tools/progress_pace.h"

using namespace umbrick;
using namespace umbrick::tools;
using Catch::Contains;

TEST_CASE("Progress is a line that is rewritten on a terminal, plain lines elsewhere, or what is asked for",
          "[tools]") {
  CHECK(progressStyle(nullptr, true) == ProgressStyle::rewritten);
  CHECK(progressStyle(nullptr, false) == ProgressStyle::lines);
  CHECK(progressStyle("", false) == ProgressStyle::lines);
  for (const bool terminal : {true, false}) {
    CHECK(progressStyle("none", terminal) == ProgressStyle::none);
    CHECK(progressStyle("steps", terminal) == ProgressStyle::steps);
  }
}

TEST_CASE("A log gets its first line after ten seconds and one every thirty from then on", "[tools]") {
  ProgressPace pace(ProgressStyle::lines);
  CHECK_FALSE(pace.isDue(0, 0));
  CHECK_FALSE(pace.isDue(9'999, 0.99));
  CHECK(pace.isDue(10'001, 0.1));
  CHECK_FALSE(pace.isDue(10'002, 0.9));
  CHECK_FALSE(pace.isDue(40'000, 0.9));
  // A new part of the job changes nothing: a job of many short parts would else fill the log.
  pace.begin();
  CHECK_FALSE(pace.isDue(40'000, 0));
  CHECK(pace.isDue(40'001, 0));
}

TEST_CASE("A terminal is told nothing of a short job, and not more often than one can read", "[tools]") {
  ProgressPace pace(ProgressStyle::rewritten);
  CHECK_FALSE(pace.isDue(300, 0.5));
  CHECK(pace.isDue(500, 0.5));
  CHECK_FALSE(pace.isDue(600, 0.6));
  CHECK(pace.isDue(701, 0.6));
}

TEST_CASE("Steps are told at once, one for each tenth of a part", "[tools]") {
  ProgressPace pace(ProgressStyle::steps);
  CHECK(pace.isDue(0, 0));
  CHECK_FALSE(pace.isDue(50'000, 0.09));
  CHECK(pace.isDue(50'000, 0.1));
  CHECK(pace.isDue(50'000, 0.55));
  CHECK_FALSE(pace.isDue(50'000, 0.59));
  pace.begin();
  CHECK(pace.isDue(50'000, 0));
  ProgressPace silent(ProgressStyle::none);
  CHECK_FALSE(silent.isDue(1e9, 1));
}

TEST_CASE("Progress is a share, a rate where bytes are known, and the time left", "[tools]") {
  CHECK(progressText(ProgressStyle::lines, "rendering", 0.25, 20'000, 0) == "rendering: 25 %, 1:00 left");
  CHECK(progressText(ProgressStyle::lines, "reading", 0.5, 2'000, 4e8) == "reading: 50 %, 100 MB/s, 0:02 left");
  CHECK(progressText(ProgressStyle::lines, "check", 0.1, 1'000'000, 0) == "check: 10 %, 2:30:00 left");
  // Nothing is done yet, so that nothing is known.
  CHECK(progressText(ProgressStyle::lines, "rendering", 0, 20'000, 0) == "rendering: 0 %");
  CHECK(progressText(ProgressStyle::lines, "reading", 0, 20'000, 4e8) == "reading: 0 %");
  CHECK(progressText(ProgressStyle::rewritten, "rendering", 0.5, 1'000, 0) ==
        "rendering [###############...............]  50 %, 0:01 left");
  CHECK_THAT(progressText(ProgressStyle::lines, "rendering", 1.5, 1'000, 0), Contains("100 %, 0:00 left"));
}

TEST_CASE("A job that is asked to tells its steps, also into a file, and else says nothing", "[tools]") {
  const TemporaryFolder folder;
  const std::string arguments = "convert " + kHead + "-o head.vdb";
  CHECK(runProgram(folder, arguments).err.empty());
  const ProgramResult told = runProgram(folder, arguments, "UMBRICK_PROGRESS=steps");
  CHECK(told.status == 0);
  CHECK_THAT(told.err, Contains("converting headsq_256x256x94_uint16le.raw.gz: 0 %\n"));
  CHECK_THAT(told.err, Contains(" left\n"));
}
