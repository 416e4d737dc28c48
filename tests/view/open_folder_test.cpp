// Files of the folder of the server, and none from elsewhere.
// SPDX-License-Identifier: Apache-2.0
#include "view/open_folder.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "view/uploaded_file.h"

using namespace umbrick;
using namespace umbrick::view;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, std::size_t bytes = 3) { std::ofstream(path) << std::string(bytes, 'x'); }

// A folder to serve, with another one beside it that nobody may reach.
struct Tree {
  TemporaryFolder folder;
  fs::path served = folder.path() / "served", secret = folder.path() / "secret";
  Tree() {
    fs::create_directories(served / "below" / "deep");
    fs::create_directories(secret);
    write(secret / "key.nrrd");
    write(served / "b.nrrd", 2000);
    write(served / "a.NII.gz");
    write(served / "scene.json");
    write(served / "notes.txt");
    write(served / ".hidden.nrrd");
    write(served / "below" / "c.vdb");
    write(served / "below" / "1.dcm");
    write(served / "below" / "2.dcm");
  }
};

}  // namespace

TEST_CASE("A listing has folders, volumes and scenes, with their sizes", "[view]") {
  const Tree tree;
  const OpenFolder folder(tree.served);
  const FolderListing listing = folder.list("");
  REQUIRE(listing.entries.size() == 4);
  CHECK(listing.entries[0].name == "below");
  CHECK(listing.entries[0].kind == EntryKind::folder);
  CHECK(listing.entries[1].name == "a.NII.gz");
  CHECK(listing.entries[2].name == "b.nrrd");
  CHECK(listing.entries[2].bytes == 2000);
  CHECK(listing.entries[3].kind == EntryKind::scene);
  CHECK(listing.dicomFiles == 0);
  const FolderListing below = folder.list("below");
  CHECK(below.path == "below");
  CHECK(below.dicomFiles == 2);
  CHECK(below.entries.size() == 4);
  CHECK(folder.list("below/deep").entries.empty());
}

TEST_CASE("Only so many entries are listed", "[view]") {
  const TemporaryFolder temporary;
  for (std::size_t i = 0; i < kMostEntries + 5; ++i) write(temporary.path() / (std::to_string(i) + ".vdb"), 1);
  const FolderListing listing = OpenFolder(temporary.path()).list("");
  CHECK(listing.entries.size() == kMostEntries);
  CHECK(listing.left == 5);
}

TEST_CASE("Nothing above the folder is found, by whatever path", "[view]") {
  const Tree tree;
  const OpenFolder folder(tree.served);
  for (const std::string& path :
       {std::string(".."), std::string("../secret/key.nrrd"), std::string("below/../../secret/key.nrrd"),
        std::string("/etc/passwd"), (tree.secret / "key.nrrd").string(), std::string("below//c.vdb"),
        std::string("./b.nrrd"), std::string(".hidden.nrrd"), std::string("below/"), std::string("b.nrrd\n"),
        std::string("b.nrrd\0x", 8), std::string(5000, 'a')}) {
    INFO(path);
    CHECK_THROWS_AS(folder.find(path), InvalidArgument);
    CHECK_THROWS_AS(folder.list(path), InvalidArgument);
  }
  CHECK_THROWS_AS(folder.find("nothing.nrrd"), IoError);
  CHECK_THROWS_AS(folder.list("b.nrrd"), IoError);
  CHECK(folder.find("below/c.vdb").path == fs::canonical(tree.served) / "below" / "c.vdb");
  CHECK(folder.find("below").folder);
}

TEST_CASE("Links are not followed, wherever they stand in a path", "[view]") {
  const Tree tree;
  fs::create_symlink(tree.secret / "key.nrrd", tree.served / "link.nrrd");
  fs::create_symlink(tree.secret, tree.served / "elsewhere");
  fs::create_symlink("b.nrrd", tree.served / "inside.nrrd");
  const OpenFolder folder(tree.served);
  CHECK_THROWS_WITH(folder.find("link.nrrd"), Catch::Contains("link"));
  CHECK_THROWS_WITH(folder.find("elsewhere/key.nrrd"), Catch::Contains("link"));
  CHECK_THROWS_AS(folder.list("elsewhere"), InvalidArgument);
  CHECK_THROWS_AS(folder.find("inside.nrrd"), InvalidArgument);
  const FolderListing listing = folder.list("");
  CHECK(listing.links == 3);
  for (const FolderEntry& entry : listing.entries) CHECK(entry.name != "link.nrrd");
}

TEST_CASE("Pipes are neither listed nor opened, so that nothing waits for them", "[view]") {
  const Tree tree;
  REQUIRE(::mkfifo((tree.served / "pipe.nrrd").c_str(), 0600) == 0);
  const OpenFolder folder(tree.served);
  CHECK(folder.list("").entries.size() == 4);
  CHECK_THROWS_WITH(folder.find("pipe.nrrd"), Catch::Contains("neither a file nor a folder"));
}

TEST_CASE("A file that gives way to another one while it is opened is noticed", "[view]") {
  const Tree tree;
  const OpenFolder folder(tree.served);
  const FoundFile found = folder.find("b.nrrd");
  CHECK_NOTHROW(folder.requireSame("b.nrrd", found));
  fs::rename(tree.served / "b.nrrd", tree.served / "kept.nrrd");
  CHECK_THROWS_AS(folder.requireSame("b.nrrd", found), IoError);
  fs::create_symlink(tree.secret / "key.nrrd", tree.served / "b.nrrd");
  CHECK_THROWS_AS(folder.requireSame("b.nrrd", found), InvalidArgument);
  fs::remove(tree.served / "b.nrrd");
  write(tree.served / "b.nrrd");
  CHECK_THROWS_WITH(folder.requireSame("b.nrrd", found), Catch::Contains("took its place"));
}

TEST_CASE("The folder stays the one that was opened, whatever takes its name", "[view]") {
  const Tree tree;
  const OpenFolder folder(tree.served);
  fs::rename(tree.served, tree.folder.path() / "moved");
  fs::create_symlink(tree.secret, tree.served);
  CHECK(folder.list("").entries.size() == 4);
  CHECK_THROWS_AS(folder.find("key.nrrd"), IoError);
}

TEST_CASE("A file that a page sends has a plain name and goes away", "[view]") {
  for (const char* name : {"", ".nrrd", "a.txt", "a/b.nrrd", "..", "../a.nrrd", "a b.nrrd", "a%2f.nrrd", "scene.json"})
    CHECK_THROWS_AS(UploadedFile(name), InvalidArgument);
  CHECK_FALSE(isUploadName(std::string(200, 'a') + ".nrrd"));
  fs::path path;
  {
    const UploadedFile file("head-1.nii.gz");
    path = file.path();
    write(path);
    struct stat status {};
    REQUIRE(::stat(path.parent_path().c_str(), &status) == 0);
    CHECK((status.st_mode & 077) == 0);
  }
  CHECK_FALSE(fs::exists(path));
  CHECK_FALSE(fs::exists(path.parent_path()));
}
