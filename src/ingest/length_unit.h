// Units of length and names of patient space, as volume files spell them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// How long the unit is that is called "mm", "um", "micron", "cm", "m", "inch", ..., in any case; nothing for a name
/// that is no known unit of length.
std::optional<double> millimetresPer(std::string_view unit);

/// How many of the second unit the first one is, both in millimetres: exact where that is a whole number, as it is for
/// all units but inches.
double ratioOfUnits(double from, double to);

/// Takes the place for one in the file's own unit, makes it mm and states so. Voxels that OpenVDB cannot hold in mm are
/// in the file's unit if that is smaller, or in um, nm or pm.
/// @param millimetres  of the unit along each axis of the world
void useLengthUnit(VolumeInfo& info, const glm::dvec3& millimetres);
void useLengthUnit(VolumeInfo& info, double millimetres);

/// Of files that state no unit: voxels that OpenVDB cannot hold are counted in a thousandth of the unit, a millionth,
/// ..., which a note says.
void enlargeUnstated(VolumeInfo& info);

/// Changes the unit of the world to the one that is asked for, as OpenOptions::lengthUnit says.
/// @throw InvalidArgument  no such unit
void changeLengthUnit(VolumeInfo& info, const std::string& unit);

/// The short name of a space: "LPS" for "left-posterior-superior" or "lps", and so for RAS and LAS. Other names stay as
/// they are.
std::string spaceName(std::string_view name);

}  // namespace umbrick
