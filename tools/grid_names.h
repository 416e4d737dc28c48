// Names of the grids that several volumes become.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace umbrick::tools {

/// One name for each input: `given` where there are any, else the stems of the file names, without the ending of a
/// packing: "head" for scans/head.nii.gz. One input alone is "density".
/// @throw UsageError  another number of names than inputs, or two that are equal
std::vector<std::string> gridNames(const std::vector<std::filesystem::path>& inputs,
                                   const std::vector<std::string>& given);

/// What an option gives to each of `inputs`: one value is for all of them.
/// @throw UsageError  neither 0, 1 nor as many as inputs; none gives empty strings
std::vector<std::string> oneForEach(const std::string& option, const std::vector<std::string>& given,
                                    std::size_t inputs);

}  // namespace umbrick::tools
