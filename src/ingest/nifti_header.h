// The fixed header of NIfTI-1, NIfTI-2 and Analyze 7.5 files. Own code, although niftilib can read a part of a volume
// (nifti_read_subregion_image): it opens the file for each part anew, so a .nii.gz would be unpacked from its beginning
// for each slab.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>

namespace umbrick {

/// The fields are called as in the standards. They are in this machine's byte order and not checked.
/// Sources: https://nifti.nimh.nih.gov/pub/dist/src/niftilib/nifti1.h, .../pub/dist/doc/nifti2.h
struct NiftiHeader {
  enum class Kind { analyze, single, pair };  // voxels in an .img beside, in the file itself, in an .img beside
  Kind kind = Kind::analyze;
  std::endian endian = std::endian::little;
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  int datatype = 0;
  int intent = 0;  // intent_code: 1006 and 1007 vectors, 2003 and 2004 colours, 1002 labels
  std::int64_t voxOffset = 0;
  double slope = 0, inter = 0;
  int spaceUnit = 0;      // code of xyzt_units: 1 metres, 2 millimetres, 3 microns
  int timeUnit = 0;       // the same: 8 seconds, 16 milliseconds, 24 microseconds; others are no times
  double timeOffset = 0;  // toffset, of the first volume
  int qformCode = 0, sformCode = 0;
  std::array<double, 3> quatern{}, qoffset{};
  std::array<double, 12> srow{};  // three rows of four
  std::string description;
};

/// Reads the header, also of a packed file. @throw IoError  the file is too short or of none of the three kinds
NiftiHeader readNiftiHeader(const std::filesystem::path& path);

}  // namespace umbrick
