// SPDX-License-Identifier: Apache-2.0
#include "ingest/nrrd_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>
#include <string_view>

#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxLine = 1 << 16, kNrrdMaxHeader = 1 << 22, kNrrdMaxAxes = 16;

struct Axis {
  std::int64_t size = 0;
  double spacing = 1, min = 0;
  bool hasMin = false, cell = false;    // cell-centred: `min` is the edge of the first voxel
  std::optional<glm::dvec3> direction;  // of space
  bool spatial = true;
  std::string unit;
};

class NrrdHeaderReader {
 public:
  explicit NrrdHeaderReader(const fs::path& path) : path_(path), in_(path, std::ios::binary) {
    if (!in_) throw IoError(path.string() + ": cannot read");
  }

  NrrdHeader read() {
    readLines();
    readLayout();
    readDataFiles();
    const std::vector<Axis> axes = readAxes();
    for (std::size_t i = 0; i < axes.size(); ++i) header_.dims[static_cast<int>(i)] = axes[i].size;
    if (!volumeBytes(header_.dims, header_.type)) fail("sizes", "less than 2^63 bytes in all", value("sizes"));
    place(axes);
    toMillimetres(axes);
    collectMetadata();
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& field, const std::string& expected, std::string_view found) const {
    failField(path_, field, expected, found);
  }

  bool line(std::string& text) {
    text.clear();
    for (int c; (c = in_.get()) != std::ifstream::traits_type::eof();) {
      ++header_.bytes;
      if (c == '\n') {
        if (text.ends_with('\r')) text.pop_back();
        return true;
      }
      if (text.size() >= kMaxLine || static_cast<std::size_t>(header_.bytes) > kNrrdMaxHeader)
        throw IoError(path_.string() + ": header: expected lines of text, found " + std::to_string(header_.bytes) +
                      " bytes without an end");
      text.push_back(static_cast<char>(c));
    }
    if (text.ends_with('\r')) text.pop_back();
    return !text.empty();
  }

  void readLines() {
    std::string text;
    line(text);
    if (!text.starts_with("NRRD000") || text.size() != 8 || text[7] < '1' || text[7] > '5')
      fail("first line", "NRRD0001 to NRRD0005", text);
    while (line(text)) {
      if (text.empty()) return;
      if (text.front() == '#') continue;
      const std::size_t colon = text.find(':');
      if (colon == text.npos || colon + 1 >= text.size() || (text[colon + 1] != ' ' && text[colon + 1] != '='))
        fail("header", "\"field: value\" or \"key:=value\"", text);
      if (text[colon + 1] == '=') {
        header_.metadata[text.substr(0, colon)] = text.substr(colon + 2);
        continue;
      }
      // Fields are written with and without blanks: "byte skip", "byteskip".
      std::string field = lower(text.substr(0, colon));
      std::erase(field, ' ');
      if (field == "centerings") field = "centers";
      if (!fields_.emplace(field, std::string(trimmed(std::string_view(text).substr(colon + 1)))).second)
        fail(field, "the field once", text);
      if (field == "datafile" && announcesList(value(field))) {
        while (line(text))
          if (!trimmed(text).empty()) list_.emplace_back(trimmed(text));
        return;
      }
    }
  }

  std::string value(const std::string& field) const {
    const auto found = fields_.find(field);
    return found == fields_.end() ? std::string() : found->second;
  }

  std::string required(const std::string& field) const {
    if (!fields_.contains(field)) fail(field, "the field", "");
    return value(field);
  }

  void readLayout() {
    using enum VoxelType;
    static constexpr std::array<std::pair<std::string_view, VoxelType>, 40> kTypes{{
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
    const std::string type = lower(required("type"));
    const auto row = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& each) { return each.first == type; });
    if (type.empty() || row == kTypes.end()) fail("type", "integers of 8 to 64 bits, float or double", type);
    header_.type = row->second;

    const std::string encoding = lower(required("encoding"));
    if (encoding == "raw")
      header_.encoding = NrrdEncoding::raw;
    else if (encoding == "gz" || encoding == "gzip")
      header_.encoding = NrrdEncoding::gzip;
    else if (encoding == "bz2" || encoding == "bzip2")
      header_.encoding = NrrdEncoding::bzip2;
    else if (encoding == "txt" || encoding == "text" || encoding == "ascii")
      header_.encoding = NrrdEncoding::text;
    else if (encoding == "hex")
      header_.encoding = NrrdEncoding::hex;
    else
      fail("encoding", "raw, gzip, bzip2, text or hex", encoding);

    const std::string endian = lower(value("endian"));
    if (endian != "" && endian != "little" && endian != "big") fail("endian", "little or big", endian);
    if (endian == "" && voxelBytes(header_.type) > 1 && header_.encoding != NrrdEncoding::text)
      fail("endian", "little or big", endian);
    header_.bigEndian = endian == "big";

    header_.lineSkip = skip("line skip", "lineskip", 0);
    header_.byteSkip = skip("byte skip", "byteskip", -1);
    if (header_.byteSkip < 0 && header_.encoding != NrrdEncoding::raw)
      fail("byte skip", "0 or more with this encoding", value("byteskip"));
  }

  std::int64_t skip(const std::string& title, const std::string& field, std::int64_t least) const {
    if (!fields_.contains(field)) return 0;
    const auto count = integer(value(field));
    if (!count || *count < least) fail(title, "a number from " + std::to_string(least), value(field));
    return *count;
  }

  void readDataFiles() {
    if (!fields_.contains("datafile")) return;
    std::vector<std::string> names;
    const std::vector<std::string> parts = words(value("datafile"));
    if (announcesList(value("datafile"))) {
      names = list_;
    } else if (parts.size() >= 4 && parts[0].find('%') != std::string::npos) {
      names = numberedNames(parts[0], parts[1], parts[2], parts[3]);
      if (names.empty())
        fail("data file", "a pattern with one %d or %03d, then first, last and step", value("datafile"));
    } else {
      names = {value("datafile")};
    }
    if (names.empty() || names.front().empty()) fail("data file", "the name of a file", "");
    for (const std::string& name : names) header_.dataFiles.push_back(path_.parent_path() / name);
  }

  // One value per axis.
  std::vector<std::string> perAxis(const std::string& field, std::size_t count) const {
    std::vector<std::string> values = words(value(field));
    if (values.size() != count) fail(field, std::to_string(count) + " values", value(field));
    return values;
  }

  // "(a,b,c)" or "none"
  std::optional<glm::dvec3> vector(const std::string& field, std::string_view text, int dimension) const {
    if (text == "none") return std::nullopt;
    glm::dvec3 out(0);
    std::string_view rest = text;
    const bool enclosed = rest.size() >= 2 && rest.front() == '(' && rest.back() == ')';
    if (enclosed) rest = rest.substr(1, rest.size() - 2);
    for (int i = 0; i < dimension; ++i) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      const auto part = number(trimmed(rest.substr(0, comma)));
      const bool last = i + 1 == dimension;
      if (!enclosed || !part || !std::isfinite(*part) || (comma == rest.size()) != last)
        fail(field, "a vector of " + std::to_string(dimension) + " finite numbers, like (0,0,1)", text);
      out[i] = *part;
      rest.remove_prefix(last ? comma : comma + 1);
    }
    return out;
  }

  // "(1, 0, 0) none (0,1,0)": blanks may stand inside the brackets.
  static std::vector<std::string> vectors(std::string_view text) {
    std::string packed;
    int depth = 0;
    for (const char c : text) {
      depth += (c == '(') - (c == ')');
      if (depth > 0 && (c == ' ' || c == '\t')) continue;
      packed += c;
      if (c == ')') packed += ' ';
    }
    return words(packed);
  }

  int spaceDimension() const {
    const std::string space = lower(value("space"));
    if (space.empty()) {
      const auto dimension = fields_.contains("spacedimension") ? integer(value("spacedimension")) : std::nullopt;
      if (!dimension) return 0;
      if (*dimension < 2 || *dimension > 3) fail("space dimension", "2 or 3", value("spacedimension"));
      return static_cast<int>(*dimension);
    }
    if (space.find("time") != std::string::npos || (space.size() == 4 && space.ends_with('t')))
      fail("space", "a space of three dimensions", space);
    return 3;
  }

  std::vector<Axis> readAxes() {
    const auto dimension = integer(required("dimension"));
    if (!dimension || *dimension < 1 || *dimension > static_cast<std::int64_t>(kNrrdMaxAxes))
      fail("dimension", "1 to " + std::to_string(kNrrdMaxAxes), value("dimension"));
    std::vector<Axis> axes(static_cast<std::size_t>(*dimension));
    required("sizes");
    const std::vector<std::string> sizes = perAxis("sizes", axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto size = integer(sizes[i]);
      if (!size || *size < 1 || *size > std::numeric_limits<std::int32_t>::max())
        fail("sizes", "numbers from 1 to 2147483647", value("sizes"));
      axes[i].size = *size;
    }
    readSpacings(axes);
    readDirections(axes);
    if (fields_.contains("kinds")) {
      const std::vector<std::string> kinds = perAxis("kinds", axes.size());
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::string kind = lower(kinds[i]);
        if (kind != "domain" && kind != "space" && kind != "???" && kind != "none" && kind != "scalar" &&
            kind != "stub")
          axes[i].spatial = false;
      }
    }
    // Axes of size 1 that are not of space, or too many, go.
    std::erase_if(axes, [](const Axis& axis) { return !axis.spatial && axis.size == 1; });
    for (std::size_t i = axes.size(); i-- > 0 && axes.size() > 3;)
      if (axes[i].size == 1) axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(i));
    for (const Axis& axis : axes)
      if (!axis.spatial)
        fail("sizes",
             "one component per voxel (an axis of time or of components has " + std::to_string(axis.size) + ")",
             value("sizes"));
    if (axes.size() < 2 || axes.size() > 3) fail("sizes", "a volume of two or three axes", value("sizes"));
    return axes;
  }

  void readSpacings(std::vector<Axis>& axes) const {
    for (const char* field : {"units", "spacings", "axismins", "centers"}) {
      if (!fields_.contains(field)) continue;
      const std::vector<std::string> values = perAxis(field, axes.size());
      for (std::size_t i = 0; i < axes.size(); ++i) {
        if (std::string_view(field) == "units") {
          axes[i].unit = values[i];
          continue;
        }
        if (std::string_view(field) == "centers") {
          axes[i].cell = lower(values[i]) == "cell";
          continue;
        }
        const auto parsed = number(values[i]);
        if (parsed && std::isnan(*parsed)) continue;  // the format's way to say: unknown
        const bool spacing = std::string_view(field) == "spacings";
        if (!parsed || !std::isfinite(*parsed) || (spacing && !(*parsed > 0)))
          fail(field, spacing ? "positive finite numbers, or nan where unknown" : "finite numbers", value(field));
        (spacing ? axes[i].spacing : axes[i].min) = *parsed;
        axes[i].hasMin = axes[i].hasMin || !spacing;
      }
    }
  }

  void readDirections(std::vector<Axis>& axes) const {
    if (!fields_.contains("spacedirections")) return;
    const int dimension = spaceDimension();
    if (dimension == 0) fail("space", "the field, or space dimension, beside space directions", "");
    const std::vector<std::string> texts = vectors(value("spacedirections"));
    if (texts.size() != axes.size())
      fail("space directions", std::to_string(axes.size()) + " vectors", value("spacedirections"));
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i].direction = vector("space directions", texts[i], dimension);
      axes[i].spatial = axes[i].direction.has_value();
    }
  }

  void place(const std::vector<Axis>& axes) {
    glm::dmat4& m = header_.indexToWorld;
    if (axes[0].direction) {
      for (std::size_t i = 0; i < axes.size(); ++i) m[static_cast<int>(i)] = glm::dvec4(*axes[i].direction, 0);
      if (axes.size() == 2) {
        // One slice: as thick as its pixels are wide, along the normal.
        const glm::dvec3 normal = glm::cross(*axes[0].direction, *axes[1].direction);
        const double area = glm::length(normal);
        m[2] = glm::dvec4(area > 0 ? normal / std::sqrt(area) : normal, 0);
      }
      const double volume =
          glm::length(glm::dvec3(m[0])) * glm::length(glm::dvec3(m[1])) * glm::length(glm::dvec3(m[2]));
      if (!(std::abs(glm::determinant(glm::dmat3(m))) > 1e-9 * volume))
        fail("space directions", "independent directions", value("spacedirections"));
      if (fields_.contains("spaceorigin")) {
        const std::vector<std::string> texts = vectors(value("spaceorigin"));
        const auto origin = texts.size() == 1 ? vector("space origin", texts[0], spaceDimension()) : std::nullopt;
        if (!origin) fail("space origin", "one vector", value("spaceorigin"));
        m[3] = glm::dvec4(*origin, 1);
      }
      return;
    }
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const int axis = static_cast<int>(i);
      m[axis][axis] = axes[i].spacing;
      if (axes[i].hasMin) m[3][axis] = axes[i].min + (axes[i].cell ? 0.5 * axes[i].spacing : 0.0);
    }
  }

  // Units of space scale the axes of the world; without a space those of the file's axes do.
  void toMillimetres(const std::vector<Axis>& axes) {
    std::vector<std::string> units;
    if (axes[0].direction)
      units = words(value("spaceunits"));
    else
      for (const Axis& axis : axes) units.push_back(axis.unit);
    if (units.empty() || units.size() > 3) return;
    glm::dvec3 factor(1);
    for (std::size_t i = 0; i < units.size(); ++i) {
      const auto millimetres = millimetresPer(units[i]);
      if (!millimetres) return;  // unknown: left as it is
      factor[static_cast<int>(i)] = *millimetres;
    }
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) header_.indexToWorld[column][row] *= factor[row];
    header_.metadata["length_unit"] = "mm";
  }

  void collectMetadata() {
    if (fields_.contains("space")) header_.metadata["space"] = spaceName(value("space"));
    for (const char* field : {"space", "spaceunits", "units", "sampleunits", "content", "oldmin", "oldmax", "min",
                              "max", "measurementframe", "labels", "thicknesses"})
      if (fields_.contains(field)) header_.metadata.emplace(std::string("nrrd_") + field, value(field));
  }

  fs::path path_;
  std::ifstream in_;
  NrrdHeader header_;
  std::map<std::string, std::string> fields_;  // by name, lower case, without blanks
  std::vector<std::string> list_;
};

}  // namespace

NrrdHeader readNrrdHeader(const fs::path& path) { return NrrdHeaderReader(path).read(); }

}  // namespace umbrick
