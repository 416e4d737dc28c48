// Which way the axes of a world point in a patient: "LPS", "RAS" and the like.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

namespace umbrick {

/// Directions of the patient's body, as unit vectors of the world.
struct PatientAxes {
  glm::dvec3 left{0}, posterior{0}, superior{0};
};

/// Tells what the three letters of a space say. Each says where an axis of the world points: L or R, A or P, S or I.
/// DICOM and MetaImage are LPS, NIfTI is RAS. Nothing for a text that is no such three letters.
std::optional<PatientAxes> patientAxes(std::string_view space);

/// Returns the matrix that takes points of one space to another. It has whole numbers only, so that nothing is rounded.
/// Nothing where either text is no space of a patient.
std::optional<glm::dmat4> changeOfSpace(std::string_view from, std::string_view to);

}  // namespace umbrick
