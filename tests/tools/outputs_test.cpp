// Outputs that are no plain new files, as a user names them: stdout, pipes, devices, links, files with permissions.
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tools/ball_workplace.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;
namespace fs = std::filesystem;

namespace {

const std::string kReference = "reference ball.vdb --tf ball.json --size 12x10 --azimuth 0 --up z --model emission ";
const std::string kPng = "\x89PNG", kExr = "v/1\x01";

std::size_t linesOf(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// The sub-commands that write files and need no OpenGL, each up to the name of its output.
std::vector<std::string> writers() {
  return {kReference + "-o ",
          kReference + "-o a.png --stats ",
          "convert ball.vdb -o ",
          "convert ball.vdb --format nvdb -o ",
          "convert ball.vdb --format nrrd -o ",
          "compare one.png one.png --difference ",
          "compare one.png one.png --flip-map ",
          "tf list -o ",
          "tf auto ball.vdb -o "};
}

struct Workplace : BallWorkplace {
  Workplace() { REQUIRE(run(kReference + "-o one.png").status == 0); }
  fs::path at(const char* name) const { return folder.path() / name; }
};

}  // namespace

TEST_CASE("With - a picture goes to stdout, and what is printed besides to stderr", "[tools]") {
  const Workplace at;
  REQUIRE(at.run(kReference + "-o one.exr").status == 0);
  const std::string png = readBytes(at.at("one.png"));
  const ProgramResult out = at.run(kReference + "-o -");
  CHECK(out.status == 0);
  CHECK((out.out == png));
  CHECK(out.err.empty());
  CHECK((at.run(kReference + "-o /dev/stdout").out == png));
  CHECK((at.run(kReference + "-o - --format exr").out == readBytes(at.at("one.exr"))));
  const ProgramResult both = at.run(kReference + "-o - -o two.png");
  CHECK((both.out == png));
  CHECK(both.err == "two.png\n");
  CHECK((readBytes(at.at("two.png")) == png));
  CHECK_THAT(at.run(kReference + "-o two.png --stats -").out, StartsWith("{\n"));
  CHECK_THAT(at.run("compare one.png one.png --difference -").out, StartsWith(kPng));
  CHECK_THAT(at.run("compare one.png one.png --flip-map - --format exr").out, StartsWith(kExr));
  CHECK_THAT(at.run("tf list -o -").out, StartsWith(kPng));
  CHECK_THAT(at.run("tf auto ball.vdb -o -").out, StartsWith("{"));
  // What the shell has opened is continued, not replaced.
  CHECK(runShell(at.folder, "(echo first; $umbrick " + kReference + "-o -; echo last) > all").status == 0);
  CHECK((readBytes(at.at("all")) == "first\n" + png + "last\n"));
}

// What libraries print is caught behind the descriptor of stderr, which the user does not see.
TEST_CASE("An output that is named as stderr arrives there", "[tools]") {
  const Workplace at;
  const std::string png = readBytes(at.at("one.png"));
  for (const std::string name : {"/dev/stderr", "/dev/fd/2", "/proc/self/fd/2"}) {
    CAPTURE(name);
    const ProgramResult picture = at.run(kReference + "-o " + name);
    CHECK(picture.status == 0);
    CHECK(picture.out.empty());
    CHECK((picture.err == png));
  }
  fs::create_symlink("/dev/stderr", at.at("link.png"));
  CHECK((at.run(kReference + "-o link.png").err == png));
  const ProgramResult stats = at.run(kReference + "-o two.png --stats /dev/stderr");
  CHECK(stats.status == 0);
  CHECK(stats.out == "two.png\n");
  CHECK_THAT(stats.err, StartsWith("{\n") && EndsWith("}\n"));
  CHECK(at.run(kReference + "-o /dev/stderr --stats /dev/fd/2").status == 2);
  // Of a stderr that is closed or full nobody can be told but by the exit status.
  CHECK(runShell(at.folder, "$umbrick " + kReference + "-o /dev/stderr 2>&-").status == 1);
  CHECK(runShell(at.folder, "$umbrick " + kReference + "-o /dev/stderr 2> /dev/full").status == 1);
}

TEST_CASE("With - a conversion goes to stdout, verified before", "[tools]") {
  const Workplace at;
  for (const std::string format : {"nvdb", "nrrd"}) {
    REQUIRE(at.run("convert ball.vdb -o a." + format).status == 0);
    const ProgramResult out = at.run("convert ball.vdb --verify --format " + format + " -o -");
    CHECK(out.status == 0);
    CHECK((out.out == readBytes(at.folder.path() / ("a." + format))));
    CHECK_THAT(out.err, Contains("/dev/stdout: ") && Contains(" bytes out"));
  }
  // A .vdb has an identity of its own in its head, so that no two are the same.
  CHECK(runShell(at.folder, "$umbrick convert ball.vdb --verify -o - > b.vdb").status == 0);
  REQUIRE(at.run("convert ball.vdb -o a.vdb").status == 0);
  const auto grids = [&](const std::string& file) {
    const std::string info = at.run("info " + file).out;
    return info.substr(info.find('\n'));
  };
  CHECK(grids("b.vdb") == grids("a.vdb"));
}

TEST_CASE("Names that do not fit their output are refused in one line", "[tools]") {
  const Workplace at;
  REQUIRE(mkfifo(at.at("p.mhd").c_str(), 0600) == 0);
  expectRefusal(at.folder, "convert ball.vdb -o p.mhd", 2,
                "a header and a file of voxels, which one stream cannot hold; --format nrrd");
  expectRefusal(at.folder, kReference + "-o - --stats -", 2, "/dev/stdout: named twice");
  expectRefusal(at.folder, kReference + "-o picture", 2, "picture: expected a picture that ends in .exr or .png");
  expectRefusal(at.folder, "convert ball.vdb -o grid", 2, "grid: expected an output file that ends in .vdb");
  expectRefusal(at.folder, "tf list -o -.exr", 2, "expected a picture that ends in .png");
  CHECK(at.run(kReference + "-o picture --format png").status == 0);
  CHECK((readBytes(at.at("picture")) == readBytes(at.at("one.png"))));
}

TEST_CASE("A full device is an error of one line for each command, and stays a device", "[tools]") {
  const Workplace at;
  REQUIRE(at.run(kReference + "-o a.png").status == 0);
  for (const std::string& writer : writers()) {
    CAPTURE(writer);
    const std::size_t before = filesIn(at.folder);
    const ProgramResult result = at.run(writer + "/dev/full");
    CHECK(result.status == 1);
    // Some tell before what they have chosen for the volume.
    CHECK_THAT(result.err, EndsWith("umbrick: /dev/full: cannot write: No space left on device\n"));
    CHECK(filesIn(at.folder) == before);
  }
  struct stat status {};
  REQUIRE(lstat("/dev/full", &status) == 0);
  CHECK(S_ISCHR(status.st_mode));
}

TEST_CASE("A FIFO is written through by each command", "[tools]") {
  const Workplace at;
  REQUIRE(mkfifo(at.at("p").c_str(), 0600) == 0);
  for (const std::string& writer : writers()) {
    CAPTURE(writer);
    const ProgramResult result = runShell(at.folder, "cat p > got & $umbrick " + writer + "p; s=$?; wait; exit $s");
    CHECK(result.status == 0);
    CHECK(fs::is_fifo(at.at("p")));
    CHECK(fs::file_size(at.at("got")) > 50);
    fs::remove(at.at("got"));
  }
}

TEST_CASE("An output that stands there keeps its mode, and links keep their targets", "[tools]") {
  const Workplace at;
  for (const std::string& writer : writers()) {
    CAPTURE(writer);
    writeBytes(at.at("old.png"), "old");
    fs::permissions(at.at("old.png"), fs::perms(0600));
    fs::create_symlink("old.png", at.at("link.png"));
    // The name says png, and a conversion looks at --format then.
    const bool convert = writer.starts_with("convert") && writer.find("--format") == std::string::npos;
    const ProgramResult result = at.run((convert ? "convert ball.vdb --format vdb -o " : writer) + "link.png");
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(fs::is_symlink(at.at("link.png")));
    CHECK(fs::status(at.at("old.png")).permissions() == fs::perms(0600));
    CHECK(readBytes(at.at("old.png")) != "old");
    fs::remove(at.at("link.png"));
    fs::remove(at.at("old.png"));
  }
}

TEST_CASE("A read-only output is replaced with --force alone", "[tools]") {
  const Workplace at;
  REQUIRE(at.run(kReference + "-o a.png").status == 0);
  for (const std::string& writer : writers()) {
    const bool convert = writer.starts_with("convert") && writer.find("--format") == std::string::npos;
    const std::string command = convert ? "convert ball.vdb --format vdb -o " : writer;
    writeBytes(at.at("old.png"), "old");
    fs::permissions(at.at("old.png"), fs::perms(0444));
    expectRefusal(at.folder, command + "old.png", 1, "old.png: cannot write: is read-only; --force replaces it");
    CHECK(readBytes(at.at("old.png")) == "old");
    // The option belongs to a sub-command of tf.
    CHECK(at.run(command + "old.png --force").status == 0);
    CHECK(readBytes(at.at("old.png")) != "old");
    CHECK(fs::status(at.at("old.png")).permissions() == fs::perms(0444));
    fs::remove(at.at("old.png"));
  }
}

TEST_CASE("Other names of a replaced file keep its content, which is said", "[tools]") {
  const Workplace at;
  writeBytes(at.at("a.png"), "old");
  fs::create_hard_link(at.at("a.png"), at.at("b.png"));
  const ProgramResult result = at.run(kReference + "-o a.png");
  CHECK(result.status == 0);
  CHECK(result.err ==
        "a.png: has 2 names (hard links), of which this one gets the new content and the others keep the old\n");
  CHECK(readBytes(at.at("b.png")) == "old");
  CHECK_THAT(readBytes(at.at("a.png")), StartsWith(kPng));
}

TEST_CASE("A stdout that is full or closed is an error of one line", "[tools]") {
  const Workplace at;
  for (const std::string command :
       {"tf list", "tf auto ball.vdb", "info ball.vdb", "info ball.vdb --json", "--help", "convert --list-formats",
        "compare one.png one.png", "--version", "convert ball.vdb -o b.vdb"}) {
    CAPTURE(command);
    const ProgramResult full = runShell(at.folder, "$umbrick " + command + " > /dev/full");
    CHECK(full.status == 1);
    CHECK_THAT(full.err, EndsWith("umbrick: stdout: cannot write: No space left on device\n"));
    const ProgramResult closed = runShell(at.folder, "$umbrick " + command + " >&-");
    CHECK(closed.status == 1);
    CHECK_THAT(closed.err, EndsWith("umbrick: stdout: cannot write: Bad file descriptor\n"));
  }
  // No file of the job gets the number of what is closed.
  CHECK(runShell(at.folder, "$umbrick convert ball.vdb -o c.vdb <&- >&- 2>&-").status == 1);
  CHECK(at.run("info c.vdb").status == 0);
  const ProgramResult picture = runShell(at.folder, "$umbrick " + kReference + "-o - >&-");
  CHECK(picture.status == 1);
  CHECK(linesOf(picture.err) == 1);
}

TEST_CASE("The name of an output is printed as it is, and on a terminal as what no terminal obeys", "[tools]") {
  const Workplace at;
  const std::string name = "a\x1b[31m.png";
  CHECK(at.run(kReference + "-o '" + name + "'").out == name + "\n");
  // script gives its command a terminal.
  const ProgramResult shown = runShell(at.folder, "command -v script >&2 || exit 0; script -qec \"$umbrick " +
                                                      kReference + "-o '" + name + "'\" /dev/null");
  if (shown.err.empty()) return;  // there is no such program
  CHECK(shown.status == 0);
  CHECK_THAT(shown.out, Contains("a\\x1b[31m.png") && !Contains("\x1b[31m"));
}

TEST_CASE("A reader that has gone ends the program quietly", "[tools]") {
  const Workplace at;
  REQUIRE(mkfifo(at.at("p").c_str(), 0600) == 0);
  const std::vector<std::string> commands{"tf list", "info ball.vdb --json", kReference + "-o -",
                                          "convert ball.vdb -o -"};
  for (const std::string& command : commands) {
    CAPTURE(command);
    // The left side begins when there is nobody left on the right one.
    const ProgramResult result =
        runShell(at.folder, "{ cat p; $umbrick " + command + "; echo $? > status; } | { exec <&-; : > p; }");
    CHECK(result.err.find("umbrick") == std::string::npos);
    CHECK(readBytes(at.at("status")) == "141\n");  // 128 + SIGPIPE, as of any other program
  }
}
