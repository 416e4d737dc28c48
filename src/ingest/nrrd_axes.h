// The axes of a NRRD file: how many voxels there are along each, and where they lie in the world.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ingest/header_fields.h"
#include "ingest/nrrd_header.h"

namespace umbrick {

/// Fills in the dims and indexToWorld of a header whose type is known, how long its unit is, and what is known of the
/// axes of components and frames. Axes that are not of space, or too many, are dropped where they hold one thing.
/// @throw IoError  axes that are not those of a volume, or directions that do not span space
void readNrrdAxes(const HeaderFields& fields, NrrdHeader& header);

}  // namespace umbrick
