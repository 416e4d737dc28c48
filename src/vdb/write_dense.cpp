// SPDX-License-Identifier: Apache-2.0
#include <openvdb/math/Maps.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>

#include "umbrick/core/error.h"
#include "umbrick/core/output.h"
#include "umbrick/core/patient_space.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/pending_pair.h"
#include "umbrick/grid/grid_world.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little, "the headers say so");

// Calls action(T()), where T is the type as which values are stored.
template <class Action>
auto withType(VoxelType type, const Action& action) {
  switch (type) {
    case VoxelType::u8:
      return action(std::uint8_t());
    case VoxelType::i8:
      return action(std::int8_t());
    case VoxelType::u16:
      return action(std::uint16_t());
    case VoxelType::i16:
      return action(std::int16_t());
    case VoxelType::u32:
      return action(std::uint32_t());
    case VoxelType::i32:
      return action(std::int32_t());
    default:
      return action(float());
  }
}

bool holdsAll(VoxelType type, const openvdb::FloatTree& tree) {
  return withType(type, [&](auto zero) {
    using Limits = std::numeric_limits<decltype(zero)>;
    if constexpr (std::is_same_v<decltype(zero), float>) return false;
    const auto holds = [](double value) {
      return value >= static_cast<double>(Limits::lowest()) && value <= static_cast<double>(Limits::max()) &&
             value == std::trunc(value) && !(value == 0 && std::signbit(value));
    };
    if (!holds(tree.background())) return false;
    for (auto value = tree.cbeginValueAll(); value; ++value)
      if (!holds(*value)) return false;
    return true;
  });
}

// The matrix of a file's header: its columns are the world vectors of a step along x, y and z, and the place of
// voxel `first`.
struct Place {
  openvdb::Vec3d axis[3], origin;
};

// @param space  that of the header, where it is not that of the grid
Place placeOf(const fs::path& path, const openvdb::FloatGrid& grid, const openvdb::Coord& first,
              const std::string& space) {
  if (!grid.transform().isLinear())
    throw InvalidArgument(path.string() + ": expected a grid with an affine transform, found " +
                          grid.transform().mapType());
  const openvdb::Mat4d map = grid.transform().baseMap()->getAffineMap()->getMat4();
  Place place;
  for (int i = 0; i < 3; ++i) place.axis[i] = {map(i, 0), map(i, 1), map(i, 2)};
  place.origin = grid.indexToWorld(first);
  const auto turn = changeOfSpace(worldOf(grid).space, space);
  if (!turn) return place;
  for (openvdb::Vec3d* vector : {&place.axis[0], &place.axis[1], &place.axis[2], &place.origin}) {
    const glm::dvec3 turned(*turn * glm::dvec4((*vector)[0], (*vector)[1], (*vector)[2], 0));
    *vector = {turned.x, turned.y, turned.z};
  }
  return place;
}

std::string text(const openvdb::Vec3d& v, const char* between) {
  std::ostringstream out;
  out.precision(17);
  out << v[0] << between << v[1] << between << v[2];
  return out.str();
}

std::string sizes(const glm::i64vec3& dims) {
  return std::to_string(dims.x) + ' ' + std::to_string(dims.y) + ' ' + std::to_string(dims.z);
}

// The unit of length, where headers have a name for it.
std::string lengthUnitOf(const openvdb::FloatGrid& grid) {
  const std::string stated = worldOf(grid).lengthUnit;
  for (const char* known : {"mm", "um", "nm", "pm", "cm", "m"})
    if (stated == known) return stated;
  return {};
}

// The space in which a header states the place: .mhd means LPS, and .nrrd has words for three spaces. Numbers of a grid
// that does not say which way its axes point stay as they are.
std::string spaceOf(const openvdb::FloatGrid& grid, bool nrrd) {
  const std::string own = worldOf(grid).space;
  if (!patientAxes(own) || (nrrd && (own == "RAS" || own == "LAS"))) return own;
  return "LPS";
}

std::string nrrdHeader(const openvdb::FloatGrid& grid, const DenseBox& box, const Place& place) {
  const char* type = withType(box.type, [](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_same_v<T, float>) return "float";
    if constexpr (sizeof(T) == 1) return std::is_signed_v<T> ? "int8" : "uint8";
    if constexpr (sizeof(T) == 2) return std::is_signed_v<T> ? "int16" : "uint16";
    return std::is_signed_v<T> ? "int32" : "uint32";
  });
  const auto vector = [](const openvdb::Vec3d& v) { return '(' + text(v, ",") + ')'; };
  const std::string& space = box.space;
  std::string out = "NRRD0004\ntype: " + std::string(type) + "\ndimension: 3\n";
  if (space == "LPS")
    out += "space: left-posterior-superior\n";
  else if (space == "RAS")
    out += "space: right-anterior-superior\n";
  else if (space == "LAS")
    out += "space: left-anterior-superior\n";
  else
    out += "space dimension: 3\n";
  out += "sizes: " + sizes(box.dims) + "\nspace directions: " + vector(place.axis[0]) + ' ' + vector(place.axis[1]) +
         ' ' + vector(place.axis[2]) + "\nspace origin: " + vector(place.origin) + '\n';
  if (const std::string unit = lengthUnitOf(grid); !unit.empty())
    out += "space units: \"" + unit + "\" \"" + unit + "\" \"" + unit + "\"\n";
  return out + "encoding: raw\nendian: little\n\n";
}

std::string metaImageHeader(const openvdb::FloatGrid& grid, const DenseBox& box, const Place& place,
                            const std::string& voxels) {
  const char* type = withType(box.type, [](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_same_v<T, float>) return "MET_FLOAT";
    if constexpr (sizeof(T) == 1) return std::is_signed_v<T> ? "MET_CHAR" : "MET_UCHAR";
    if constexpr (sizeof(T) == 2) return std::is_signed_v<T> ? "MET_SHORT" : "MET_USHORT";
    return std::is_signed_v<T> ? "MET_INT" : "MET_UINT";
  });
  openvdb::Vec3d spacing, direction[3];
  for (int i = 0; i < 3; ++i) {
    spacing[i] = place.axis[i].length();
    direction[i] = place.axis[i] / spacing[i];
  }
  // Without it lengths are taken for mm.
  const std::string unit = lengthUnitOf(grid);
  const std::string units = unit.empty() || unit == "mm" ? "" : "\nDistanceUnits = " + unit;
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
         "TransformMatrix = " +
         text(direction[0], " ") + ' ' + text(direction[1], " ") + ' ' + text(direction[2], " ") +
         "\nOffset = " + text(place.origin, " ") +
         "\nCenterOfRotation = 0 0 0\nElementSpacing = " + text(spacing, " ") + units +
         "\nDimSize = " + sizes(box.dims) + "\nElementType = " + type + "\nElementDataFile = " + voxels + '\n';
}

// Returns the name of the data file as a header holds it so that readers find the file: they take off blanks at the
// ends, and have their own meaning for a name that begins with the word LIST. @throw InvalidArgument  there is none
std::string nameInMetaImage(const fs::path& header, const std::string& name) {
  const bool spoken = name.find_first_of("\r\n") == name.npos;
  // "slice%03d.raw 1 20 1" would be a pattern of numbered files.
  const bool pattern = name.find('%') != name.npos && name.find_first_of(" \t") != name.npos;
  if (!spoken || pattern)
    throw InvalidArgument(header.string() + ": expected a name that a MetaImage can hold, found one with " +
                          (pattern ? "both a % and a blank" : "an end of line"));
  std::string word = name.substr(0, name.find_first_of(" \t"));
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  return word.empty() || word == "list" || name.front() == '"' ? "./" + name : name;
}

// Writes one layer of leaves after the other, so that a box larger than memory can be written.
void writeVoxels(std::ostream& out, const openvdb::FloatGrid& grid, const DenseBox& box) {
  constexpr std::int64_t kSlices = 8;
  const openvdb::Coord first(static_cast<int>(box.first.x), static_cast<int>(box.first.y),
                             static_cast<int>(box.first.z));
  for (std::int64_t z = 0; z < box.dims.z; z += kSlices) {
    const std::int64_t slices = std::min(kSlices, box.dims.z - z);
    const openvdb::Coord low = first.offsetBy(0, 0, static_cast<int>(z));
    const openvdb::CoordBBox part(low, low.offsetBy(static_cast<int>(box.dims.x - 1), static_cast<int>(box.dims.y - 1),
                                                    static_cast<int>(slices - 1)));
    withType(box.type, [&](auto zero) {
      openvdb::tools::Dense<decltype(zero), openvdb::tools::LayoutXYZ> dense(part);
      openvdb::tools::copyToDense(grid, dense);
      out.write(reinterpret_cast<const char*>(dense.data()),
                static_cast<std::streamsize>(sizeof zero * dense.valueCount()));
    });
  }
}

}  // namespace

fs::path voxelFileOf(const fs::path& header) {
  const Output output = outputAt(header);
  std::error_code missing;
  const auto folderOf = [](const fs::path& file) { return fs::absolute(file).parent_path(); };
  if (output.path != header && !fs::equivalent(folderOf(header), folderOf(output.path), missing))
    throw IoError(header.string() + ": cannot write: is a link to another folder, where its .raw would not be found; " +
                  "name " + output.path.string());
  return fs::path(output.path).replace_extension(".raw");
}

DenseBox writeDense(const fs::path& path, const openvdb::FloatGrid& grid, const DenseOptions& options,
                    const WrittenCheck& check) {
  const bool nrrd = options.nrrd || path.extension() == ".nrrd";
  if (!nrrd && path.extension() != ".mhd")
    throw InvalidArgument(path.string() + ": expected a name that ends in .nrrd or .mhd");
  const openvdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
  if (active.empty()) throw InvalidArgument(path.string() + ": expected a grid with active voxels, found none");
  DenseBox box;
  for (int i = 0; i < 3; ++i) {
    box.first[i] = active.min()[i];
    box.dims[i] = std::int64_t(active.max()[i]) - active.min()[i] + 1;
  }
  if (options.type && holdsAll(*options.type, grid.tree())) box.type = *options.type;
  const double bytes = static_cast<double>(box.dims.x) * static_cast<double>(box.dims.y) *
                       static_cast<double>(box.dims.z) * voxelBytes(box.type);
  if (bytes > static_cast<double>(options.maxBytes)) {
    std::ostringstream message;
    message.precision(17);
    message << path.string() << ": box of the active voxels: expected at most " << options.maxBytes << " bytes, found "
            << box.dims.x << " x " << box.dims.y << " x " << box.dims.z << ' ' << voxelTypeName(box.type) << " = "
            << bytes;
    throw InvalidArgument(message.str());
  }
  box.space = spaceOf(grid, nrrd);
  const Place place = placeOf(path, grid, active.min(), box.space);
  if (!nrrd) nameInMetaImage(path, fs::path(path).replace_extension(".raw").filename().string());
  if (nrrd) {
    PendingFile pending(path);
    pending.stream() << nrrdHeader(grid, box, place);
    writeVoxels(pending.stream(), grid, box);
    if (check) check(pending.path());
    pending.commit();
  } else {
    PendingPair pending(path, voxelFileOf(path));
    writeVoxels(pending.data().stream(), grid, box);
    pending.data().stream().flush();
    pending.writeHeader(
        [&](const std::string& name) { return metaImageHeader(grid, box, place, nameInMetaImage(path, name)); });
    if (check) check(pending.headerPath());
    pending.commit();
  }
  return box;
}

}  // namespace umbrick
