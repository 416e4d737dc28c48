// The table of scene fields, as a page reads it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

namespace umbrick::view {

/// Returns a list of {"path", "group", "help", "kind", "choices", "low", "high", "unit", "multipleOf", "onlyOf",
/// "default"}. A kind is number, integer, flag, choice, vector (of two or three numbers), colour (that may be null) or
/// size. Numbers with choices have no others; onlyOf lists the methods that look at the field, none: all.
nlohmann::ordered_json fieldList();

}  // namespace umbrick::view
