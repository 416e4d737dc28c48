// Light by ordinates in double precision on the CPU, written from its equations: the renderer must agree with it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "shade/shade_fixture.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

/// Returns colour (3), opacity and visibility of each pixel, with the medium at the middle of every slab, for light of
/// one colour. Every path is kept for ever.
/// @param texel  of the lattice, world units
/// @param slices  from the eye on
inline std::vector<std::array<double, 5>> sweepOrdinates(const FieldBricks& volume, const ResolvedScene& scene,
                                                         double texel, int slices) {
  const Camera& camera = scene.camera;
  const CameraFrame axes = cameraFrame(camera);
  const double d = scene.sampling.spacing;
  struct Path {
    double x, y, stretch, weight;  // x, y: texels per depth
    std::map<std::pair<int, int>, double> light;
    double at(int u, int v) const {
      const auto found = light.find({u, v});
      return found == light.end() ? 1 : found->second;
    }
  };
  std::vector<Path> paths;
  for (const auto& [direction, radiance] : lightDirections(scene, scene.occlusion.ordinates.directions)) {
    const double towards = -glm::dot(direction, axes.forward);
    paths.push_back({glm::dot(direction, axes.right) / towards / texel,
                     glm::dot(direction, axes.up) / towards / texel,
                     1 / towards,
                     radiance.r,
                     {}});
  }
  paths.push_back({0, 0, 1, 0, {}});
  // The volume can only be in so many texels of the lattice on each side.
  const int reach = static_cast<int>(std::ceil(glm::length(glm::dvec3(volume.domain.extent())) / texel)) + 2;
  const glm::dvec3 middle = glm::dvec3(
      volume.indexToWorld * glm::dvec4(0.5 * (glm::dvec3(volume.domain.min) + glm::dvec3(volume.domain.max)), 1));
  const int cx = static_cast<int>(std::lround(glm::dot(middle - camera.eye, axes.right) / texel));
  const int cy = static_cast<int>(std::lround(glm::dot(middle - camera.eye, axes.up) / texel));
  std::vector<std::array<double, 5>> eye(static_cast<std::size_t>(camera.width * camera.height));
  for (int slice = 0; slice < slices; ++slice) {
    const double depth = (slice + 0.5) * d;
    const auto shift = [&](double perDepth) { return static_cast<int>(std::floor(depth * perDepth + 0.5 - 1e-6)); };
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        const glm::dvec3 point = ray.at(depth);
        const Medium medium = scene.transfer(volume.trilinearWorld(point));
        if (medium.sigma_t == 0) continue;
        const double px = glm::dot(point - camera.eye, axes.right) / texel - 0.5;
        const double py = glm::dot(point - camera.eye, axes.up) / texel - 0.5;
        const int i = static_cast<int>(std::floor(px)), j = static_cast<int>(std::floor(py));
        const double fx = px - i, fy = py - j;
        double share = 0, weighted = 0, weights = 0;
        // Texels count by how much of them is seen along the view axis, the last of the paths.
        for (int corner = 0; corner < 4; ++corner) {
          const int s = corner % 2, t = corner / 2;
          const double seen = std::max(paths.back().at(i + s, j + t), 1e-3) * (s ? fx : 1 - fx) * (t ? fy : 1 - fy);
          weights += seen;
          for (const Path& path : paths) {
            const double arrives = seen * path.weight * path.at(i + s + shift(path.x), j + t + shift(path.y));
            share += arrives;
            weighted += arrives / (1 + path.stretch);
          }
        }
        share /= weights;
        weighted /= weights;
        const double tau = medium.sigma_t * d * ray.stretch();
        // The mean length of the light's paths over that of the eye's is such that it is right for the
        // most solid slabs.
        const double both = tau * (1 + (share / weighted - 1) / ray.stretch());
        auto& pixel = eye[static_cast<std::size_t>(y * camera.width + x)];
        const double through = 1 - pixel[3], seen = through * tau * share * -std::expm1(-both) / both;
        for (int c = 0; c < 3; ++c) pixel[static_cast<std::size_t>(c)] += medium.albedo[c] * seen;
        pixel[3] += through * -std::expm1(-tau);
        pixel[4] += seen;
      }
    for (int j = cy - reach; j <= cy + reach; ++j)
      for (int i = cx - reach; i <= cx + reach; ++i) {
        const glm::dvec3 point =
            camera.eye + (i + 0.5) * texel * axes.right + (j + 0.5) * texel * axes.up + depth * axes.forward;
        const double sigma_t = scene.transfer(volume.trilinearWorld(point)).sigma_t;
        if (sigma_t == 0) continue;
        for (Path& path : paths)
          path.light.try_emplace({i + shift(path.x), j + shift(path.y)}, 1).first->second *=
              std::exp(-sigma_t * d * path.stretch);
      }
  }
  return eye;
}

}  // namespace umbrick
