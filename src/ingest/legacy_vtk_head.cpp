// SPDX-License-Identifier: Apache-2.0
#include "ingest/legacy_vtk_head.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <vector>

#include "ingest/header_text.h"
#include "ingest/other_text.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxVtkLine = 4096;
constexpr std::int64_t kMostValues = std::int64_t(1) << 56;

std::optional<VoxelType> legacyType(const std::string& text) {
  using enum VoxelType;
  static const std::map<std::string, VoxelType> types{
      {"unsigned_char", u8}, {"char", i8},           {"unsigned_short", u16}, {"short", i16},
      {"unsigned_int", u32}, {"int", i32},           {"unsigned_long", u64},  {"long", i64},
      {"vtktypeint64", i64}, {"vtktypeuint64", u64}, {"vtkidtype", i32},      {"float", f32},
      {"double", f64},       {"signed_char", i8}};
  const auto found = types.find(lower(text));
  return found == types.end() ? std::nullopt : std::optional(found->second);
}

// An array of the file: so many values of a type.
struct Values {
  std::string name, type;
  std::int64_t tuples = 0, components = 1;
  VoxelMeaning meaning = VoxelMeaning::scalar;
};

class LegacyHeadReader {
 public:
  LegacyHeadReader(const fs::path& path, const std::string& name)
      : path_(path), name_(name), in_(path, std::ios::binary) {}

  LegacyHead read() {
    begin();
    try {
      while (!atVoxels()) {
      }
    } catch (const NoSingleNumbers&) {
      return *several_;
    }
    head_.bytes = static_cast<std::int64_t>(in_.tellg());
    return head_;
  }

  // Passes everything, and tells what it was.
  std::vector<ArrayRow> list() {
    begin();
    listing_ = true;
    try {
      while (!atVoxels()) {
      }
    } catch (const EndOfFile&) {
    }
    return std::move(rows_);
  }

 private:
  struct EndOfFile {};
  struct NoSingleNumbers {};  // the file ends, and had arrays of several numbers alone

  void begin() {
    if (!line().starts_with("# vtk DataFile Version")) failText(path_, "first line", "# vtk DataFile Version");
    line();  // the title
    const std::string form = lower(trimmed(filledLine()));
    if (form != "ascii" && form != "binary") failField(path_, "third line", "ASCII or BINARY", form);
    head_.ascii = form == "ascii";
  }

  // Where the file ends, what was passed is told.
  const std::string& line() {
    line_.clear();
    char c = 0;
    while (in_.get(c) && c != '\n')
      if (line_.push_back(c); line_.size() > kMaxVtkLine)
        failText(path_, "head", "lines of at most " + std::to_string(kMaxVtkLine) + " characters");
    if (!in_ && listing_) throw EndOfFile{};
    if (!in_ && several_) throw NoSingleNumbers();
    if (!in_)
      failField(path_, "head",
                name_.empty() ? "SCALARS or a FIELD with one number for each of the points or cells"
                              : "an array " + name_ + " with one number for each of the points or cells",
                passed_.empty() ? "the end of the file" : "only " + passed_);
    return line_;
  }
  const std::string& filledLine() {
    while (trimmed(line()).empty()) {
    }
    return line_;
  }

  template <class T, class Parse>
  std::array<T, 3> three(const std::vector<std::string>& parts, const Parse& parse) const {
    std::array<T, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = parts.size() == 4 ? parse(parts[i + 1]) : std::nullopt;
      if (!value) failField(path_, parts[0], "three numbers", line_);
      out[i] = *value;
    }
    return out;
  }

  // Takes in one line and what belongs to it. @return true when voxels follow
  bool atVoxels() {
    const std::vector<std::string> parts = words(filledLine());
    const std::string key = lower(parts[0]);
    if (key == "dataset") {
      if (parts.size() != 2 || lower(parts[1]) != "structured_points")
        failField(path_, "DATASET", "STRUCTURED_POINTS", parts.size() > 1 ? parts[1] : "");
    } else if (key == "dimensions") {
      head_.points = three<std::int64_t>(parts, integer);
    } else if (key == "origin") {
      head_.origin = three<double>(parts, number);
    } else if (key == "spacing" || key == "aspect_ratio") {
      head_.spacing = three<double>(parts, number);
    } else if (key == "point_data" || key == "cell_data") {
      beginSection(parts, key == "cell_data");
    } else if (key == "scalars") {
      return scalarsAtVoxels(parts);
    } else if (key == "field") {
      return fieldAtVoxels(parts);
    } else if (key == "metadata") {
      while (!trimmed(line()).empty()) {
      }
    } else {
      return attributeAtVoxels(key, parts);
    }
    return false;
  }

  void beginSection(const std::vector<std::string>& parts, bool cells) {
    std::int64_t expected = 1;
    for (const std::int64_t points : head_.points)
      if (__builtin_mul_overflow(expected, points - (cells ? 1 : 0), &expected)) expected = -1;
    const auto count = parts.size() == 2 ? integer(parts[1]) : std::nullopt;
    if (!count || *count < 0 || *count > kMostValues) failField(path_, parts[0], "a number of values", line_);
    head_.cells = cells;
    count_ = *count;
    fits_ = *count == expected || expected < 0;  // too many are refused when all is known
  }

  // Whether these are the voxels that are looked for.
  bool isVoxels(const Values& values) const { return !listing_ && couldBeVoxels(values); }
  bool couldBeVoxels(const Values& values) const {
    constexpr std::int64_t kMostComponents = 65536;
    return count_ && values.tuples == *count_ && values.components >= 1 && values.components <= kMostComponents &&
           (values.components == 1 || !name_.empty() || listing_) && legacyType(values.type) &&
           (name_.empty() ? values.name.substr(0, 8) != "vtkGhost" : values.name == name_);
  }

  bool take(const Values& values) {
    if (!fits_)
      failField(path_, head_.cells ? "CELL_DATA" : "POINT_DATA", "the number of voxels that DIMENSIONS make",
                std::to_string(*count_));
    head_.array = values.name;
    head_.type = *legacyType(values.type);
    head_.components = values.components;
    head_.meaning = values.meaning;
    return true;
  }

  // Keeps the first array of several numbers, in case that there is none of one.
  void keepSeveral(const Values& values) {
    if (several_ || !name_.empty() || !fits_ || values.components < 2 || values.components > 4 ||
        values.tuples != *count_ || !legacyType(values.type))
      return;
    several_ = head_;
    several_->array = values.name;
    several_->type = *legacyType(values.type);
    several_->components = values.components;
    several_->meaning = values.meaning;
    several_->bytes = static_cast<std::int64_t>(in_.tellg());
  }

  void pass(const Values& values) {
    const auto type = legacyType(values.type);
    const std::string many = values.components == 1 ? "" : std::to_string(values.components) + " x ";
    if (listing_)
      rows_.push_back({values.name,
                       std::to_string(values.tuples) + (!count_ || values.tuples != *count_ ? " values"
                                                        : head_.cells                       ? " cells"
                                                                                            : " points"),
                       many + (type ? std::string(voxelTypeName(*type)) : values.type), couldBeVoxels(values)});
    if (count_)
      passed_ += (passed_.empty() ? "" : ", ") + values.name + " of " + std::to_string(values.components) + " x " +
                 values.type;
    if (passed_.size() > 200) passed_.resize(200);
    if (count_) keepSeveral(values);
    if (!count_ && values.tuples == 1 && values.components == 1 && type && takeTime(values, *type)) return;
    skipValues(values);
  }

  // Keeps the time and the number of a step. Their names are those of VisIt (TIME, CYCLE) and of ParaView (TimeValue).
  bool takeTime(const Values& values, VoxelType type) {
    const bool cycle = values.name == "CYCLE";
    if (!cycle && values.name != "TIME" && values.name != "TimeValue") return false;
    const auto begin = in_.tellg();
    skipValues(values);
    const auto end = in_.tellg();
    std::string bytes(static_cast<std::size_t>(end - begin), '\0');
    in_.seekg(begin);
    in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    in_.seekg(end);
    const auto value = head_.ascii ? number(trimmed(bytes)) : binaryNumber(bytes, type);
    if (!value || !std::isfinite(*value)) return true;
    if (cycle)
      head_.cycle = static_cast<std::int64_t>(std::clamp(*value, -1e15, 1e15));
    else
      head_.time = *value;
    return true;
  }

  static std::optional<double> binaryNumber(const std::string& bytes, VoxelType type) {
    std::string native(bytes.rbegin(), bytes.rend());  // the file is big-endian
    if constexpr (std::endian::native == std::endian::big) native = bytes;
    const auto as = [&]<class T>(T value) -> std::optional<double> {
      if (native.size() != sizeof value) return {};
      std::memcpy(&value, native.data(), sizeof value);
      return static_cast<double>(value);
    };
    if (type == VoxelType::f64) return as(0.0);
    if (type == VoxelType::f32) return as(0.0f);
    if (type == VoxelType::i32) return as(std::int32_t(0));
    return {};
  }

  bool scalarsAtVoxels(const std::vector<std::string>& parts) {
    Values values{parts.size() > 1 ? parts[1] : "", parts.size() > 2 ? parts[2] : "", count_.value_or(0), 1};
    const auto components = parts.size() > 3 ? integer(parts[3]) : std::optional<std::int64_t>(1);
    if (parts.size() < 3 || !components || *components < 1 || *components > 4 || !count_)
      failField(path_, "SCALARS", "POINT_DATA before, then a name, a type and one component", line_);
    values.components = *components;
    if (!lower(filledLine()).starts_with("lookup_table")) failField(path_, "line after SCALARS", "LOOKUP_TABLE", line_);
    if (isVoxels(values)) return take(values);
    if (!listing_ && values.components == 1 && !legacyType(values.type) && (name_.empty() || name_ == values.name))
      failField(path_, "type of the scalars", "unsigned_char to double", values.type);
    pass(values);
    return false;
  }

  // "FIELD name arrays", then for each "name components tuples type" and its values.
  bool fieldAtVoxels(const std::vector<std::string>& field) {
    const auto arrays = field.size() == 3 ? integer(field[2]) : std::nullopt;
    if (!arrays || *arrays < 0) failField(path_, "FIELD", "a name and a number of arrays", line_);
    for (std::int64_t i = 0; i < *arrays; ++i) {
      std::vector<std::string> parts = words(filledLine());
      if (lower(parts[0]) == "metadata") {  // of the array before
        while (!trimmed(line()).empty()) {
        }
        parts = words(filledLine());
      }
      const auto components = parts.size() == 4 ? integer(parts[1]) : std::nullopt;
      const auto tuples = parts.size() == 4 ? integer(parts[2]) : std::nullopt;
      if (!components || !tuples || *components < 0 || *tuples < 0 || *components > kMostValues ||
          *tuples > kMostValues)
        failField(path_, "array of FIELD", "a name, components, tuples and a type", line_);
      const Values values{parts[0], parts[3], *tuples, *components};
      if (isVoxels(values)) return take(values);
      pass(values);
    }
    return false;
  }

  // Attributes of points or cells that are no scalars.
  bool attributeAtVoxels(const std::string& key, const std::vector<std::string>& parts) {
    static const std::map<std::string, std::int64_t> components{
        {"vectors", 3}, {"normals", 3}, {"tensors", 9}, {"tensors6", 6}, {"global_ids", 1}, {"pedigree_ids", 1}};
    Values values{parts.size() > 1 ? parts[1] : "", parts.size() > 2 ? parts[2] : "", count_.value_or(0), 1};
    const std::int64_t third = parts.size() > 2 ? integer(parts[2]).value_or(-1) : -1;
    if (const auto found = components.find(key); found != components.end() && count_ && parts.size() == 3) {
      values.components = found->second;
      if (key == "vectors" || key == "normals") values.meaning = VoxelMeaning::vector;
    } else if (key == "color_scalars" && count_ && third > 0 && third < 256) {
      values.components = third;
      values.type = head_.ascii ? "float" : "unsigned_char";
      values.meaning = VoxelMeaning::colour;
    } else if (key == "lookup_table" && third >= 0 && third < kMostValues) {
      values.tuples = third;
      values.components = 4;
      values.type = head_.ascii ? "float" : "unsigned_char";
    } else if (key == "texture_coordinates" && count_ && parts.size() == 4 && third > 0 && third < 4) {
      values.components = third;
      values.type = parts[3];
    } else {
      failField(path_, "head", "a keyword of structured points, then SCALARS or FIELD", line_);
    }
    if (key != "lookup_table" && isVoxels(values)) return take(values);
    pass(values);
    return false;
  }

  void skipValues(const Values& values) {
    std::int64_t count = 0;
    if (__builtin_mul_overflow(values.tuples, values.components, &count)) count = -1;
    const std::string type = lower(values.type);
    const auto known = legacyType(type);
    const bool text = type == "string" || type == "utf8_string";
    if (count < 0 || (!known && type != "bit" && !text))
      failField(path_, "array " + values.name, "values of a type from bit to double, or string", values.type);
    if (head_.ascii)
      skipWords(count, text);
    else if (text)
      skipStrings(count);
    else
      skipBytes(values.name, known ? count * voxelBytes(*known) : count / 8 + (count % 8 > 0));
  }

  void skipBytes(const std::string& name, std::int64_t bytes) {
    const auto here = static_cast<std::int64_t>(in_.tellg());
    const auto size = static_cast<std::int64_t>(fs::file_size(path_));
    if (bytes < 0 || bytes > size - here)
      failField(path_, "array " + name, std::to_string(bytes) + " bytes", std::to_string(size - here));
    in_.seekg(here + bytes);
  }

  void skipWords(std::int64_t count, bool lines) {
    for (std::int64_t i = 0; i < count && lines; ++i) line();
    for (std::int64_t i = 0; i < count && !lines; ++i) {
      char c = 0;
      while (in_.get(c) && (c == ' ' || c == '\n' || c == '\r' || c == '\t')) {
      }
      while (in_ && c != ' ' && c != '\n' && c != '\r' && c != '\t') in_.get(c);
      if (!in_) failField(path_, "array", std::to_string(count) + " numbers", std::to_string(i));
      if (i + 1 == count) in_.unget();  // a line may end here
    }
  }

  // Each has its length in front: in 6, 14, 30 or 62 bits, as the two highest ones say (vtkDataReader::ReadArray).
  void skipStrings(std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      const int first = in_.get();
      if (first < 0) failField(path_, "array", std::to_string(count) + " texts", std::to_string(i));
      const int more = std::array{7, 3, 1, 0}[static_cast<std::size_t>(first >> 6)];
      std::int64_t length = first & 63;
      for (int k = 0; k < more; ++k) length = length << 8 | (in_.get() & 255);
      skipBytes("of text", length);
    }
  }

  fs::path path_;
  std::string name_;
  std::ifstream in_;
  std::string line_, passed_;
  std::optional<std::int64_t> count_;  // of points or cells, once their data have begun
  bool fits_ = false, listing_ = false;
  std::vector<ArrayRow> rows_;
  LegacyHead head_;
  std::optional<LegacyHead> several_;  // the first array of several numbers
};

}  // namespace

std::vector<ArrayRow> listLegacyArrays(const fs::path& path) { return LegacyHeadReader(path, {}).list(); }

LegacyHead readLegacyHead(const fs::path& path, const std::string& name) { return LegacyHeadReader(path, name).read(); }

}  // namespace umbrick
