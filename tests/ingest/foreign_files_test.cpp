// Files of others: what they may name, and what is said of what they name.
// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "ingest/small_volume.h"
#include "support/complaint.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const OpenOptions kBeside{.besideOnly = true};
const std::string kSecret = "root:$6$salt:19000\n";  // less than a volume here takes

std::string nrrd(const std::string& dataFile, const std::string& more = "encoding: raw\n") {
  return "NRRD0004\ntype: int16\ndimension: 3\nsizes: 2 3 2\nendian: little\n" + more + "data file: " + dataFile + "\n";
}

std::string metaImage(const std::string& dataFile, const std::string& more = "") {
  return "ObjectType = Image\nNDims = 3\nDimSize = 2 3 2\nElementType = MET_SHORT\n" + more +
         "ElementDataFile = " + dataFile + "\n";
}

// A folder of files that somebody sent, with another one beside it.
struct Sent {
  Sent() {
    fs::create_directories(in / "below");
    for (const fs::path& file : {in / "a.raw", in / "below" / "b.raw", folder.path() / "outside.raw"})
      writeBytes(file, bytesOf(kValues));
    fs::create_symlink("../outside.raw", in / "link.raw");
    fs::create_symlink("below/b.raw", in / "good.raw");
  }
  TemporaryFolder folder;
  fs::path in = folder.path() / "in";
};

std::string refused(const fs::path& path, const OpenOptions& options = {}) {
  return complaint<IoError>([&] { readVolume(*openVolume(path, options)); });
}

bool readsAs(const fs::path& path, const OpenOptions& options = {}) {
  return readVolume(*openVolume(path, options)) == kFloats;
}

}  // namespace

TEST_CASE("A header that is kept beside itself takes data from its folder and below, and from nowhere else",
          "[foreign]") {
  const Sent sent;
  const std::string outside = fs::absolute(sent.folder.path() / "outside.raw").string();
  const auto check = [&](const fs::path& header, const auto& text) {
    for (const std::string name : {"a.raw", "below/b.raw", "good.raw", "./a.raw", "below/../a.raw"}) {
      CAPTURE(header, name);
      writeBytes(header, text(name));
      CHECK(readsAs(header, kBeside));
    }
    for (const std::string& name :
         {std::string("link.raw"), std::string("../outside.raw"), outside, std::string("below/../../outside.raw")}) {
      CAPTURE(header, name);
      writeBytes(header, text(name));
      CHECK(readsAs(header));  // without the option it is a way to name any file
      CHECK_THAT(refused(header, kBeside), Contains(header.filename().string() + ": expected only files beside or"));
    }
  };
  check(sent.in / "v.nhdr", [](const std::string& name) { return nrrd(name); });
  check(sent.in / "v.mhd", [](const std::string& name) { return metaImage(name); });
}

TEST_CASE("Lists and numbered names are kept beside the header, too", "[foreign]") {
  const Sent sent;
  const std::string firstHalf = bytesOf(std::vector<std::int16_t>(kValues.begin(), kValues.begin() + 6));
  writeBytes(sent.in / "s1", firstHalf);
  writeBytes(sent.folder.path() / "s2", firstHalf);
  writeBytes(sent.in / "v.nhdr", nrrd("LIST\ns1\n../s2"));
  CHECK_THAT(refused(sent.in / "v.nhdr", kBeside), Contains("../s2"));
  writeBytes(sent.in / "v.mhd", metaImage("LIST\ns1\n../s2"));
  CHECK_THAT(refused(sent.in / "v.mhd", kBeside), Contains("../s2"));
  writeBytes(sent.in / "v.nhdr", nrrd("../s%d 2 3 1"));
  CHECK_THAT(refused(sent.in / "v.nhdr", kBeside), Contains("../s2"));
}

TEST_CASE("A header that is itself a link out of its folder, or lies among such links, is refused", "[foreign]") {
  const Sent sent;
  writeBytes(sent.folder.path() / "outside.nrrd",
             "NRRD0004\ntype: int16\ndimension: 3\nsizes: 2 3 2\nendian: little\nencoding: raw\n\n" + bytesOf(kValues));
  fs::create_symlink("../outside.nrrd", sent.in / "v.nrrd");
  CHECK(readsAs(sent.in / "v.nrrd"));
  CHECK_THAT(refused(sent.in / "v.nrrd", kBeside), Contains("beside or below"));
  // A folder of slices: one of them is a link, and would become one of the volume.
  fs::create_symlink("../outside.raw", sent.in / "slice.tif");
  CHECK_THAT(refused(sent.in, kBeside), Contains("expected only files in its folder, found the link"));
  CHECK_THAT(refused(sent.in / "slice*.tif", kBeside), Contains("found the link"));
}

TEST_CASE("An HDF5 file that is kept beside itself has its bytes in itself", "[foreign]") {
  const Sent sent;
  const auto make = [&](const fs::path& path, const char* external) {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t dims[3] = {2, 3, 2};
    const hid_t space = H5Screate_simple(3, dims, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    if (external) H5Pset_external(creation, external, 0, 24);
    const hid_t dataset = H5Dcreate2(file, "v", H5T_STD_I16LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (!external) H5Dwrite(dataset, H5T_NATIVE_INT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, kValues.data());
    H5Dclose(dataset);
    H5Pclose(creation);
    H5Sclose(space);
    H5Fclose(file);
  };
  const std::string outside = fs::absolute(sent.folder.path() / "outside.raw").string();
  make(sent.in / "own.h5", nullptr);
  make(sent.in / "external.h5", outside.c_str());
  CHECK(readsAs(sent.in / "own.h5", kBeside));
  CHECK(readsAs(sent.in / "external.h5"));
  CHECK_THAT(refused(sent.in / "external.h5", kBeside), Contains("found one that names other files"));
  const hid_t file = H5Fcreate((sent.in / "linked.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_external("own.h5", "v", file, "w", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  CHECK(readsAs(sent.in / "linked.h5:/w"));
  CHECK_THAT(refused(sent.in / "linked.h5:/w", kBeside), Contains("found one that names other files"));
}

TEST_CASE("Pipes, devices and files of /proc are no headers", "[foreign]") {
  const TemporaryFolder folder;
  for (const char* name : {"a.nrrd", "a.mhd", "a.nii", "a.npy", "a.vti", "a.vtk", "a.h5", "a.dcm", "a.tif", "a.png"}) {
    const fs::path pipe = folder.path() / name, device = folder.path() / (std::string("zero-") + name);
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);  // which nobody writes to: whoever opens it waits for ever
    fs::create_symlink("/dev/zero", device);
    CAPTURE(name);
    CHECK_THAT(refused(pipe), Contains(std::string(name) + ": cannot read: is a pipe"));
    CHECK_THAT(refused(device), Contains("cannot read: is a device"));
  }
  fs::create_symlink("/proc/self/environ", folder.path() / "e.mhd");
  CHECK_THAT(refused(folder.path() / "e.mhd"), Contains("made up by the system"));
  writeBytes(folder.path() / "a.nhdr", nrrd("/proc/self/environ"));
  CHECK_THAT(refused(folder.path() / "a.nhdr"), Contains("a.nhdr: /proc/self/environ: cannot read: is made up"));
}

TEST_CASE("What is wrong with a data file is said with the names of header and file", "[foreign]") {
  const TemporaryFolder folder;
  const fs::path header = folder.path() / "v.nhdr";
  const auto namesBoth = [&](const std::string& name) {
    const std::string said = refused(header);
    CHECK_THAT(said, Contains("v.nhdr: "));
    CHECK_THAT(said, Contains((folder.path() / name).string() + ": "));
  };
  writeBytes(header, nrrd("none.raw"));
  namesBoth("none.raw");
  writeBytes(folder.path() / "short.raw", "12345");
  writeBytes(header, nrrd("short.raw"));
  namesBoth("short.raw");
  for (const std::string& packed : {gzipped("12345"), gzipped(bytesOf(kValues) + "more"), std::string("no gzip")}) {
    writeBytes(folder.path() / "v.gz", packed);
    writeBytes(header, nrrd("v.gz", "encoding: gzip\n"));
    namesBoth("v.gz");
  }
  writeBytes(folder.path() / "v.mhd", metaImage("v.z", "CompressedData = True\n"));
  writeBytes(folder.path() / "v.z", zlibPacked("12345"));
  CHECK_THAT(refused(folder.path() / "v.mhd"),
             Contains("v.mhd: ") && Contains((folder.path() / "v.z").string() + ": "));
}

TEST_CASE("Nothing of a file is quoted that is not what it should be", "[foreign]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "private", kSecret);
  const auto silent = [&](const fs::path& path) {
    const std::string said = refused(path);
    CAPTURE(path, said);
    CHECK(said != "no complaint");
    for (std::size_t at = 0; at + 4 <= kSecret.size(); ++at)
      CHECK_FALSE(said.find(kSecret.substr(at, 4)) != std::string::npos);
  };
  for (const char* encoding : {"raw", "text", "hex", "gzip", "bzip2"}) {
    writeBytes(folder.path() / "v.nhdr", nrrd("private", std::string("encoding: ") + encoding + "\n"));
    silent(folder.path() / "v.nhdr");
  }
  for (const char* more : {"", "BinaryData = False\n", "CompressedData = True\n"}) {
    writeBytes(folder.path() / "v.mhd", metaImage("private", more));
    silent(folder.path() / "v.mhd");
  }
  for (const char* name : {"p.nrrd", "p.nhdr", "p.mha", "p.mhd", "p.nii", "p.hdr", "p.npy", "p.vti", "p.vtk", "p.h5",
                           "p.dcm", "p.tif", "p.png"}) {
    fs::create_symlink("private", folder.path() / name);
    silent(folder.path() / name);
  }
}
