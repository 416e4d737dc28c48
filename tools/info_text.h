// Parts that all that umbrick info prints has in common.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace umbrick::tools {

template <class Vector>
nlohmann::json jsonVector(const Vector& v) {
  return nlohmann::json::array({v.x, v.y, v.z});
}

/// Its rows, for column vectors.
nlohmann::json jsonMatrix(const glm::dmat4& matrix);

template <class Vector>
std::string text(const Vector& v, const char* between = ", ") {
  std::ostringstream out;
  out << v.x << between << v.y << between << v.z;
  return out.str();
}

/// Prints JSON to stdout; bytes of names that are no UTF-8 become U+FFFD.
void printJson(const nlohmann::json& json);

/// Prints bars, a line for each bin from `min` to `max`.
void printHistogram(const std::vector<std::uint64_t>& histogram, double min, double max);

/// Whether printSource() looks for metadata of this name.
bool isUsualSource(std::string_view key);

/// Prints what a source said about itself: a line for each of the usual metadata that is there.
void printSource(const std::map<std::string, std::string>& metadata);

}  // namespace umbrick::tools
