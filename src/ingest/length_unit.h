// Units of length and names of patient space, as volume files spell them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace umbrick {

/// How long the unit is that is called "mm", "um", "micron", "cm", "m", "inch", ..., in any case; nothing for a name
/// that is no known unit of length.
std::optional<double> millimetresPer(std::string_view unit);

/// The short name of a space: "LPS" for "left-posterior-superior" or "lps", and so for RAS and LAS. Other names stay as
/// they are.
std::string spaceName(std::string_view name);

}  // namespace umbrick
