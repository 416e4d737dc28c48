// SPDX-License-Identifier: Apache-2.0
#include "shade/render_targets.h"

#include <glm/vec4.hpp>
#include <string>

#include "umbrick/core/memory.h"

namespace umbrick {

RenderTargets::RenderTargets(const GlFunctions& gl, const TargetOptions& o) : options(o) {
  // Memory that is read back takes up to 15 numbers a pixel, until it is written.
  requireMemory("camera.size: buffers of " + std::to_string(o.width) + " x " + std::to_string(o.height) + " pixels",
                static_cast<double>(bytes()) + 15.0 * sizeof(float) * o.width * o.height);
  const auto target = [&](GLenum format, GLenum filter) {
    return makeTexture2d(gl, format, o.width, o.height, filter);
  };
  // Light, opacity and occlusion are all in [0, 1]. With 16 bits, fixed point has steps of 1.5e-5 everywhere, while
  // half-floats have steps of 4.9e-4 where sums end and occlusion begins. A thousand slices with a total opacity of 0.9
  // lose 0.11 in half-floats that are truncated, as Mesa's software drivers do, and 6e-4 in fixed point.
  eye = target(o.eyeBits == 16 ? GL_RGBA16 : GL_RGBA32F, GL_NEAREST);
  if (o.aux) aux = target(GL_RGBA32F, GL_NEAREST);
  depthStencil = target(GL_DEPTH24_STENCIL8, GL_NEAREST);
  eyeOnly = o.aux ? makeFramebuffer(gl, {eye.name(), aux.name()}, depthStencil.name())
                  : makeFramebuffer(gl, {eye.name()}, depthStencil.name());
  depthOnly = makeFramebuffer(gl, {}, depthStencil.name());
  if (o.occlusionBits == 0) return;
  for (std::size_t i = 0; i < 2; ++i) {
    occlusion[i] = target(o.occlusionBits == 16 ? GL_R16 : GL_R32F, GL_LINEAR);
    lightOnly[i] = makeFramebuffer(gl, {occlusion[i].name()}, depthStencil.name());
    eyeAndLight[i] = o.aux ? makeFramebuffer(gl, {eye.name(), occlusion[i].name(), aux.name()}, depthStencil.name())
                           : makeFramebuffer(gl, {eye.name(), occlusion[i].name()}, depthStencil.name());
  }
}

std::size_t RenderTargets::bytes() const {
  const std::size_t perPixel = static_cast<std::size_t>(options.eyeBits) / 2 + (options.aux ? 16 : 0) + 4 +
                               static_cast<std::size_t>(options.occlusionBits) / 4;
  return perPixel * static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
}

void RenderTargets::clear(const GlFunctions& gl) const {
  // Clearing obeys masks and the scissor.
  gl.Disable(GL_SCISSOR_TEST);
  gl.DepthMask(GL_TRUE);
  gl.StencilMask(0xff);
  for (GLuint i = 0; i < 3; ++i) gl.ColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  const glm::vec4 nothing(0), unoccluded(1);
  gl.ClearNamedFramebufferfv(eyeOnly.name(), GL_COLOR, 0, &nothing.x);
  if (options.aux) gl.ClearNamedFramebufferfv(eyeOnly.name(), GL_COLOR, 1, &nothing.x);
  gl.ClearNamedFramebufferfi(eyeOnly.name(), GL_DEPTH_STENCIL, 0, 1.0f, 0);
  for (const GlFramebuffer& framebuffer : lightOnly)
    if (framebuffer) gl.ClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, &unoccluded.x);
}

Image readTexture(const GlFunctions& gl, const GlTexture& texture, int width, int height) {
  Image image(width, height);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.GetTextureImage(texture.name(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(image.pixels.size() * sizeof(float)),
                     image.pixels.data());
  return image;
}

}  // namespace umbrick
