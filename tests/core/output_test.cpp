// What stands where a file is to be written, and what becomes of it.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <future>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/pending_file.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

struct stat statusOf(const fs::path& path) {
  struct stat status {};
  REQUIRE(lstat(path.c_str(), &status) == 0);
  return status;
}

std::size_t namesIn(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// Runs something in a process of its own. @return what wait says of it
int inChild(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    work();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

}  // namespace

// A piece that fills the buffer to the last byte is the one that goes another way.
TEST_CASE("A stream keeps the order of pieces of all sizes, and of what is written behind a seek", "[core]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "pieces";
  constexpr std::size_t kBuffer = std::size_t(1) << 18;
  std::string expected;
  PendingFile pending(path);
  const auto put = [&](std::size_t count) {
    std::string piece(count, '\0');
    for (std::size_t i = 0; i < count; ++i) piece[i] = static_cast<char>((expected.size() + i) * 7 + 3);
    pending.stream().write(piece.data(), static_cast<std::streamsize>(count));
    expected += piece;
  };
  for (const std::size_t first : {std::size_t(0), std::size_t(1), std::size_t(100), kBuffer - 1, kBuffer})
    for (const int more : {-1, 0, 1})
      for (const std::size_t room : {kBuffer, 2 * kBuffer}) {
        put(first);
        put(room - first + static_cast<std::size_t>(more + 1));
      }
  const auto end = pending.stream().tellp();
  pending.stream().seekp(5);
  pending.stream() << "seek";
  expected.replace(5, 4, "seek");
  pending.stream().seekp(end);
  put(3);
  pending.commit();
  CHECK(readBytes(path) == expected);
}

TEST_CASE("An output is a file or a stream, wherever links lead", "[core]") {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.path() / name; };
  writeBytes(at("a"), "1");
  fs::permissions(at("a"), fs::perms(0640));
  fs::create_hard_link(at("a"), at("b"));
  const Output plain = outputAt(at("a"));
  CHECK_FALSE(plain.isStream());
  REQUIRE(plain.standing);
  CHECK(plain.standing->mode == 0640);
  CHECK(plain.standing->names == 2);
  CHECK_FALSE(outputAt(at("none")).standing);

  fs::create_symlink("a", at("link"));
  fs::create_symlink("link", at("second"));
  CHECK(fs::equivalent(outputAt(at("second")).path, at("a")));
  fs::create_symlink("none", at("dangling"));
  CHECK(outputAt(at("dangling")).path == at("none"));
  fs::create_symlink("loop", at("loop"));
  CHECK_THROWS_WITH(outputAt(at("loop")), Catch::Contains("loop: cannot write: Too many levels of symbolic links"));

  REQUIRE(mkfifo(at("fifo").c_str(), 0600) == 0);
  fs::create_symlink("fifo", at("to-fifo"));
  for (const fs::path& stream : {at("fifo"), at("to-fifo"), fs::path("/dev/null"), fs::path("/dev/full")})
    CHECK(outputAt(stream).isStream());
  CHECK(outputAt("/dev/stdout").descriptor == STDOUT_FILENO);
  CHECK(outputAt("/dev/fd/2").descriptor == STDERR_FILENO);
  CHECK_THROWS_WITH(outputAt("/dev/fd/999"), Catch::Contains("Bad file descriptor"));
  CHECK_THROWS_WITH(outputAt(folder.path()), Catch::Contains("is a directory"));
  CHECK_THROWS_WITH(outputAt(folder.path() / ""), Catch::Contains("is a directory"));
}

TEST_CASE("What the caller has opened is written to and not replaced, also where it is a file", "[core]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a";
  const int file = open(path.c_str(), O_CREAT | O_WRONLY, 0600);
  REQUIRE(write(file, "before ", 7) == 7);
  writeTextFile("/dev/fd/" + std::to_string(file), "text");
  REQUIRE(write(file, " after", 6) == 6);
  close(file);
  CHECK(readBytes(path) == "before text after");
}

TEST_CASE("A new file keeps the mode of the one that it replaces", "[core]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a";
  const mode_t mask = umask(027);
  for (const unsigned mode : {0600u, 0644u, 0755u, 0666u, 0444u}) {
    writeBytes(path, "old");
    REQUIRE(chmod(path.c_str(), mode) == 0);
    writeTextFile(path, "new");
    CHECK((statusOf(path).st_mode & 07777u) == mode);
    CHECK(readBytes(path) == "new");
    fs::remove(path);
  }
  writeTextFile(path, "new");
  CHECK((statusOf(path).st_mode & 07777u) == 0640);  // what the mask leaves of a file that is not there
  umask(mask);
}

TEST_CASE("A new file keeps the owner of the one that it replaces", "[core]") {
  if (geteuid() != 0) {
    WARN("SKIPPED: only root may give files away");
    return;
  }
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a";
  writeBytes(path, "old");
  REQUIRE(chown(path.c_str(), 1234, 4321) == 0);
  writeTextFile(path, "new");
  CHECK(statusOf(path).st_uid == 1234);
  CHECK(statusOf(path).st_gid == 4321);
}

TEST_CASE("Links stay links, and other names of a file keep the old content", "[core]") {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.path() / name; };
  writeBytes(at("a"), "old");
  fs::create_hard_link(at("a"), at("other"));
  fs::create_symlink("a", at("link"));
  writeTextFile(at("link"), "new");
  CHECK(fs::is_symlink(at("link")));
  CHECK(readBytes(at("a")) == "new");
  CHECK(readBytes(at("other")) == "old");
  fs::create_symlink("none", at("dangling"));
  writeTextFile(at("dangling"), "made");
  CHECK(fs::is_symlink(at("dangling")));
  CHECK(readBytes(at("none")) == "made");
}

TEST_CASE("Devices and FIFOs are written through", "[core]") {
  const TemporaryFolder folder;
  const dev_t device = statusOf("/dev/null").st_rdev;
  writeTextFile("/dev/null", "text");
  CHECK(S_ISCHR(statusOf("/dev/null").st_mode));
  CHECK(statusOf("/dev/null").st_rdev == device);
  CHECK_THROWS_WITH(writeTextFile("/dev/full", "text"),
                    Catch::Equals("/dev/full: cannot write: No space left on device"));

  const fs::path fifo = folder.path() / "fifo";
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  std::string text(300'000, 'x');  // more than a pipe holds
  text.back() = '.';
  auto read = std::async(std::launch::async, [&] { return readBytes(fifo); });
  {
    // Nobody hears of what is not committed.
    PendingFile pending(fifo);
    pending.write("half");
  }
  writeTextFile(fifo, text);
  CHECK(read.get() == text);
  CHECK(S_ISFIFO(statusOf(fifo).st_mode));
  CHECK(namesIn(folder.path()) == 1);
}

TEST_CASE("A reader that has gone is told apart from other errors", "[core]") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  close(ends[0]);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  CHECK_THROWS_AS(writeTextFile("/dev/fd/" + std::to_string(ends[1]), "text"), PipeClosed);
  std::signal(SIGPIPE, before);
  close(ends[1]);
}

TEST_CASE("A read-only file says why it should stay", "[core]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a";
  CHECK_FALSE(whyProtected(outputAt(path)));
  writeBytes(path, "old");
  CHECK_FALSE(whyProtected(outputAt(path)));
  fs::permissions(path, fs::perms(0444));
  CHECK(whyProtected(outputAt(path)) == "is read-only");  // for root, too
  fs::create_symlink("a", folder.path() / "link");
  CHECK(whyProtected(outputAt(folder.path() / "link")) == "is read-only");
  if (geteuid() != 0) return;
  const int status = inChild([&] {
    fs::permissions(path, fs::perms(0666));
    fs::permissions(folder.path(), fs::perms(0777));
    if (setuid(12345) != 0 || whyProtected(outputAt(path)) != "belongs to another user") _exit(1);
  });
  CHECK(status == 0);
}

TEST_CASE("A name may be as long as the file system allows", "[core]") {
  const TemporaryFolder folder;
  for (const auto naming : {PendingFile::Naming::unnamed, PendingFile::Naming::named}) {
    const fs::path path = folder.path() / (std::string(251, 'n') + ".txt");
    PendingFile pending(path, naming);
    pending.write("text");
    pending.commit();
    CHECK(readBytes(path) == "text");
  }
  CHECK_THROWS_WITH(writeTextFile(folder.path() / std::string(256, 'n'), "text"), Catch::Contains("name too long"));
}

TEST_CASE("What a killed program leaves is removed by the next one that writes the same file", "[core]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  const auto killed = [&](const fs::path& target) {
    const int status = inChild([&] {
      PendingFile pending(target, PendingFile::Naming::named);
      pending.write("half");
      raise(SIGKILL);
    });
    CHECK(WIFSIGNALED(status));
  };
  killed(path);
  killed(folder.path() / "b.txt");
  CHECK(namesIn(folder.path()) == 2);
  {
    // Another program that writes at the same time has its own file, which is not taken for abandoned.
    PendingFile alive(path, PendingFile::Naming::named);
    alive.write("alive");
    CHECK(inChild([&] { writeTextFile(path, "new"); }) == 0);
    CHECK(readBytes(path) == "new");
    CHECK(namesIn(folder.path()) == 3);
    alive.commit();
  }
  CHECK(readBytes(path) == "alive");
  CHECK(namesIn(folder.path()) == 2);  // a.txt, and what is left of b.txt
  writeTextFile(folder.path() / "b.txt", "new");
  CHECK(namesIn(folder.path()) == 2);
}

TEST_CASE("More files are left than there are temporary names, and the next writer goes on", "[core]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  std::vector<std::unique_ptr<PendingFile>> all;
  for (int i = 0; i < 16; ++i) all.push_back(std::make_unique<PendingFile>(path, PendingFile::Naming::named));
  CHECK_THROWS_WITH(PendingFile(path, PendingFile::Naming::named), Catch::Contains("a.txt: cannot write: File exists"));
  writeTextFile(folder.path() / "b.txt", "text");
  all.clear();
  writeTextFile(path, "text");
  CHECK(namesIn(folder.path()) == 2);
}

TEST_CASE("A program that is about to end leaves no temporary file", "[core]") {
  const TemporaryFolder folder;
  const int status = inChild([&] {
    PendingFile named(folder.path() / "a.txt", PendingFile::Naming::named), unnamed(folder.path() / "b.txt");
    named.write("half");
    unnamed.write("half");
    abandonPendingFiles();
    _exit(namesIn(folder.path()) == 0 ? 0 : 1);
  });
  CHECK(status == 0);
}
