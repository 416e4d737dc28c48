// Checks the ranges of fields: the first complaint counts, and all messages have the same form.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "core/json_writer.h"
#include "scene/scene_check.h"

namespace umbrick {

inline std::string print(double number) { return std::isfinite(number) ? jsonNumber(number) : std::to_string(number); }
inline std::string print(const glm::dvec3& v) { return "[" + print(v.x) + ", " + print(v.y) + ", " + print(v.z) + "]"; }
inline std::string printDegrees(double radians) { return print(radians * 180 / 3.14159265358979323846) + " degrees"; }

inline bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Collects the first complaint, so that the checks read as a table of fields and ranges.
class Checker {
 public:
  void require(bool holds, const std::string& field, const std::string& is, const std::string& range) {
    if (!holds && !complaint_) complaint_ = {field, "is " + is + ", must be " + range};
  }
  void requireRadiance(const glm::dvec3& v, const std::string& field) {
    require(isFinite(v) && v.r >= 0 && v.g >= 0 && v.b >= 0, field, print(v), "three finite numbers of 0 or more");
  }
  void requireDirection(const glm::dvec3& v, const std::string& field) {
    require(isFinite(v) && v != glm::dvec3(0), field, print(v), "three finite numbers that are not all 0");
  }
  void complain(const std::string& field, const std::string& message) {
    if (!complaint_) complaint_ = {field, message};
  }
  void add(const std::optional<Complaint>& complaint) {
    if (!complaint_) complaint_ = complaint;
  }
  const std::optional<Complaint>& complaint() const { return complaint_; }

 private:
  std::optional<Complaint> complaint_;
};

}  // namespace umbrick
