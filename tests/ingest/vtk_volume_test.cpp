// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/vtk_volume.h"

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <catch2/catch.hpp>

#include "ingest/small_volume.h"
#include "support/files.h"
#include "support/packed.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kImage = "<ImageData WholeExtent=\"0 1 0 2 0 1\" Origin=\"1 2 3\" Spacing=\"0.5 2 4\">";
const std::string kPiece = "<Piece Extent=\"0 1 0 2 0 1\"><PointData Scalars=\"a\">";

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string lz4Packed(const std::string& bytes) {
  std::string out(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))), '\0');
  out.resize(static_cast<std::size_t>(
      LZ4_compress_default(bytes.data(), out.data(), static_cast<int>(bytes.size()), static_cast<int>(out.size()))));
  return out;
}

// One way to store an array.
struct Storage {
  std::string compressor = {};
  bool wide = false, big = false;
  std::string number(std::uint64_t n) const {
    return wide ? bytesOf<std::uint64_t>({n}, big) : bytesOf<std::uint32_t>({static_cast<std::uint32_t>(n)}, big);
  }
  std::string pack(const std::string& block) const {
    return compressor == "vtkLZ4DataCompressor"    ? lz4Packed(block)
           : compressor == "vtkZLibDataCompressor" ? zlibPacked(block)
                                                   : xzPacked(block);
  }
  // The numbers in front, and the blocks of ten bytes.
  std::pair<std::string, std::string> parts() const {
    const std::string bytes = bytesOf(kValues, big);
    if (compressor.empty()) return {number(bytes.size()), bytes};
    std::string front = number(3) + number(10) + number(4), blocks;
    for (const std::size_t at : {0u, 10u, 20u}) {
      const std::string packed = pack(bytes.substr(at, 10));
      front += number(packed.size());
      blocks += packed;
    }
    return {front, blocks};
  }
  std::string file(const std::string& image = kImage, const std::string& piece = kPiece) const {
    return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"" + std::string(big ? "Big" : "Little") +
           "Endian\" header_type=\"UInt" + (wide ? "64" : "32") + '"' +
           (compressor.empty() ? "" : " compressor=\"" + compressor + '"') + '>' + image + piece;
  }
};

const std::string kClose = "</PointData></Piece></ImageData>";

std::string inlined(const Storage& s, const std::string& image = kImage, const std::string& piece = kPiece) {
  const auto [front, blocks] = s.parts();
  return s.file(image, piece) + "<DataArray Name=\"a\" type=\"Int16\" format=\"binary\">\n  " + base64(front) +
         base64(blocks) + "\n</DataArray>" + kClose + "</VTKFile>";
}

std::string appended(const Storage& s, bool raw) {
  const auto [front, blocks] = s.parts();
  return s.file() + "<DataArray Name=\"a\" type=\"Int16\" format=\"appended\" offset=\"" + (raw ? "2" : "0") + "\"/>" +
         kClose + "<AppendedData encoding=\"" + (raw ? "raw" : "base64") + "\">\n _" +
         (raw ? "<&" + front + blocks : base64(front) + base64(blocks)) + "\n</AppendedData></VTKFile>";
}

std::string ascii(const std::string& image, const std::string& piece = kPiece, const std::string& more = {}) {
  std::string text;
  for (const auto value : kValues) text += std::to_string(value) + '\n';
  return Storage{}.file(image, piece) + more + "<DataArray Name=\"a\" type=\"Int16\" format=\"ascii\">" + text +
         "</DataArray>" + kClose + "</VTKFile>";
}

struct VtkFile {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.vti";
  VolumeInfo info(const std::string& bytes) const {
    writeBytes(path, bytes);
    return openVolume(path)->info();
  }
  std::vector<float> read(const std::string& bytes) const {
    writeBytes(path, bytes);
    return readVolume(*openVolume(path));
  }
  void refused(const std::string& bytes, const std::string& message) const {
    CHECK_THROWS_AS(read(bytes), IoError);
    CHECK_THROWS_WITH(read(bytes), Contains(message) && Contains(path.string()));
  }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != text.npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("VTK ImageData is the same in every way to store it", "[ingest]") {
  const VtkFile file;
  CHECK(file.read(ascii(kImage)) == kFloats);
  for (const char* compressor : {"", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"})
    for (const bool wide : {false, true})
      for (const bool big : {false, true}) {
        const Storage storage{compressor, wide, big};
        INFO(compressor << " wide " << wide << " big " << big);
        CHECK(file.read(inlined(storage)) == kFloats);
        CHECK(file.read(appended(storage, /*raw=*/false)) == kFloats);
        CHECK(file.read(appended(storage, /*raw=*/true)) == kFloats);
      }
}

// world = origin + Direction (spacing * index), index counted from 0 and not from the start of the extent.
TEST_CASE("Extent, origin, spacing and direction of VTK ImageData place its voxels", "[ingest]") {
  const VtkFile file;
  const VolumeInfo info =
      file.info(ascii("<ImageData WholeExtent=\"10 11 -2 0 5 6\" Origin=\"1 2 3\" Spacing=\"0.5 2 4\" "
                      "Direction=\"0 -1 0 1 0 0 0 0 1\">",
                      "<Piece Extent=\"10 11 -2 0 5 6\"><PointData>"));
  CHECK(info.dims == glm::i64vec3(2, 3, 2));
  CHECK(info.indexToWorld == glm::dmat4(0, 0.5, 0, 0, -2, 0, 0, 0, 0, 0, 4, 0, 1 + 2 * 2, 2 + 0.5 * 10, 3 + 4 * 5, 1));
  CHECK(info.metadata.at("array_name") == "a");
}

TEST_CASE("Voxels of VTK cells lie at their centres", "[ingest]") {
  const VtkFile file;
  std::string text = ascii("<ImageData WholeExtent=\"0 2 0 3 0 2\" Origin=\"1 2 3\" Spacing=\"0.5 2 4\">",
                           "<Piece Extent=\"0 2 0 3 0 2\"><CellData>");
  const VolumeInfo info = file.info(replaced(text, "</PointData>", "</CellData>"));
  CHECK(info.dims == glm::i64vec3(2, 3, 2));
  CHECK(glm::dvec3(info.indexToWorld[3]) == glm::dvec3(1.25, 3, 5));
}

TEST_CASE("The scalars of VTK ImageData are those that it names", "[ingest]") {
  const VtkFile file;
  const std::string other = "<DataArray Name=\"b\" type=\"Float32\" format=\"ascii\">7</DataArray>";
  CHECK(file.read(ascii(kImage, kPiece, other)) == kFloats);
  const std::string unnamed = replaced(kPiece, " Scalars=\"a\"", "");
  file.refused(
      ascii(kImage, unnamed, other),
      "arrays: expected one of one component, one named by Scalars, or its name as in v.vti:name, found \"b, a\"");
  // A name wins over Scalars, and marks of ghosts are no voxels.
  CHECK(readVolume(*openVolume(file.path.string() + ":a")) == kFloats);
  CHECK(openVolume(file.path.string() + ":b")->info().type == VoxelType::f32);
  CHECK(formatOfName(file.path.string() + ":b") == "VTK ImageData");
  CHECK_THROWS_WITH(openVolume(file.path.string() + ":c"), Contains("expected one called c"));
  const std::string ghosts = "<DataArray Name=\"vtkGhostType\" type=\"UInt8\" format=\"ascii\">7</DataArray>";
  CHECK(file.read(ascii(kImage, unnamed, ghosts)) == kFloats);
}

TEST_CASE("Malformed VTK ImageData is refused with the field and both values", "[ingest]") {
  const VtkFile file;
  const std::string good = inlined({"vtkZLibDataCompressor"});
  file.refused(replaced(good, "vtkZLibDataCompressor", "vtkXDataCompressor"), "compressor: expected vtkZLib");
  file.refused(replaced(good, "type=\"ImageData\"", "type=\"PolyData\""),
               "type: expected ImageData, found \"PolyData\"");
  file.refused(replaced(good, "Int16", "String"), "type of the array");
  file.refused(replaced(good, "0 1 0 2 0 1\" Origin", "0 1 0 2 0 2\" Origin"),
               "Extent of the piece: expected 0 1 0 2 0 2");
  file.refused(replaced(replaced(good, "0 1 0 2 0 1", "0 2147483646 0 2147483646 0 2147483646"), "0 1 0 2 0 1",
                        "0 2147483646 0 2147483646 0 2147483646"),
               "WholeExtent: expected 1 to 2147483647 voxels along each axis and less than 2^63 bytes");
  file.refused(replaced(replaced(good, "0 1 0 2 0 1", "0 99999 0 9999 0 9999"), "0 1 0 2 0 1", "0 99999 0 9999 0 9999"),
               "number of blocks: expected 2000000000000, found 3");
  file.refused(replaced(good, "0.5 2 4", "0.5 0 4"), "Origin, Spacing and Direction");
  file.refused(replaced(good, "</Piece>", "</Peace>"), "line 3: expected XML");
  file.refused(replaced(inlined({}), "Int16", "Int32"), "bytes of the array: expected 48, found 24");
  for (const std::string& whole : {good, inlined({}), appended({"vtkLZ4DataCompressor"}, true), appended({}, false)}) {
    const std::size_t tail = std::min(whole.find("\n</"), whole.size());
    for (std::size_t length = 0; length < tail; length += 3) {
      writeBytes(file.path, whole.substr(0, length));
      CHECK_THROWS_AS(readVolume(*openVti(file.path)), IoError);
    }
  }
}

TEST_CASE("Legacy VTK files of structured points are read as ASCII and binary, and other kinds are refused",
          "[ingest]") {
  VtkFile file;
  file.path = file.folder.path() / "v.vtk";
  const auto head = [](const std::string& form, const std::string& data) {
    return "# vtk DataFile Version 3.0\ntitle\n" + form +
           "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 2\nORIGIN 1 2 3\nSPACING 0.5 2 4\n" + data;
  };
  const std::string scalars = "POINT_DATA 12\nSCALARS a short\nLOOKUP_TABLE default\n";
  const std::string bytes = bytesOf(kValues, /*reversed=*/true), more = "\nMETADATA\nINFORMATION 0\n";
  CHECK(file.read(head("BINARY", scalars + bytes + more)) == kFloats);
  CHECK(file.read(head("BINARY", "POINT_DATA 12\nFIELD FieldData 1\na 1 12 short\n" + bytes)) == kFloats);
  std::string text;
  for (const auto value : kValues) text += std::to_string(value) + ' ';
  const std::string ascii = head("ASCII", scalars + text + more);
  CHECK(file.read(ascii) == kFloats);
  CHECK(file.info(ascii).indexToWorld == glm::dmat4(0.5, 0, 0, 0, 0, 2, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1));
  CHECK(file.info(replaced(replaced(ascii, "2 3 2", "3 4 3"), "POINT_DATA", "CELL_DATA")).dims ==
        glm::i64vec3(2, 3, 2));
  file.refused(head("BINARY", scalars + bytes.substr(1)), "expected 2 x 3 x 2 i16 = 24 bytes after a header of");
  file.refused(replaced(ascii, "32767", ""), "voxel 11: expected a number that i16 can hold");
  file.refused(replaced(ascii, "STRUCTURED_POINTS", "POLYDATA"),
               "DATASET: expected STRUCTURED_POINTS, found \"POLYDATA\"");
  file.refused(replaced(ascii, "a short", "a short 9"), "then a name, a type and one component");
  file.refused(replaced(ascii, "a short", "a bit"), "type of the scalars");
  file.refused(replaced(ascii, "2 3 2", "2000000000 2000000000 2000000000"), "DIMENSIONS: expected 1 to 2147483647");
  file.refused(ascii.substr(0, 60),
               "head: expected SCALARS or a FIELD with one number for each of the points or cells, found \"the end");
}

// VTK writes fields of the dataset, such as its time, before or behind its place, and attributes in any order.
TEST_CASE("What stands before the scalars of a legacy VTK file is passed, and no field of another length is voxels",
          "[ingest]") {
  VtkFile file;
  file.path = file.folder.path() / "v.vtk";
  std::string text;
  for (const auto value : kValues) text += std::to_string(value) + '\n';
  const std::vector<double> time{1.5}, vectors(36, 7.0);
  for (const bool binary : {false, true}) {
    const auto values = [&](const std::vector<double>& of) {
      if (binary) return bytesOf(of, /*reversed=*/true) + '\n';
      std::string numbers;
      for (const double value : of) numbers += std::to_string(value) + ' ';
      return numbers + '\n';
    };
    const std::string voxels = binary ? bytesOf(kValues, true) + '\n' : text;
    const std::string start = "# vtk DataFile Version 3.0\n\n" + std::string(binary ? "BINARY" : "ASCII") +
                              "\n\nDATASET STRUCTURED_POINTS\n",
                      place = "DIMENSIONS 2 3 2\n\nSPACING 0.5 2 4\nORIGIN 1 2 3\n",
                      field = "FIELD FieldData 2\nTIME 1 1 double\n" + values(time) + "none 1 0 double\n\n",
                      scalars = "SCALARS a short 1\n\nLOOKUP_TABLE default\n" + voxels,
                      flow = "VECTORS flow double\n" + values(vectors),
                      several = "FIELD more 2\nwide 3 12 double\n" + values(vectors) + "b 1 12 short\n" + voxels;
    for (const std::string& content : {start + field + place + "POINT_DATA 12\n" + scalars,
                                       start + place + field + "POINT_DATA 12\n" + flow + scalars,
                                       start + place + "POINT_DATA 12\n" + field + several}) {
      INFO(content);
      CHECK(file.read(content) == kFloats);
      CHECK(file.info(content).indexToWorld[0][0] == 0.5);
    }
    writeBytes(file.path, start + place + "POINT_DATA 12\n" + scalars + several);
    CHECK(openVolume(file.path.string() + ":b")->info().metadata.at("array_name") == "b");
    CHECK(readVolume(*openVolume(file.path.string() + ":b")) == kFloats);
    // Vectors are read where there are no single numbers.
    PartChoice third;
    third.component = 2;
    std::vector<double> counted(36);
    for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = static_cast<double>(i);
    writeBytes(file.path, start + place + "POINT_DATA 12\nVECTORS flow double\n" + values(counted));
    const auto along = openLegacyVtk(file.path, third);
    CHECK(along->info().meaning == VoxelMeaning::vector);
    CHECK(along->info().components == 3);
    CHECK(readVolume(*along)[4] == 3 * 4 + 2);
    CHECK_THROWS_AS(openLegacyVtk(file.path), SeveralParts);
    file.refused(start + place + "POINT_DATA 11\n" + scalars, "POINT_DATA: expected the number of voxels that");
    file.refused(start + field, "found \"the end of the file\"");
  }
}

TEST_CASE("Vectors of VTK ImageData are read where they are named or alone", "[ingest]") {
  const VtkFile file;
  std::string numbers;
  for (int i = 0; i < 36; ++i) numbers += std::to_string(i) + ' ';
  const std::string vectors =
      "<DataArray Name=\"flow\" type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" + numbers + "</DataArray>";
  // Beside single numbers they have to be named.
  CHECK(file.read(ascii(kImage, kPiece, vectors)) == kFloats);
  PartChoice all;
  all.allComponents = true;
  OpenOptions open;
  open.parts = all;
  const auto source = openVolume(file.path.string() + ":flow", open);
  CHECK(source->info().valuesPerVoxel == 3);
  std::vector<float> slice(18);
  source->readSlab(1, slice);
  CHECK(slice[17] == 17);
  open.parts = {};
  open.parts.magnitude = true;
  CHECK(readVolume(*openVolume(file.path.string() + ":flow", open))[1] == Approx(std::sqrt(9.0 + 16 + 25)));
}
