// Directional occlusion shading in double precision on the CPU, written from the paper: the renderer must agree with
// it. Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, Algorithms 2 and 3, Eqs. 11-15
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "shade/footprint.h"
#include "shade/shade_fixture.h"

namespace umbrick {

/// A plane holds one number for each pixel.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;
  Plane(int w, int h, double value) : width(w), height(h), values(static_cast<std::size_t>(w * h), value) {}
  double& at(int x, int y) { return values[static_cast<std::size_t>(y * width + x)]; }
  double at(int x, int y) const { return values[static_cast<std::size_t>(y * width + x)]; }
  /// Interpolates linearly between pixel centres (at halves); the plane is constant beyond the outer ones.
  double bilinear(double x, double y) const {
    const double left = std::floor(x - 0.5), bottom = std::floor(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - bottom;
    const auto pixel = [&](double i, double j) {
      return at(static_cast<int>(std::clamp(i, 0.0, width - 1.0)), static_cast<int>(std::clamp(j, 0.0, height - 1.0)));
    };
    return (1 - fy) * ((1 - fx) * pixel(left, bottom) + fx * pixel(left + 1, bottom)) +
           fy * ((1 - fx) * pixel(left, bottom + 1) + fx * pixel(left + 1, bottom + 1));
  }
};

/// Returns colour (3), opacity and visibility of each pixel, with the medium at the middle of every slab.
/// @param slices  from the eye on
inline std::vector<std::array<double, 5>> sweepOcclusion(const FieldBricks& volume, const ResolvedScene& scene,
                                                         int slices) {
  const Camera& camera = scene.camera;
  const OcclusionOptions& options = scene.occlusion;
  const int width = camera.width, height = camera.height;
  const double d = scene.sampling.spacing, extent = d * std::tan(options.aperture);
  const double pixelSize = screenPlane(camera).pixelSize.y;
  const std::vector<glm::dvec2> disk = diskGrid(options.dos.footprint);
  std::vector<std::array<double, 5>> eye(static_cast<std::size_t>(width * height));
  Plane before(width, height, 1);
  for (int slice = 0; slice < slices; ++slice) {
    const double depth = (slice + 0.5) * d;
    // On the slice before, `scale` tells where a point straight before this one appears, `perPixel` how large
    // a length appears.
    double scale = 1, perPixel = pixelSize;
    if (camera.projection == Projection::perspective && !options.dos.perspectiveCorrection) {
      perPixel = pixelSize * glm::length(camera.lookAt - camera.eye);
    } else if (camera.projection == Projection::perspective) {
      scale = slice > 0 ? depth / (depth - d) : 1;
      perPixel = pixelSize * std::max(depth - d, 0.5 * d);
    }
    Plane after(width, height, 0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        const Medium medium = scene.transfer(volume.trilinearWorld(ray.at(depth)));
        const double px = 0.5 * width + (x + 0.5 - 0.5 * width) * scale;
        const double py = 0.5 * height + (y + 0.5 - 0.5 * height) * scale;
        double sum = 0;
        for (const glm::dvec2& point : disk) {
          const double length = options.dos.algorithm == 3 ? d : std::hypot(d, extent * glm::length(point));
          sum += before.bilinear(px + extent * point.x / perPixel, py + extent * point.y / perPixel) *
                 std::exp(-medium.sigma_t * length);
        }
        after.at(x, y) = sum / static_cast<double>(disk.size());
        const double seen = before.bilinear(px, py);
        auto& pixel = eye[static_cast<std::size_t>(y * width + x)];
        const double alpha = (1 - pixel[3]) * -std::expm1(-medium.sigma_t * d * ray.stretch());
        for (int c = 0; c < 3; ++c) pixel[static_cast<std::size_t>(c)] += alpha * medium.albedo[c] * seen;
        pixel[3] += alpha;
        pixel[4] += alpha * seen;
      }
    before = after;
  }
  return eye;
}

}  // namespace umbrick
