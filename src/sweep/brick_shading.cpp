// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_shading.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "umbrick/optics/phong.h"

namespace umbrick {
namespace {

// Returns the voxels of a brick as floats; none where all have one value.
std::vector<float> valuesOf(const BrickVoxels& voxels, const VoxelBrick& brick) {
  if (!brick.voxels) return {};
  std::vector<float> values(voxels.volume().layout.voxels());
  const auto copy = [&](const auto* codes) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(codes[i]);
  };
  switch (voxels.code()) {
    case VoxelCode::u8:
      copy(BrickVoxels::codes<std::uint8_t>(brick));
      break;
    case VoxelCode::u16:
      copy(BrickVoxels::codes<std::uint16_t>(brick));
      break;
    case VoxelCode::f16:
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = halfValue(BrickVoxels::codes<HalfCode>(brick)[i]);
      break;
    case VoxelCode::f32:
      copy(BrickVoxels::codes<float>(brick));
      break;
  }
  return values;
}

// Tells for each group whether rays may read in it: it shows something, or one beside it does.
std::vector<std::uint8_t> readGroups(const VoxelBrick& brick, const glm::ivec3& groups) {
  std::vector<std::uint8_t> read(brick.active.size());
  std::size_t at = 0;
  for (int z = 0; z < groups.z; ++z)
    for (int y = 0; y < groups.y; ++y)
      for (int x = 0; x < groups.x; ++x, ++at)
        for (int k = std::max(z - 1, 0); k <= std::min(z + 1, groups.z - 1) && !read[at]; ++k)
          for (int j = std::max(y - 1, 0); j <= std::min(y + 1, groups.y - 1) && !read[at]; ++j)
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, groups.x - 1) && !read[at]; ++i)
              read[at] = brick.active[static_cast<std::size_t>((k * groups.y + j) * groups.x + i)];
  return read;
}

bool isGrey(const glm::dvec3& colour) { return colour.r == colour.g && colour.g == colour.b; }

}  // namespace

int BrickShading::begin(const ResolvedScene& scene, const BrickLight* light) {
  shading_ = scene.shading;
  gradients_ = scene.gradients;
  camera_ = scene.camera;
  light_ = light;
  lights_ = shadingLights(scene);
  const bool grey = std::ranges::all_of(lights_, [](const ShadingLightRay& one) { return isGrey(one.radiance); });
  channels_ = grey && (!light || light->channels() == 1) ? 1 : 3;
  return channels_;
}

void BrickShading::update(BrickVoxels& voxels) {
  const Bricks& volume = voxels.volume();
  glm::dvec3 sum(lights_.empty() ? 1.0 : 0.0);
  for (const ShadingLightRay& light : lights_) sum += light.radiance;
  // Beyond planes that cut the medium there is more light than arrives.
  const double brightest = light_ ? 65535.0 * static_cast<double>(light_->unit()) : 1;
  const double most =
      shading_.ambient + brightest * std::max({sum.r, sum.g, sum.b}) * (shading_.diffuse + shading_.specular);
  unit_ = static_cast<float>(std::max(most, 1e-9) / 65535);
  const CameraFrame frame = cameraFrame(camera_);
  View view;
  view.gradientToWorld = glm::mat3(glm::transpose(glm::inverse(glm::dmat3(volume.indexToWorld))));
  view.indexToWorld = volume.indexToWorld;
  view.eye = camera_.eye;
  view.perspective = camera_.projection == Projection::perspective;
  view.towardsEye = -glm::vec3(frame.forward);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, voxels.bricks().size(), 1), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) shade(voxels.brick(i), voxels, view);
  });
}

void BrickShading::shade(VoxelBrick& brick, const BrickVoxels& voxels, const View& view) const {
  constexpr int kGroup = BrickVoxels::kGroup;
  const BrickLayout& layout = voxels.volume().layout;
  const glm::ivec3 edge = layout.edge(), groups = voxels.groups();
  const std::size_t count = layout.voxels();
  const std::ptrdiff_t strideY = edge.x, strideZ = strideY * edge.y;
  const std::vector<float> values = valuesOf(voxels, brick);
  const std::vector<std::uint8_t> read = readGroups(brick, groups);
  const auto before = std::exchange(
      brick.light,
      std::make_unique<std::uint16_t[]>(static_cast<std::size_t>(channels_) * count + BrickVoxels::kPadding));
  const std::size_t stored = light_ && light_->channels() == 3 ? count : 0;  // from one channel of light to the next
  const glm::dvec3 first(view.indexToWorld * glm::dvec4(glm::dvec3(brick.origin - layout.apron), 1));
  const glm::vec3 fromEye(first - view.eye), alongX(view.indexToWorld[0]), alongY(view.indexToWorld[1]),
      alongZ(view.indexToWorld[2]);
  const auto groupOf = [&](int at, int axis) {
    return std::clamp(at - layout.apron, 0, layout.interior[axis] - 1) / kGroup;
  };
  for (int z = 1; z + 1 < edge.z; ++z)
    for (int y = 1; y + 1 < edge.y; ++y)
      for (int x = 1; x + 1 < edge.x; ++x) {
        if (!read[static_cast<std::size_t>((groupOf(z, 2) * groups.y + groupOf(y, 1)) * groups.x + groupOf(x, 0))])
          continue;
        const std::ptrdiff_t at = z * strideZ + y * strideY + x;
        glm::vec3 viewer = view.towardsEye;
        if (view.perspective)
          viewer = -glm::normalize(fromEye + static_cast<float>(x) * alongX + static_cast<float>(y) * alongY +
                                   static_cast<float>(z) * alongZ);
        glm::vec3 normal = viewer;
        if (!values.empty()) {
          const glm::vec3 gradient =
              view.gradientToWorld * glm::vec3(differencesAt(values.data() + at, strideY, strideZ, gradients_));
          const float square = glm::dot(gradient, gradient);
          if (square > 0) normal = gradient * ((glm::dot(gradient, viewer) < 0 ? -1.0f : 1.0f) / std::sqrt(square));
        }
        const glm::vec3 direct = reflected(normal, viewer);
        for (int c = 0; c < channels_; ++c) {
          const auto channel = static_cast<std::size_t>(c), voxel = static_cast<std::size_t>(at);
          const float arriving = light_ ? light_->unit() * before[channel * stored + voxel] : 1;
          const float share = (static_cast<float>(shading_.ambient) + arriving * direct[c]) / unit_;
          brick.light[channel * count + voxel] = static_cast<std::uint16_t>(std::min(share + 0.5f, 65535.0f));
        }
      }
}

// Returns what comes from the lights, without the ambient share.
glm::vec3 BrickShading::reflected(const glm::vec3& normal, const glm::vec3& viewer) const {
  const auto shareOf = [&](const glm::vec3& towards) {
    const float normalLight = glm::dot(normal, towards);
    return static_cast<float>(shading_.diffuse) * phongDiffuse(normalLight) +
           static_cast<float>(shading_.specular) * phongSpecular(normalLight, glm::dot(normal, viewer),
                                                                 glm::dot(towards, viewer),
                                                                 static_cast<float>(shading_.shininess));
  };
  glm::vec3 sum(0);
  if (lights_.empty()) return glm::vec3(shareOf(viewer));
  for (const ShadingLightRay& light : lights_) sum += glm::vec3(light.radiance) * shareOf(glm::vec3(light.towards));
  return sum;
}

}  // namespace umbrick
