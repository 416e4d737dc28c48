// Axes of frames and of components in HDF5 and netCDF-4.
// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "ingest/write_hdf5.h"
#include "support/read_volume.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/list_arrays.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Names the axes of a dataset by scales, as netCDF-4 does. An empty name is no scale.
void nameAxes(const Hdf5File& file, const char* dataset, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (!name.empty()) file.add(('/' + name).c_str(), {1}, H5T_IEEE_F32LE, H5T_NATIVE_INT, std::vector<int>{0});
  const hid_t opened = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(opened, dataset, H5P_DEFAULT);
  std::vector<hobj_ref_t> references(names.size());
  std::vector<hvl_t> lists(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    lists[i] = {names[i].empty() ? 0u : 1u, &references[i]};
    if (!names[i].empty()) H5Rcreate(&references[i], opened, ('/' + names[i]).c_str(), H5R_OBJECT, -1);
  }
  const hsize_t count = names.size();
  const hid_t type = H5Tvlen_create(H5T_STD_REF_OBJ), space = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(set, "DIMENSION_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, lists.data());
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(opened);
}

// Names the axes by labels, as h5py does.
void labelAxes(const Hdf5File& file, const char* dataset, const std::vector<const char*>& names) {
  const hid_t opened = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(opened, dataset, H5P_DEFAULT);
  const hsize_t count = names.size();
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &count, nullptr);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t attribute = H5Acreate2(set, "DIMENSION_LABELS", type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, names.data());
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(opened);
}

std::vector<int> counting(std::size_t count) {
  std::vector<int> values(count);
  std::iota(values.begin(), values.end(), 1);
  return values;
}

OpenOptions part(std::optional<std::int64_t> frame, std::optional<std::int64_t> component = {}) {
  OpenOptions options;
  options.parts.frame = frame;
  options.parts.component = component;
  options.parts.allComponents = !component;
  return options;
}

// The number in counting() at these places along the axes of a shape.
float at(const std::vector<hsize_t>& shape, const std::vector<std::int64_t>& places) {
  std::int64_t number = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) number = number * static_cast<std::int64_t>(shape[i]) + places[i];
  return static_cast<float>(number + 1);
}

// A dataset of counting numbers whose axes have these lengths, in chunks that frames share.
std::string addCounting(const Hdf5File& file, const std::string& name, const std::vector<hsize_t>& shape,
                        const std::vector<hsize_t>& most = {}) {
  const std::size_t count = std::accumulate(shape.begin(), shape.end(), std::size_t(1), std::multiplies<>());
  std::vector<hsize_t> chunk(shape.size(), 2);
  for (std::size_t i = 0; i < shape.size(); ++i) chunk[i] = std::min(chunk[i], shape[i]);
  file.add(('/' + name).c_str(), shape, H5T_STD_I16BE, H5T_NATIVE_INT, counting(count), chunk, most);
  return file.path.string() + ":/" + name;
}

void checkNote(const VolumeInfo& info, const std::string& text) {
  CAPTURE(info.notes);
  CHECK(std::any_of(info.notes.begin(), info.notes.end(),
                    [&](const std::string& note) { return note.find(text) != std::string::npos; }));
}

}  // namespace

TEST_CASE("The first of four axes of HDF5 is one of frames", "[ingest][hdf5]") {
  const Hdf5File file;
  const std::vector<hsize_t> shape{5, 2, 3, 6};
  addCounting(file, "v", shape);
  CHECK_THROWS_AS(openVolume(file.path), SeveralParts);
  CHECK_THROWS_WITH(openVolume(file.path), Contains("a sequence of 5 volumes, frame 0 to 4"));
  CHECK(describeVolume(file.path).frames == 5);
  for (std::int64_t frame = 0; frame < 5; ++frame) {
    const auto source = openVolume(file.path, part(frame));
    CHECK(source->info().dims == glm::i64vec3(6, 3, 2));
    CHECK(source->info().components == 1);
    checkNote(source->info(), "axis 1 of 5 x 2 x 3 x 6, is taken for frames, since it is the first one");
    checkNote(source->info(), "dataset /v is taken, the only one with axes of frames or of components");
    const std::vector<float> values = readVolume(*source);
    CHECK(values.front() == at(shape, {frame, 0, 0, 0}));
    CHECK(values[6 * 2 + 4] == at(shape, {frame, 0, 2, 4}));
    CHECK(values.back() == at(shape, {frame, 1, 2, 5}));
  }
  CHECK_THROWS_WITH(openVolume(file.path, part(5)), Contains("frame: expected 0 to 4, found 5"));
}

TEST_CASE("Names, units and unlimited axes say which axis of HDF5 is the one of frames", "[ingest][hdf5]") {
  const Hdf5File file;
  const std::vector<hsize_t> shape{2, 5, 3, 6};
  const auto frames = [&](const std::string& name, const std::string& why) {
    const auto source = openVolume(file.path.string() + ":/" + name, part(4));
    CHECK(source->info().frames == 5);
    CHECK(source->info().dims == glm::i64vec3(6, 3, 2));
    CHECK(readVolume(*source).back() == at(shape, {1, 4, 2, 5}));
    checkNote(source->info(), why);
  };
  addCounting(file, "scaled", shape);
  nameAxes(file, "/scaled", {"lev", "Time", "lat", "lon"});
  frames("scaled", "axis 2 of 2 x 5 x 3 x 6, \"time\", is taken for frames, by its name or unit");
  addCounting(file, "labelled", shape);
  labelAxes(file, "/labelled", {"z", "t", "y", "x"});
  frames("labelled", "axis 2 of 2 x 5 x 3 x 6, \"t\", is taken for frames, by its name or unit");
  addCounting(file, "grows", shape, {2, H5S_UNLIMITED, 3, 6});
  frames("grows", "axis 2 of 2 x 5 x 3 x 6, is taken for frames, since it alone is unlimited");
  addCounting(file, "dated", shape);
  nameAxes(file, "/dated", {"", "when", "", ""});
  describe(file, "/when", "units", "days since 2000-01-01");
  frames("dated", "\"when\", is taken for frames, by its name or unit");
}

TEST_CASE("Axes of length 1 beside four others are dropped, and one frame is none", "[ingest][hdf5]") {
  const Hdf5File file;
  addCounting(file, "five", {1, 5, 2, 3, 6});
  addCounting(file, "flat", {5, 1, 3, 6});
  nameAxes(file, "/flat", {"time", "level", "", ""});
  // Three axes stay those of space, and a single frame is the volume.
  addCounting(file, "three", {5, 3, 6});
  labelAxes(file, "/three", {"time", "y", "x"});
  addCounting(file, "one", {2, 1, 3, 6});
  labelAxes(file, "/one", {"z", "time", "y", "x"});
  const auto five = openVolume(file.path.string() + ":/five", part(3));
  CHECK(five->info().dims == glm::i64vec3(6, 3, 2));
  CHECK(readVolume(*five).front() == at({1, 5, 2, 3, 6}, {0, 3, 0, 0, 0}));
  const auto flat = openVolume(file.path.string() + ":/flat", part(2));
  CHECK(flat->info().dims == glm::i64vec3(6, 3, 1));
  CHECK(readVolume(*flat).back() == at({5, 1, 3, 6}, {2, 0, 2, 5}));
  const auto three = openVolume(file.path.string() + ":/three");
  CHECK(three->info().dims == glm::i64vec3(6, 3, 5));
  checkNote(three->info(), "is taken for one of space, since there are three axes");
  CHECK(openVolume(file.path.string() + ":/one")->info().dims == glm::i64vec3(6, 3, 2));
}

TEST_CASE("Components of HDF5 lie side by side wherever their axis stands", "[ingest][hdf5]") {
  const Hdf5File file;
  struct Case {
    std::vector<hsize_t> shape;
    std::vector<const char*> labels;
    std::size_t components, space[3];
    VoxelMeaning meaning;
    const char* why;
  };
  const std::vector<Case> cases{
      {{2, 4, 5, 3}, {}, 3, {0, 1, 2}, VoxelMeaning::vector, "since it is the last one and has a length of 2 to 4"},
      {{2, 4, 5, 3}, {"", "", "", "RGB"}, 3, {0, 1, 2}, VoxelMeaning::colour, "\"rgb\", is taken for components, by"},
      {{3, 2, 4, 5}, {"vector", "z", "y", "x"}, 0, {1, 2, 3}, VoxelMeaning::vector, "\"vector\", is taken for"},
      {{2, 3, 4, 5}, {"z", "c", "y", "x"}, 1, {0, 2, 3}, VoxelMeaning::vector, "\"c\", is taken for components, by"}};
  int number = 0;
  for (const Case& each : cases) {
    const std::string name = "v" + std::to_string(number++), path = addCounting(file, name, each.shape);
    if (!each.labels.empty()) labelAxes(file, ('/' + name).c_str(), each.labels);
    CHECK_THROWS_AS(openVolume(path), SeveralParts);
    const auto source = openVolume(path, part({}));
    checkNote(source->info(), each.why);
    CHECK(source->info().meaning == each.meaning);
    REQUIRE(source->info().valuesPerVoxel == 3);
    REQUIRE(source->info().dims == glm::i64vec3(5, 4, 2));
    // One slice after the other, so that each slab is the start of another.
    std::vector<float> values(2 * 60);
    source->readSlab(1, std::span(values).first(60));
    source->readSlab(1, std::span(values).last(60));
    const std::vector<float> second = readVolume(*openVolume(path, part({}, 1)));
    OpenOptions lengths;
    lengths.parts.magnitude = true;
    const std::vector<float> magnitudes = readVolume(*openVolume(path, lengths));
    for (std::int64_t z = 0; z < 2; ++z)
      for (std::int64_t y = 0; y < 4; ++y)
        for (std::int64_t x = 0; x < 5; ++x) {
          const auto voxel = static_cast<std::size_t>((z * 4 + y) * 5 + x);
          double squares = 0;
          for (std::int64_t k = 0; k < 3; ++k) {
            std::vector<std::int64_t> places(4);
            places[each.space[0]] = z, places[each.space[1]] = y, places[each.space[2]] = x;
            places[each.components] = k;
            const float expected = at(each.shape, places);
            REQUIRE(values[voxel * 3 + static_cast<std::size_t>(k)] == expected);
            if (k == 1) REQUIRE(second[voxel] == expected);
            squares += double(expected) * expected;
          }
          REQUIRE(magnitudes[voxel] == Approx(std::sqrt(squares)));
        }
  }
}

TEST_CASE("Frames and components of HDF5 go together, and names of space are none", "[ingest][hdf5]") {
  const Hdf5File file;
  const std::vector<hsize_t> shape{4, 2, 5, 6, 3};
  const std::string path = addCounting(file, "v", shape);
  // A small last axis that is called x is one of space.
  const std::string narrow = addCounting(file, "narrow", {4, 5, 6, 3});
  labelAxes(file, "/narrow", {"t", "z", "y", "x"});
  const auto source = openVolume(path, part(3));
  CHECK(source->info().frames == 4);
  CHECK(source->info().components == 3);
  CHECK(source->info().dims == glm::i64vec3(6, 5, 2));
  CHECK(readVolume(*openVolume(path, part(3, 2))).back() == at(shape, {3, 1, 4, 5, 2}));
  const auto space = openVolume(narrow, part(1));
  CHECK(space->info().components == 1);
  CHECK(space->info().dims == glm::i64vec3(3, 6, 5));
}

TEST_CASE("Scale, missing values and sizes of elements hold for each frame of HDF5", "[ingest][hdf5]") {
  const Hdf5File file;
  const std::string path = addCounting(file, "v", {3, 2, 2, 5});
  describe(file, "/v", "scale_factor", H5T_IEEE_F64LE, std::vector<double>{0.5});
  describe(file, "/v", "add_offset", H5T_IEEE_F64LE, std::vector<double>{100});
  describe(file, "/v", "_FillValue", H5T_STD_I16LE, std::vector<int>{43});
  describe(file, "/v", "element_size_um", H5T_IEEE_F64LE, std::vector<double>{3, 2, 1});
  const auto source = openVolume(path, part(2));
  CHECK(source->info().indexToWorld[0][0] == Approx(1e-3));
  CHECK(source->info().indexToWorld[2][2] == Approx(3e-3));
  const std::vector<float> values = readVolume(*source);
  CHECK(values[0] == Approx(100 + 0.5 * 41));
  CHECK(std::isnan(values[2]));
  CHECK(values[19] == Approx(100 + 0.5 * 60));
}

TEST_CASE("A dataset of three axes is taken before sequences, and both are listed", "[ingest][hdf5]") {
  const Hdf5File file;
  addCounting(file, "movie", {3, 2, 2, 5});
  addCounting(file, "still", {2, 2, 5});
  CHECK(openVolume(file.path)->info().metadata.at("source_dataset") == "/still");
  addCounting(file, "other", {2, 2, 5});
  CHECK_THROWS_WITH(openVolume(file.path), Contains("found /other, /still, /movie"));
  const std::vector<ArrayRow> rows = listArrays(file.path);
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].name == "/movie");
  CHECK(rows[0].volume);
}

TEST_CASE("Damaged names of axes are no names", "[ingest][hdf5]") {
  const Hdf5File file;
  const std::string path = addCounting(file, "v", {3, 2, 2, 5});
  describe(file, "/v", "DIMENSION_LIST", "time");
  describe(file, "/v", "DIMENSION_LABELS", H5T_STD_I16LE, std::vector<int>{1, 2, 3, 4});
  checkNote(openVolume(path, part(0))->info(), "is taken for frames, since it is the first one");
}
