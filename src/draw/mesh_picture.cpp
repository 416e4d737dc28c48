// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/mesh_picture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "umbrick/draw/phong_shader.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/mesh/mesh.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

void checkMesh(const ResolvedScene& scene) {
  if (scene.mesh.shape && isMeshShaded(scene)) shadingLights(scene);
}

MeshPicture drawMesh(const ResolvedScene& scene, const RenderSample& sample) {
  const Camera& camera = scene.camera;
  const CameraFrame frame = cameraFrame(camera);
  const glm::dvec2 halfExtent = screenPlane(camera).halfExtent, size(camera.width, camera.height);
  std::optional<PhongShader> phong;
  if (isMeshShaded(scene)) phong.emplace(scene);
  MeshPicture picture{Image(camera.width, camera.height, 3), Image(camera.width, camera.height, 1)};
  tbb::parallel_for(tbb::blocked_range<int>(0, camera.height, 4), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < camera.width; ++x) {
        const glm::dvec2 screen = halfExtent * (2.0 * (glm::dvec2(x, y) + sample.pixel) / size - 1.0);
        const WorldRay ray = worldRay(camera, frame, screen);
        const auto hit = scene.mesh.shape->first(ray.from, ray.along, camera.nearDistance);
        *picture.depth.at(x, y) = hit ? static_cast<float>(hit->t) : std::numeric_limits<float>::infinity();
        if (!hit) continue;
        const glm::dvec3 normal = glm::dot(hit->normal, ray.viewer) < 0 ? -hit->normal : hit->normal;
        const glm::dvec3 colour =
            phong ? (*phong)(scene.mesh.colour, normal, ray.viewer, glm::dvec3(1)) : scene.mesh.colour;
        for (int c = 0; c < 3; ++c) picture.colour.at(x, y)[c] = static_cast<float>(scene.ambient[c] * colour[c]);
      }
  });
  return picture;
}

ResolvedScene beforeMesh(const ResolvedScene& scene) {
  ResolvedScene before = scene;
  before.background.reset();
  return before;
}

void layOverMesh(const ResolvedScene& scene, const MeshPicture& mesh, Picture& picture) {
  for (std::size_t i = 0; i < mesh.depth.pixels.size(); ++i) {
    float* const pixel = &picture.colour.pixels[4 * i];
    glm::dvec4 sum(pixel[0], pixel[1], pixel[2], pixel[3]);
    const double through = std::max(1 - sum.w, 0.0);
    const float depth = mesh.depth.pixels[i];
    if (depth < std::numeric_limits<float>::infinity()) {
      for (int c = 0; c < 3; ++c)
        sum[c] += through * static_cast<double>(mesh.colour.pixels[3 * i + static_cast<std::size_t>(c)]);
      sum.w = 1;
      if (!picture.opacity.pixels.empty()) {
        float &opacity = picture.opacity.pixels[i], &mean = picture.depth.pixels[i];
        // Depths of nothing are infinite.
        const double before = opacity > 0 ? static_cast<double>(opacity) * mean : 0, rest = 1.0 - opacity;
        mean = static_cast<float>(before + rest * depth);
        picture.visibility.pixels[i] += static_cast<float>(rest);
        opacity = 1;
      }
    }
    storeOver(scene, sum, pixel);
  }
}

}  // namespace umbrick
