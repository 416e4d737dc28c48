// Opens files for libhdf5. Only the .cpp files of HDF5 see it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ingest/hdf5_handle.h"

namespace umbrick {

/// Opens a file to be read, through a driver of our own.
///
/// The drivers of libhdf5 have it collect what it reads of headers in one buffer. Up to version 1.10.8 at least,
/// addresses that a damaged file makes up lead it out of that buffer, which ends the program. This driver asks for no
/// such buffer: each piece of a header is read by itself, and libhdf5 compares its address with the end of the file
/// before.
///
/// @return not good() where it is no HDF5 file; libhdf5 then knows why
Hdf5Handle openHdf5File(const std::filesystem::path& path);

}  // namespace umbrick
