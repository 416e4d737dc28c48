// SPDX-License-Identifier: Apache-2.0
#include "shade/emission_lookup.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace umbrick {

EmissionLookup::EmissionLookup(const GlFunctions& gl, const TransferFunction& emitted) : emitted_(emitted) {
  const double low = emitted.values().front(), high = emitted.values().back();
  // A function of a single step has no extent. Two steps lie outside of the function on each side.
  const double extent = std::max(high - low, 1e-3 * std::max(std::abs(low), std::abs(high)) + 1e-30);
  perUnit_ = (kSteps - 4) / extent;
  first_ = low - 2 / perUnit_;
  std::vector<glm::vec4> texels(2 * (kSteps + 1));
  glm::dvec3 sum(0);
  constexpr int kParts = 8;
  for (int step = 0; step <= kSteps; ++step) {
    const auto at = static_cast<std::size_t>(step);
    const auto valueOf = [&](double place) { return first_ + (step + place) / perUnit_; };
    texels[at] = glm::vec4(glm::vec3(emitted(valueOf(0)).sigma_s()), 0);
    texels[at + kSteps + 1] = glm::vec4(glm::vec3(sum), 0);
    for (int part = 0; part < kParts; ++part) sum += emitted(valueOf((part + 0.5) / kParts)).sigma_s() / double(kParts);
  }
  texture_ = makeTexture2d(gl, GL_RGBA32F, kSteps + 1, 2, GL_NEAREST);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TextureSubImage2D(texture_.name(), 0, 0, 0, kSteps + 1, 2, GL_RGBA, GL_FLOAT, texels.data());
}

bool EmissionLookup::isVisible(const Range& values) const {
  if (values.empty()) return false;
  const double beside = 1 / perUnit_;
  return !emitted_.isTransparent({static_cast<float>(values.min - beside), static_cast<float>(values.max + beside)});
}

void EmissionLookup::setUniforms(GlProgram& program) const {
  program.set("emission_steps",
              glm::vec3(static_cast<float>(first_), static_cast<float>(perUnit_), static_cast<float>(kSteps)));
}

}  // namespace umbrick
