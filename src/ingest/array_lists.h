// The lists of arrays of each format that holds several.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "umbrick/ingest/list_arrays.h"

namespace umbrick {

std::vector<ArrayRow> listHdf5Arrays(const std::filesystem::path& path);
std::vector<ArrayRow> listVtiArrays(const std::filesystem::path& path);

}  // namespace umbrick
