// SPDX-License-Identifier: Apache-2.0
#include "ingest/length_unit.h"

#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <utility>

#include "ingest/header_text.h"
#include "ingest/place.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// OpenVDB takes a voxel of less than 3e-15 cubed world units for one without volume. A margin is for sheared voxels,
// whose volume it finds by other sums.
constexpr double kLeastVoxel = 4e-15;

constexpr std::array<std::pair<std::string_view, double>, 6> kShortNames{
    {{"m", 1e3}, {"cm", 10}, {"mm", 1}, {"um", 1e-3}, {"nm", 1e-6}, {"pm", 1e-9}}};

bool isSmall(const glm::dmat4& m) { return std::abs(glm::determinant(glm::dmat3(m))) < kLeastVoxel; }

// "um" for 1e-3; else "25.4 mm" and the like.
std::string shortName(double millimetres) {
  for (const auto& [name, length] : kShortNames)
    if (std::abs(length - millimetres) <= 1e-12 * length) return std::string(name);
  std::string text = std::to_string(millimetres);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text + " mm";
}

}  // namespace

std::optional<double> millimetresPer(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 37> kUnits{{
      {"mm", 1},         {"millimeter", 1},    {"millimeters", 1},    {"millimetre", 1},    {"millimetres", 1},
      {"cm", 10},        {"centimeter", 10},   {"centimeters", 10},   {"centimetre", 10},   {"centimetres", 10},
      {"m", 1000},       {"meter", 1000},      {"meters", 1000},      {"metre", 1000},      {"metres", 1000},
      {"um", 1e-3},      {"\u00b5m", 1e-3},    {"\u03bcm", 1e-3},     {"\xb5m", 1e-3},      {"micron", 1e-3},
      {"microns", 1e-3}, {"micrometer", 1e-3}, {"micrometers", 1e-3}, {"micrometre", 1e-3}, {"micrometres", 1e-3},
      {"nm", 1e-6},      {"nanometer", 1e-6},  {"nanometers", 1e-6},  {"nanometre", 1e-6},  {"nanometres", 1e-6},
      {"inch", 25.4},    {"inches", 25.4},     {"pm", 1e-9},          {"picometer", 1e-9},  {"dm", 100},
      {"\u00e5", 1e-7},  {"angstrom", 1e-7},
  }};
  const std::string name = lower(unit);
  if (name == "km") return 1e6;
  if (name == "\u00c5" || name == "\u212b") return 1e-7;
  return valueNamed(kUnits, name);
}

double ratioOfUnits(double from, double to) {
  const double exact = from / to, whole = std::round(exact);
  return whole >= 1 && std::abs(exact - whole) <= 1e-9 * whole ? whole : exact;
}

void useLengthUnit(VolumeInfo& info, const glm::dvec3& millimetres) {
  const glm::dmat4 own = info.indexToWorld;
  info.metadata["length_unit"] = "mm";
  scaleWorld(info.indexToWorld, millimetres);
  const bool even = millimetres.x == millimetres.y && millimetres.x == millimetres.z;
  if (even && millimetres.x != 1) info.metadata["file_length_unit"] = shortName(millimetres.x);
  if (!isSmall(info.indexToWorld) || !spansSpace(info.indexToWorld)) return;
  const auto become = [&](double unit) {
    info.indexToWorld = own;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) info.indexToWorld[column][row] *= ratioOfUnits(millimetres[row], unit);
    info.metadata["length_unit"] = shortName(unit);
    return !isSmall(info.indexToWorld);
  };
  bool fits = even && millimetres.x < 1 && become(millimetres.x);
  for (const double unit : {1e-3, 1e-6, 1e-9}) fits = fits || become(unit);
  info.notes.push_back("voxels are too small for OpenVDB in mm: the unit of length is " + info.metadata["length_unit"]);
}

void useLengthUnit(VolumeInfo& info, double millimetres) { useLengthUnit(info, glm::dvec3(millimetres)); }

void enlargeUnstated(VolumeInfo& info) {
  if (info.metadata.contains("length_unit") || !spansSpace(info.indexToWorld)) return;
  int power = 0;
  for (; isSmall(info.indexToWorld) && power < 30; power += 3) scaleWorld(info.indexToWorld, glm::dvec3(1000));
  if (power == 0) return;
  info.metadata["length_unit"] = "1e-" + std::to_string(power) + " of the file's unit";
  info.notes.push_back(
      "voxels are too small for OpenVDB, and the file states no unit of length: lengths are counted in " +
      info.metadata["length_unit"]);
}

void changeLengthUnit(VolumeInfo& info, const std::string& unit) {
  const auto stated = info.metadata.find("length_unit");
  const std::string from = stated == info.metadata.end() ? "" : stated->second;
  const auto known = valueNamed(kShortNames, unit);
  if (unit != "file" && !known)
    throw InvalidArgument(info.name + ": length unit: expected nm, um, mm, cm, m or file, found " + shortened(unit));
  const auto before = millimetresPer(from);
  if (!before) {  // nothing to convert from
    if (known)
      info.notes.push_back((from.empty() ? "the file states no unit of length" : "the unit of length is " + from) +
                           ": its numbers are taken for " + unit);
    if (known) info.metadata["length_unit"] = unit;
    return;
  }
  const auto own = info.metadata.find("file_length_unit");
  const std::string to = known ? unit : own == info.metadata.end() ? "mm" : own->second;
  const auto after = millimetresPer(to);
  if (!after || to == from) return;  // a unit of the file that has no short name, such as inches, stays mm
  scaleWorld(info.indexToWorld, glm::dvec3(ratioOfUnits(*before, *after)));
  info.metadata["length_unit"] = to;
  std::erase_if(info.notes,
                [](const std::string& note) { return note.starts_with("voxels are too small for OpenVDB"); });
}

std::string spaceName(std::string_view name) {
  const std::string text = lower(name);
  if (text == "left-posterior-superior" || text == "lps") return "LPS";
  if (text == "right-anterior-superior" || text == "ras") return "RAS";
  if (text == "left-anterior-superior" || text == "las") return "LAS";
  return std::string(name);
}

}  // namespace umbrick
