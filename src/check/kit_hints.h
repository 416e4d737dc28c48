// What would explain a wrong answer: mistakes that renderers often have, tried one by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "check/kit_reader.h"

namespace umbrick {

/// Returns the mistake with which the reference comes nearest to a picture, if that leaves less than a quarter of its
/// error, as a sentence; else nothing. The picture has the size that was asked for and is finite.
std::string explainPicture(const AskedCase& asked, const AskedPicture& picture, const Image& answer);
/// The same of a picture of another size; finds none but exchanged axes.
std::string explainSize(const AskedPicture& picture, const Image& answer);

/// Returns the mistake that explains nearly all of the samples that are off by more than the limit, as a sentence; else
/// nothing. @param answer  finite, one value for each sample
std::string explainSamples(const AskedCase& asked, const std::vector<double>& answer, double limit);

}  // namespace umbrick
