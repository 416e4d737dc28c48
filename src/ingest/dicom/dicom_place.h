// Places of slices that their files do not state.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ingest/dicom/dicom_file.h"
#include "umbrick/ingest/dicom_volume.h"

namespace umbrick {

/// Fills in spacing and positions from the options where the files state none. Slices are alike: all state the same
/// fields.
/// @throw UnplacedSlices   they state none, and the options do not either
/// @throw InvalidArgument  the options give what the files state
void completePlaces(const std::string& name, std::vector<DicomFile>& files, const DicomOptions& options,
                    std::vector<std::string>& notes);

}  // namespace umbrick
