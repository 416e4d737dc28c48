// Units of length and names of patient space, as volume files spell them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace umbrick {

/// Of "mm", "um", "micron", "cm", "m", "inch", ... in any case; nothing for what is no known unit of length.
std::optional<double> millimetresPer(std::string_view unit);

/// "left-posterior-superior" and "LPS" are both "LPS"; so for RAS and LAS; other names stay as they are.
std::string spaceName(std::string_view name);

}  // namespace umbrick
