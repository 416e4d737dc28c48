// SPDX-License-Identifier: Apache-2.0
#include "shade/surface_pass.h"

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "shade/constants.h"
#include "shade/phong_uniforms.h"
#include "umbrick/core/memory.h"
#include "umbrick/draw/hybrid_picture.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/surface_light.h"

namespace umbrick {
namespace {

double lowestOf(const ResolvedScene& scene) {
  return std::ranges::min_element(scene.surfaces, {}, &SceneSurface::value)->value;
}

// Of hybrid only the first surface of a ray counts. So it is drawn as if it were opaque, and gets its opacity once all
// runs of bricks are through.
bool drawsFirst(const ResolvedScene& scene) { return scene.mode == Mode::hybrid; }

double opacityOf(const ResolvedScene& scene, const float* nearest) {
  return nearest[3] > 0 ? scene.surfaces[static_cast<std::size_t>(nearest[1])].opacity : 0;
}

void setSurfaces(GlProgram& program, const ValueScene& rays) {
  const double base = rays.codes.toCode(lowestOf(rays.scene));
  std::vector<glm::vec4> surfaces, codes;
  float highest = 0;
  for (const SceneSurface& surface : rays.scene.surfaces) {
    const glm::dvec3 colour = surface.colour.value_or(rays.scene.transfer(surface.value, 0).albedo);
    surfaces.emplace_back(colour, drawsFirst(rays.scene) ? 1 : surface.opacity);
    const auto code = static_cast<float>(rays.codes.toCode(surface.value) - base);
    codes.emplace_back(code, 0, 0, 0);
    highest = std::max(highest, code);
  }
  program.set("surfaces", surfaces);
  program.set("surface_codes", codes);
  program.set("base_code", static_cast<float>(base));
  program.set("highest", highest);
}

void setLight(GlProgram& program, const ValueScene& rays) {
  program.set("whole_light", glm::vec3(rays.light->whole()));
  const glm::mat3 toIndex(glm::inverse(glm::dmat3(rays.volume.indexToWorld)));
  program.set("world_to_index", std::vector<glm::vec3>{toIndex[0], toIndex[1], toIndex[2]});
  program.set("light_distance", static_cast<float>(kSurfaceLightDistance));
  program.set("inverse_size", glm::vec3(1.0 / glm::dvec3(rays.bricks.atlas().textureSize())));
}

}  // namespace

void SurfacePass::makeTargets(const GlFunctions& gl, const glm::ivec2& size, bool layers) {
  if (size_ == size && layers_ == layers) return;
  requireMemory("camera.size: buffers of " + std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels",
                static_cast<double>(size.x) * size.y * sizeof(float) * (layers ? 40 : 10));
  const auto target = [&](GLenum format) { return makeTexture2d(gl, format, size.x, size.y, GL_NEAREST); };
  eye_ = target(GL_RGBA32F);
  count_ = target(GL_R32F);
  if (layers) {
    depthSum_ = target(GL_RGBA32F);
    normal_ = target(GL_RGBA32F);
    nearest_ = target(GL_RGBA32F);
    framebuffer_ = makeFramebuffer(gl, {eye_.name(), count_.name(), depthSum_.name(), normal_.name(), nearest_.name()});
  } else {
    framebuffer_ = makeFramebuffer(gl, {eye_.name(), count_.name()});
  }
  size_ = size;
  layers_ = layers;
}

void SurfacePass::begin(const ValueScene& rays, bool layers) {
  const GlFunctions& gl = rays.gl;
  if (!nothing_) nothing_.emplace(gl);
  makeTargets(gl, rays.view.size, layers);
  firstDepth_.reset();
  gl.Disable(GL_SCISSOR_TEST);
  const glm::vec4 nothing(0);
  for (GLint i = 0; i < (layers_ ? 5 : 2); ++i) {
    gl.ColorMaski(static_cast<GLuint>(i), GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.ClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, i, &nothing.x);
  }
  ShaderConstants constants{{"kPerspective", rays.view.projection == Projection::perspective},
                            {"kClipPlanes", static_cast<int>(rays.planes.size())},
                            {"kTextures", std::clamp(rays.bricks.atlas().textureCount(), 1, kRayTextures)},
                            {"kSurfaces", static_cast<int>(rays.scene.surfaces.size())},
                            {"kEnds", rays.ends != nullptr},
                            {"kLit", rays.light != nullptr},
                            {"kColoured", rays.light && rays.light->coloured()},
                            {"kAux", layers_}};
  rays.codes.setConstants(constants);
  setPhongConstants(constants, rays.scene);
  GlProgram& program = program_.get(gl, constants);
  rays.codes.setUniforms(program);
  setPhongUniforms(program, rays.scene, rays.volume.indexToWorld);
  setSurfaces(program, rays);
  program.set("ambient_light", glm::vec3(rays.scene.ambient));
  if (rays.light) setLight(program, rays);
  program.set("saturation", static_cast<float>(rays.scene.sampling.saturation));
  program.set("depth", -0.6f);
}

void SurfacePass::draw(const ValueScene& rays, const RayFrame& frame, const RayRun& run, RenderStats& stats) {
  const GlFunctions& gl = rays.gl;
  slots_.fill(gl, rays.bricks, run.cells);
  if (!firstDepth_) firstDepth_ = frame.firstDepth;
  depth_ = frame.depth;
  GlProgram& program = program_.current();
  frame.setUniforms(program, rays.view, rays.planes,
                    {glm::dvec3(rays.volume.domain.min), glm::dvec3(rays.volume.domain.max)});
  frame.setCells(program, run.cells.cells, run.cells.parts);
  program.set("place_shift", static_cast<float>((frame.firstDepth - *firstDepth_) / frame.depth));
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  gl.Viewport(0, 0, size_.x, size_.y);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_STENCIL_TEST);
  for (GLuint target = 0; target < (layers_ ? 5u : 2u); ++target) {
    gl.ColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Enablei(GL_BLEND, target);
    gl.BlendFunci(target, target == 1 ? GL_ONE : GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  }
  gl.BindTextureUnit(kSlotsUnit, slots_.texture());
  bindVoxels(gl, rays.bricks.atlas(), run.cells.textures);
  if (rays.light) bindLight(gl, *rays.light, run.cells.textures);
  if (rays.ends) gl.BindTextureUnit(kEndUnit, rays.ends->name());
  program.use();
  gl.BindVertexArray(nothing_->name());
  const Stopwatch sweep;
  drawPixels(gl, pixelsOf(rays.view, run.cells.cells, frame.interior / run.cells.parts, frame.corner), run,
             rays.progress);
  gl.Finish();
  stats.sweepMs += sweep.elapsedMs();
}

void SurfacePass::show(const GlFunctions& gl, const ResolvedScene& scene, const IndexView& view, bool count,
                       Picture& picture) const {
  Image eye = readTexture(gl, eye_, size_.x, size_.y);
  if (drawsFirst(scene)) {
    const Image nearest = readTexture(gl, nearest_, size_.x, size_.y);
    for (std::size_t i = 0; i < eye.pixels.size(); ++i)
      eye.pixels[i] *= static_cast<float>(opacityOf(scene, &nearest.pixels[i / 4 * 4]));
  }
  picture.colour = Image(size_.x, size_.y);
  for (std::size_t i = 0; i < eye.pixels.size(); i += 4) {
    glm::dvec4 pixel(eye.pixels[i], eye.pixels[i + 1], eye.pixels[i + 2], eye.pixels[i + 3]);
    pixel.w = std::min(pixel.w, 1.0);  // it is at most 1 except for rounding
    storeOver(scene, pixel, &picture.colour.pixels[i]);
  }
  if (count) {
    double cells = 0;
    const Image counts = readTexture(gl, count_, size_.x, size_.y);
    for (std::size_t i = 0; i < counts.pixels.size(); i += 4) cells += static_cast<double>(counts.pixels[i]);
    picture.stats.fragments = static_cast<std::uint64_t>(cells);
  }
  if (layers_) showLayers(gl, scene, view, picture);
}

void SurfacePass::showLayers(const GlFunctions& gl, const ResolvedScene& scene, const IndexView& view,
                             Picture& picture) const {
  const int width = size_.x, height = size_.y;
  const Image sums = readTexture(gl, depthSum_, width, height), normals = readTexture(gl, normal_, width, height),
              nearest = readTexture(gl, nearest_, width, height);
  const CameraFrame camera = cameraFrame(scene.camera);
  const double first = firstDepth_.value_or(0);
  SurfaceLayers layers(width, height);
  for (Image* image : {&picture.opacity, &picture.visibility, &picture.depth}) *image = Image(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float *const sum = sums.at(x, y), *const normal = normals.at(x, y), *const hit = nearest.at(x, y);
      *picture.opacity.at(x, y) =
          drawsFirst(scene) ? static_cast<float>(opacityOf(scene, hit)) : std::min(sum[3], 1.0f);
      *picture.depth.at(x, y) = sum[3] > 0 ? static_cast<float>(first + depth_ * static_cast<double>(sum[0] / sum[3]))
                                           : std::numeric_limits<float>::infinity();
      // The first surface of hybrid was drawn as if it were opaque.
      *picture.visibility.at(x, y) = sum[3] > 0 ? *picture.opacity.at(x, y) * std::min(sum[1] / sum[3], 1.0f) : 0.0f;
      if (!(hit[3] > 0)) continue;
      const glm::dvec2 screen =
          view.centre + view.halfExtent * (2.0 * (glm::dvec2(x, y) + 0.5) / glm::dvec2(view.size) - 1.0);
      const WorldRay ray = worldRay(scene.camera, camera, screen);
      layers.keep(x, y, scene.surfaces[static_cast<std::size_t>(hit[1])].value,
                  ray.from + (first + depth_ * static_cast<double>(hit[0])) * ray.along,
                  {normal[0], normal[1], normal[2]});
    }
  layers.moveTo(picture);
}

Image SurfacePass::start(const GlFunctions& gl, const ResolvedScene& scene) const {
  const Image nearest = readTexture(gl, nearest_, size_.x, size_.y);
  Image start(size_.x, size_.y, 1);
  const double first = firstDepth_.value_or(0);
  for (std::size_t i = 0; i < start.pixels.size(); ++i) {
    const float* const hit = &nearest.pixels[4 * i];
    const double depth =
        hit[3] > 0 ? first + depth_ * static_cast<double>(hit[0]) : std::numeric_limits<double>::infinity();
    start.pixels[i] = static_cast<float>(startBehind(scene, depth, opacityOf(scene, hit)));
  }
  return start;
}

std::uint64_t SurfacePass::bytes() const {
  return slots_.bytes() +
         (layers_ ? 68u : 20u) * static_cast<std::uint64_t>(size_.x) * static_cast<std::uint64_t>(size_.y);
}

}  // namespace umbrick
