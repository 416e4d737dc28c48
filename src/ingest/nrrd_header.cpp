// SPDX-License-Identifier: Apache-2.0
#include "ingest/nrrd_header.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "ingest/data_files.h"
#include "ingest/header_fields.h"
#include "ingest/header_lines.h"
#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/nrrd_axes.h"
#include "ingest/other_text.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using enum VoxelType;

constexpr std::size_t kNrrdMaxLine = 1 << 16;

constexpr std::array<std::pair<std::string_view, VoxelType>, 40> kNrrdTypes{{
    {"signed char", i8},
    {"int8", i8},
    {"int8_t", i8},
    {"uchar", u8},
    {"unsigned char", u8},
    {"uint8", u8},
    {"uint8_t", u8},
    {"short", i16},
    {"short int", i16},
    {"signed short", i16},
    {"signed short int", i16},
    {"int16", i16},
    {"int16_t", i16},
    {"ushort", u16},
    {"unsigned short", u16},
    {"unsigned short int", u16},
    {"uint16", u16},
    {"uint16_t", u16},
    {"int", i32},
    {"signed int", i32},
    {"int32", i32},
    {"int32_t", i32},
    {"uint", u32},
    {"unsigned int", u32},
    {"uint32", u32},
    {"uint32_t", u32},
    {"longlong", i64},
    {"long long", i64},
    {"long long int", i64},
    {"signed long long", i64},
    {"signed long long int", i64},
    {"int64", i64},
    {"int64_t", i64},
    {"ulonglong", u64},
    {"unsigned long long", u64},
    {"unsigned long long int", u64},
    {"uint64", u64},
    {"uint64_t", u64},
    {"float", f32},
    {"double", f64},
}};

constexpr std::array<std::pair<std::string_view, NrrdEncoding>, 9> kNrrdEncodings{{
    {"raw", NrrdEncoding::raw},
    {"gz", NrrdEncoding::gzip},
    {"gzip", NrrdEncoding::gzip},
    {"bz2", NrrdEncoding::bzip2},
    {"bzip2", NrrdEncoding::bzip2},
    {"txt", NrrdEncoding::text},
    {"text", NrrdEncoding::text},
    {"ascii", NrrdEncoding::text},
    {"hex", NrrdEncoding::hex},
}};

class NrrdHeaderReader {
 public:
  explicit NrrdHeaderReader(const fs::path& path) : lines_(path, kNrrdMaxLine), fields_(path) {}

  NrrdHeader read() {
    readLines();
    readLayout();
    readDataFiles();
    readNrrdAxes(fields_, header_);
    collectMetadata();
    return std::move(header_);
  }

 private:
  void readLines() {
    std::string text;
    lines_.next(text);
    if (!text.starts_with("NRRD000") || text.size() != 8 || text[7] < '1' || text[7] > '5')
      failText(fields_.path(), "first line", "NRRD0001 to NRRD0005");
    while (lines_.next(text) && !text.empty()) {
      if (text.front() == '#') continue;
      const std::string field = readField(text);
      if (field == "datafile" && announcesList(fields_.value(field))) {
        list_ = lines_.rest();
        break;
      }
    }
    header_.bytes = lines_.bytes();
  }

  // @return the name of the field, or nothing for a key of the user's
  std::string readField(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == text.npos || colon + 1 >= text.size() || (text[colon + 1] != ' ' && text[colon + 1] != '='))
      failText(fields_.path(), "header", "lines \"field: value\" or \"key:=value\"");
    if (text[colon + 1] == '=') {
      header_.metadata[text.substr(0, colon)] = text.substr(colon + 2);
      return {};
    }
    // Fields are written with and without blanks: "byte skip", "byteskip".
    std::string field = lower(text.substr(0, colon));
    std::erase(field, ' ');
    if (field == "centerings") field = "centers";
    if (fields_.has(field)) fields_.fail(field, "the field once", text.substr(colon + 1));
    fields_.set(field, trimmed(std::string_view(text).substr(colon + 1)));
    return field;
  }

  void readLayout() {
    const std::string type = lower(fields_.required("type"));
    const auto typeFound = valueNamed(kNrrdTypes, type);
    if (!typeFound) fields_.fail("type", "integers of 8 to 64 bits, float or double", type);
    header_.type = *typeFound;

    const std::string encoding = lower(fields_.required("encoding"));
    const auto encodingFound = valueNamed(kNrrdEncodings, encoding);
    if (!encodingFound) fields_.fail("encoding", "raw, gzip, bzip2, text or hex", encoding);
    header_.encoding = *encodingFound;

    const std::string endian = lower(fields_.value("endian"));
    const bool needed = voxelBytes(header_.type) > 1 && header_.encoding != NrrdEncoding::text;
    if (endian != "little" && endian != "big" && (endian != "" || needed))
      fields_.fail("endian", "little or big", endian);
    header_.bigEndian = endian == "big";

    header_.lineSkip = skip("line skip", "lineskip", 0);
    header_.byteSkip = skip("byte skip", "byteskip", -1);
    if (header_.byteSkip < 0 && header_.encoding != NrrdEncoding::raw)
      fields_.fail("byte skip", "0 or more with this encoding", fields_.value("byteskip"));
  }

  std::int64_t skip(const std::string& title, const std::string& field, std::int64_t least) const {
    if (!fields_.has(field)) return 0;
    const auto count = integer(fields_.value(field));
    if (!count || *count < least) fields_.fail(title, "a number from " + std::to_string(least), fields_.value(field));
    return *count;
  }

  void readDataFiles() {
    if (!fields_.has("datafile")) return;
    header_.dataFiles = dataFiles(fields_, {"datafile", "data file"}, list_);
    if (header_.dataFiles.empty()) fields_.fail("data file", "the name of a file", "");
  }

  void collectMetadata() {
    if (fields_.has("space")) header_.metadata["space"] = spaceName(fields_.value("space"));
    for (const char* field : {"space", "spaceunits", "units", "sampleunits", "content", "oldmin", "oldmax", "min",
                              "max", "measurementframe", "labels", "thicknesses"})
      if (fields_.has(field)) header_.metadata.emplace(std::string("nrrd_") + field, fields_.value(field));
  }

  HeaderLines lines_;
  HeaderFields fields_;  // by name, lower case, without blanks
  std::vector<std::string> list_;
  NrrdHeader header_;
};

}  // namespace

NrrdHeader readNrrdHeader(const fs::path& path) { return NrrdHeaderReader(path).read(); }

}  // namespace umbrick
