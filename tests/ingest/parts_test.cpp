// Volumes out of files with axes of components and of frames.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/metaimage_volume.h"
#include "umbrick/ingest/npy_volume.h"
#include "umbrick/ingest/nrrd_volume.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

constexpr int kX = 6, kY = 3, kZ = 4, kComponents = 3, kFrames = 5;

// The number at a place, which says where it is.
int numberAt(int x, int y, int z, int component, int frame) {
  return x + 10 * y + 100 * z + 1000 * component + 4000 * frame;
}

// An axis of the file by its letter: x, y, z, c for components, f for frames.
int lengthOf(char axis) {
  return axis == 'x' ? kX : axis == 'y' ? kY : axis == 'z' ? kZ : axis == 'c' ? kComponents : kFrames;
}

// The numbers of a file whose axes stand in this order, fastest first.
std::vector<std::int16_t> numbersOf(const std::string& axes) {
  std::size_t count = 1;
  for (const char axis : axes) count *= static_cast<std::size_t>(lengthOf(axis));
  std::vector<std::int16_t> out;
  for (std::size_t i = 0; i < count; ++i) {
    int rest = static_cast<int>(i), at[128] = {};
    for (const char axis : axes) {
      at[static_cast<int>(axis)] = rest % lengthOf(axis);
      rest /= lengthOf(axis);
    }
    out.push_back(static_cast<std::int16_t>(numberAt(at['x'], at['y'], at['z'], at['c'], at['f'])));
  }
  return out;
}

std::vector<float> expectedVolume(int component, int frame) {
  std::vector<float> out;
  for (int z = 0; z < kZ; ++z)
    for (int y = 0; y < kY; ++y)
      for (int x = 0; x < kX; ++x) out.push_back(static_cast<float>(numberAt(x, y, z, component, frame)));
  return out;
}

std::string nrrdOf(const std::string& axes) {
  std::string sizes, kinds, directions;
  for (const char axis : axes) {
    sizes += ' ' + std::to_string(lengthOf(axis));
    kinds += axis == 'c' ? " vector" : axis == 'f' ? " time" : " domain";
    directions += axis == 'x' ? " (1,0,0)" : axis == 'y' ? " (0,2,0)" : axis == 'z' ? " (0,0,3)" : " none";
  }
  return "NRRD0005\ntype: short\nendian: little\nencoding: raw\ndimension: " + std::to_string(axes.size()) +
         "\nsizes:" + sizes + "\nkinds:" + kinds + "\nspace: left-posterior-superior\nspace directions:" + directions +
         "\n\n" + bytesOf(numbersOf(axes));
}

// Every order of five axes in which x, y and z follow each other so.
std::vector<std::string> allOrders() {
  std::vector<std::string> out;
  for (std::size_t c = 0; c <= 3; ++c)
    for (std::size_t f = 0; f <= 4; ++f) {
      std::string axes = "xyz";
      axes.insert(c, "c");
      axes.insert(f, "f");
      out.push_back(axes);
    }
  return out;
}

void checkAllComponents(VoxelSource& source, int frame) {
  CHECK(source.info().valuesPerVoxel == kComponents);
  std::vector<float> out(kX * kY * kZ * kComponents);
  source.readSlab(1, std::span(out).first(kX * kY * kComponents));
  source.readSlab(kZ - 1, std::span(out).subspan(kX * kY * kComponents));
  for (int component = 0; component < kComponents; ++component) {
    std::vector<float> own;
    for (std::size_t i = 0; i < out.size(); i += kComponents)
      own.push_back(out[i + static_cast<std::size_t>(component)]);
    CHECK(own == expectedVolume(component, frame));
  }
}

}  // namespace

TEST_CASE("Components and frames are found wherever their axes stand", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nrrd";
  for (const std::string& axes : allOrders()) {
    INFO(axes);
    writeBytes(path, nrrdOf(axes));
    PartChoice parts;
    parts.allComponents = true;
    parts.frame = 3;
    const auto all = openNrrd(path, false, parts);
    CHECK(all->info().frames == kFrames);
    CHECK(all->info().components == kComponents);
    CHECK(all->info().indexToWorld[2][2] == 3);
    checkAllComponents(*all, 3);
    parts.allComponents = false;
    parts.component = 1;
    for (const int frame : {0, kFrames - 1}) {
      parts.frame = frame;
      const auto one = openNrrd(path, false, parts);
      CHECK(one->info().valuesPerVoxel == 1);
      // As stored, and with slices skipped.
      std::vector<std::int16_t> stored(kX * kY);
      one->skipSlices(kZ - 1);
      one->readStored(1, std::as_writable_bytes(std::span(stored)));
      const std::vector<float> expected = expectedVolume(1, frame);
      CHECK(std::vector<float>(stored.begin(), stored.end()) ==
            std::vector<float>(expected.end() - kX * kY, expected.end()));
      CHECK(readVolume(*openNrrd(path, false, parts)) == expected);
    }
  }
}

TEST_CASE("Frames of a packed file that share a stream are those that are asked for, in whatever order", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nrrd";
  std::string text = nrrdOf("xyzf");
  const std::size_t head = text.find("\n\n") + 2;
  text = text.substr(0, head).replace(text.find("raw"), 3, "gzip") + gzipped(text.substr(head));
  writeBytes(path, text);
  PartChoice parts;
  parts.kept = keepStream();
  for (const int frame : {0, 1, 4, 2, 2, 3}) {
    parts.frame = frame;
    CHECK(readVolume(*openNrrd(path, false, parts)) == expectedVolume(0, frame));
  }
  // A frame that is left in its middle leaves the stream there.
  parts.frame = 1;
  std::vector<float> slice(kX * kY);
  openNrrd(path, false, parts)->readSlab(1, slice);
  parts.frame = 4;
  CHECK(readVolume(*openNrrd(path, false, parts)) == expectedVolume(0, 4));
}

TEST_CASE("A choice that is missing or does not fit is refused with what there is", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nrrd";
  writeBytes(path, nrrdOf("xyzcf"));
  OpenOptions open;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("v.nrrd: a sequence of 5 volumes, frame 0 to 4"));
  CHECK_THROWS_AS(openVolume(path, open), SeveralParts);
  open.parts.frame = 0;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("v.nrrd: voxels of 3 numbers, component 0 to 2"));
  open.parts.component = 3;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("component: expected 0 to 2, found 3"));
  open.parts.component = 0;
  open.parts.frame = 5;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("frame: expected 0 to 4, found 5"));
  const VolumeInfo info = describeVolume(path);
  CHECK(info.frames == 5);
  CHECK(info.components == 3);
  // A volume has one of each.
  writeBytes(path, nrrdOf("xyz"));
  open.parts.frame = 1;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("frame: expected 0, found 1"));
  writeBytes(path, nrrdOf("xyzf").substr(0, nrrdOf("xyzf").size() - 1));
  open.parts = {};
  open.parts.frame = 0;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("expected 720 bytes of i16 voxels"));
}

TEST_CASE("A fourth axis of an array is one of components where it is the last and short, else of frames", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.npy";
  const auto write = [&](const std::string& axes, bool fortran) {  // fastest first
    std::string shape;
    for (const char axis : axes) {
      const std::string length = std::to_string(lengthOf(axis)) + ", ";
      shape = fortran ? shape + length : length + shape;
    }
    std::string text = "{'descr': '<i2', 'fortran_order': " + std::string(fortran ? "True" : "False") + ", 'shape': (" +
                       shape + "), }";
    text += std::string(63 - (10 + text.size()) % 64, ' ') + '\n';
    writeBytes(path, std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(text.size()) + '\0' + text +
                         bytesOf(numbersOf(axes)));
  };
  PartChoice all;
  all.allComponents = true;
  PartChoice third = all;
  third.frame = 2;
  for (const bool fortran : {false, true}) {
    write(fortran ? "xyzc" : "cxyz", fortran);
    checkAllComponents(*openNpy(path, all), 0);
    write("xyzf", fortran);
    CHECK(readVolume(*openNpy(path, third)) == expectedVolume(0, 2));
    CHECK(openNpy(path, third)->info().notes.front().find("is taken for one of frames") != std::string::npos);
    write(fortran ? "xyzfc" : "cxyzf", fortran);
    checkAllComponents(*openNpy(path, third), 2);
  }
}

TEST_CASE("Channels and the fourth axis of a MetaImage are components and frames, also of several files", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.mhd";
  const std::string head =
      "ObjectType = Image\nNDims = 4\nDimSize = 6 3 4 5\nElementType = MET_SHORT\nElementNumberOfChannels = 3\n";
  const std::string bytes = bytesOf(numbersOf("cxyzf"));
  PartChoice parts;
  parts.allComponents = true;
  parts.frame = 4;
  writeBytes(path, head + "ElementDataFile = LOCAL\n" + bytes);
  checkAllComponents(*openMetaImage(path, true, parts), 4);
  writeBytes(path, head + "CompressedData = True\nElementDataFile = LOCAL\n" + zlibPacked(bytes));
  checkAllComponents(*openMetaImage(path, true, parts), 4);
  // A file for each frame.
  std::string list = "ElementDataFile = LIST\n";
  const std::size_t share = bytes.size() / kFrames;
  for (std::size_t i = 0; i < kFrames; ++i) {
    writeBytes(folder.path() / (std::to_string(i) + ".raw"), bytes.substr(i * share, share));
    list += std::to_string(i) + ".raw\n";
  }
  writeBytes(path, head + list);
  checkAllComponents(*openMetaImage(path, true, parts), 4);
}

TEST_CASE("Raw voxels of several numbers are a colour where they are three bytes, else a vector", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.raw";
  writeBytes(path, bytesOf(numbersOf("cxyz")));
  OpenOptions open;
  open.raw = RawOptions{.dims = {kX, kY, kZ}, .type = VoxelType::i16, .components = kComponents};
  open.parts.allComponents = true;
  const auto source = openVolume(path, open);
  CHECK(source->info().meaning == VoxelMeaning::vector);
  checkAllComponents(*source, 0);
  open.parts.allComponents = false;
  open.parts.magnitude = true;
  const float n = expectedVolume(0, 0)[5], m = expectedVolume(1, 0)[5], l = expectedVolume(2, 0)[5];
  CHECK(readVolume(*openVolume(path, open))[5] == Approx(std::sqrt(n * n + m * m + l * l)));
  open.raw->type = VoxelType::u8;
  open.raw->dims.x *= 2;
  CHECK(openVolume(path, open)->info().meaning == VoxelMeaning::colour);
  open.raw->components = 0;
  CHECK_THROWS_WITH(openVolume(path, open), Contains("components: expected 1 to 65536, found 0"));
}

TEST_CASE("The segments of a .seg.nrrd have names, values, layers and colours", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.seg.nrrd";
  writeBytes(path,
             "NRRD0004\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 1 2 1\n"
             "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\nencoding: raw\n"
             "Segment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Color:=0.5 0.25 1\n"
             "Segment1_Name:=tumour\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n\n" +
                 std::string("\1\0\1\1", 4));
  PartChoice all;
  all.allComponents = true;
  const auto source = openNrrd(path, true, all);
  CHECK(source->info().components == 2);
  REQUIRE(source->info().labels.size() == 2);
  CHECK(source->info().labels[0].name == "liver");
  CHECK(*source->info().labels[0].colour == glm::dvec3(0.5, 0.25, 1));
  CHECK(source->info().labels[1].component == 1);
  CHECK(!source->info().labels[1].colour);
  std::vector<float> out(4);
  source->readSlab(1, out);
  CHECK(out == std::vector<float>{1, 0, 1, 1});
}

TEST_CASE("The measurement frame of a NRRD turns vectors", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nrrd";
  std::string text = nrrdOf("cxyz");
  text.insert(text.find("\n\n"), "\nmeasurement frame: (0,1,0) (-1,0,0) (0,0,2)");
  writeBytes(path, text);
  PartChoice all;
  all.allComponents = true;
  const glm::dmat3 turn = openNrrd(path, true, all)->info().vectorToWorld;
  CHECK(turn * glm::dvec3(1, 0, 0) == glm::dvec3(0, 1, 0));
  CHECK(turn * glm::dvec3(0, 1, 3) == glm::dvec3(-1, 0, 6));
  // A world that is turned turns them too: from LPS to RAS.
  OpenOptions open;
  open.parts = all;
  open.space = "RAS";
  CHECK(openVolume(path, open)->info().vectorToWorld * glm::dvec3(0, 1, 3) == glm::dvec3(1, 0, 6));
}
