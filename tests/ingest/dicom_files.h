// DICOM files that are built element by element, and a series of slices whose voxels are known.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick::dicom_files {

// Data elements in explicit VR, written by the rules of DICOM PS3.5 7.1.2.
class Elements {
 public:
  explicit Elements(bool big = false) : big_(big) {}
  Elements& text(unsigned group, unsigned element, const char* vr, std::string value) {
    if (value.size() % 2) value += std::string(vr) == "UI" ? '\0' : ' ';
    return put(group, element, vr, value);
  }
  Elements& number(unsigned group, unsigned element, std::uint16_t value) {
    return put(group, element, "US", bytesOf<std::uint16_t>({value}, big_));
  }
  Elements& put(unsigned group, unsigned element, const std::string& vr, const std::string& value) {
    std::string out = half(group) + half(element) + vr;
    if (vr == "OW" || vr == "SQ" || vr == "OB")
      out += std::string(2, '\0') + whole(value.size());
    else
      out += half(value.size());
    elements_[group << 16 | element] = out + value;
    return *this;
  }
  Elements& remove(unsigned group, unsigned element) {
    elements_.erase(group << 16 | element);
    return *this;
  }
  /// A sequence of items, each the elements of another set.
  Elements& sequence(unsigned group, unsigned element, const std::vector<Elements>& items) {
    std::string value;
    for (const Elements& item : items) value += half(0xfffe) + half(0xe000) + whole(item.bytes().size()) + item.bytes();
    return put(group, element, "SQ", value);
  }
  std::string bytes() const {
    std::string out;
    for (const auto& [tag, element] : elements_) out += element;
    return out;
  }
  /// @param syntax  UID of another transfer syntax, for which `data` are these elements in another form
  std::string file(const char* syntax = nullptr, const std::string& data = {}) const {
    Elements meta;
    meta.text(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2").text(2, 3, "UI", "1.2.3.4");
    meta.text(2, 0x10, "UI", big_ ? "1.2.840.10008.1.2.2" : "1.2.840.10008.1.2.1");
    if (syntax) meta.text(2, 0x10, "UI", syntax);
    return std::string(128, '\0') + "DICM" + meta.bytes() + (syntax ? data : bytes());
  }
  /// The same elements in implicit VR, without any of sequences.
  std::string implicit() const {
    std::string out;
    for (const auto& [tag, element] : elements_) {
      const bool wide = element.substr(4, 2) == "OW" || element.substr(4, 2) == "OB";
      const std::string value = element.substr(wide ? 12 : 8);
      out += element.substr(0, 4) + whole(value.size()) + value;
    }
    return out;
  }

 private:
  std::string half(std::size_t value) const { return bytesOf<std::uint16_t>({std::uint16_t(value)}, big_); }
  std::string whole(std::size_t value) const { return bytesOf<std::uint32_t>({std::uint32_t(value)}, big_); }
  bool big_;
  std::map<unsigned, std::string> elements_;
};

constexpr std::uint16_t kColumns = 12, kRows = 10;

inline std::int16_t stored(int x, int y, int z) { return static_cast<std::int16_t>(7 * x - 11 * y + 100 * z); }

inline std::string numbers(const std::vector<double>& values) {
  std::string out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.10g", values[i]);
    out += (i ? "\\" : "") + std::string(buffer);
  }
  return out;
}

inline std::string pixels(int z, bool big = false) {
  std::vector<std::int16_t> values;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) values.push_back(stored(x, y, z));
  return bytesOf(values, big);
}

// Rows and columns at right angles, neither along an axis.
inline const std::vector<double> kOrientation{0.8, 0.6, 0, 0, 0, -1};
inline const glm::dvec3 kNormal(-0.6, 0.8, 0);

inline Elements slice(int z, const glm::dvec3& position, bool big = false) {
  Elements out(big);
  out.text(8, 0x60, "CS", "CT")
      .text(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2")
      .text(8, 0x18, "UI", "1.2.9." + std::to_string(z));
  out.text(0x20, 0xe, "UI", "1.2.3").text(0x20, 0x11, "IS", "4").text(8, 0x103e, "LO", "thorax");
  out.text(0x20, 0x32, "DS", numbers({position.x, position.y, position.z}))
      .text(0x20, 0x37, "DS", numbers(kOrientation));
  out.text(0x28, 0x30, "DS", "0.75\\0.5").text(0x28, 4, "CS", "MONOCHROME2").number(0x28, 2, 1);
  out.number(0x28, 0x10, kRows).number(0x28, 0x11, kColumns).number(0x28, 0x100, 16).number(0x28, 0x101, 16);
  out.number(0x28, 0x102, 15).number(0x28, 0x103, 1).text(0x28, 0x1052, "DS", "-1000").text(0x28, 0x1053, "DS", "2");
  out.put(0x7fe0, 0x10, "OW", pixels(z, big));
  return out;
}

struct DicomFolder {
  TemporaryFolder folder;
  void write(const std::string& name, const Elements& elements) const {
    writeBytes(folder.path() / name, elements.file());
  }
  /// Slices `step` apart, in files whose names run against them.
  void series(int count, const glm::dvec3& step) const {
    for (int z = 0; z < count; ++z) write(name(z), slice(z, glm::dvec3(1, 2, 3) + step * double(z)));
  }
  static std::string name(int z) { return "i" + std::to_string(9 - z) + ".dcm"; }
  std::unique_ptr<VoxelSource> open() const { return openVolume(folder.path()); }
  void refused(const std::string& what) const {
    CHECK_THROWS_AS(readVolume(*open()), IoError);
    CHECK_THROWS_WITH(readVolume(*open()), Catch::Contains(what) && Catch::Contains(folder.path().string()));
  }
};

inline void checkVoxels(VoxelSource& source, int count) {
  REQUIRE(source.info().dims == glm::i64vec3(kColumns, kRows, count));
  const std::vector<float> values = readVolume(source);
  for (int z = 0, i = 0; z < count; ++z)
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x, ++i) REQUIRE(values[std::size_t(i)] == float(-1000 + 2 * stored(x, y, z)));
}

inline void checkMatrix(const glm::dmat4& found, const glm::dvec3& step) {
  const glm::dmat4 expected(0.4, 0.3, 0, 0, 0, 0, -0.75, 0, step.x, step.y, step.z, 0, 1, 2, 3, 1);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      CHECK(found[column][row] == Approx(expected[column][row]).epsilon(1e-12).margin(1e-12));
}

/// Tells whether a source has a note with this text.
inline bool noted(const VoxelSource& source, const std::string& text) {
  for (const std::string& note : source.info().notes)
    if (note.find(text) != std::string::npos) return true;
  return false;
}

}  // namespace umbrick::dicom_files
