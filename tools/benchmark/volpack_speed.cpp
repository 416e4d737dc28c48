// What a frame of the CPU's techniques costs beside one of VolPack 1.0b3, the shear-warp of Lacroute and Levoy 1994:
// time and error on the same voxels, unlit, seen in parallel.
//
//     ninja umbrick_volpack_speed && umbrick_volpack_speed SCENE.json [ROUNDS=9]
//
// VolPack classifies voxels beforehand, which is not timed: a frame is what it takes for another camera. Its voxels
// are what the function's values are in 4096 steps, its opacities what a ray of the view meets between two slices, and
// its colours 8-bit. Ways take turns, so that other load on the machine meets all of them; times are medians, of the
// processor and on the clock. Errors are the RMSE of linear premultiplied RGB against the reference, of values that are
// interpolated and of media that are, which is VolPack's model. Built where Debian's libvolpack1-dev is.
// SPDX-License-Identifier: Apache-2.0
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include <volpack.h>
}

#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/image/image.h"
#include "umbrick/reference/reference.h"
#include "umbrick/render/volume.h"
#include "umbrick/scene/scene.h"
#include "umbrick/slice/proxy_slices.h"
#include "umbrick/sweep/ray_renderer.h"
#include "umbrick/sweep/shear_warp_renderer.h"

using namespace umbrick;

namespace {

constexpr int kSteps = 4096;
constexpr int kChannels = 4;

// Voxels of a box, as steps of the function's values.
struct StepVolume {
  glm::ivec3 origin{0}, size{0};
  std::vector<std::uint16_t> steps;
  Range domain;
  double valueOf(int step) const { return domain.min + (step + 0.5) / kSteps * (double(domain.max) - domain.min); }
};

StepVolume stepsOf(const Bricks& bricks, const Range& domain) {
  StepVolume out;
  out.domain = domain;
  out.origin = bricks.domain.min;
  out.size = bricks.domain.max - bricks.domain.min + 1;
  const auto stepOf = [&](float value) {
    const double share = (double(value) - domain.min) / (double(domain.max) - domain.min);
    return static_cast<std::uint16_t>(std::clamp(share * kSteps, 0.0, kSteps - 1.0));
  };
  const auto at = [&](const glm::ivec3& p) {
    return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(out.size.y) + static_cast<std::size_t>(p.y)) *
               static_cast<std::size_t>(out.size.x) +
           static_cast<std::size_t>(p.x);
  };
  out.steps.assign(static_cast<std::size_t>(out.size.x) * static_cast<std::size_t>(out.size.y) *
                       static_cast<std::size_t>(out.size.z),
                   stepOf(bricks.background));
  std::vector<float> values(bricks.layout.voxels());
  const glm::ivec3 edge = bricks.layout.edge();
  for (const Brick& brick : bricks.bricks) {
    bricks.read(brick.origin, values);
    for (int z = 0; z < edge.z; ++z)
      for (int y = 0; y < edge.y; ++y)
        for (int x = 0; x < edge.x; ++x) {
          const glm::ivec3 p = brick.origin + glm::ivec3(x, y, z) - bricks.layout.apron - out.origin;
          if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= out.size.x || p.y >= out.size.y || p.z >= out.size.z) continue;
          out.steps[at(p)] = stepOf(values[static_cast<std::size_t>((z * edge.y + y) * edge.x + x)]);
        }
  }
  return out;
}

// How long the way of a ray is between two slices, and what VolPack takes it for: slopes in voxels.
struct SliceWay {
  double world = 1, volpack = 1;
};

SliceWay wayOf(const IndexView& view, const glm::dmat4& indexToWorld) {
  const glm::dvec3 forward = view.toIndex[2];
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(forward[i]) > std::abs(forward[axis])) axis = i;
  const glm::dvec3 perSlice = forward / std::abs(forward[axis]);
  return {glm::length(glm::dmat3(indexToWorld) * perSlice), glm::length(perSlice)};
}

class VolPack {
 public:
  VolPack(const StepVolume& volume, const TransferFunction& transfer, const IndexView& view, const SliceWay& way)
      : context_(vpCreateContext(), vpDestroyContext), size_(view.size) {
    struct Voxel {
      std::uint16_t step;
    };
    static_assert(sizeof(Voxel) == 2);
    const glm::ivec3 n = volume.size;
    require(vpSetVolumeSize(context(), n.x, n.y, n.z));
    require(vpSetVoxelSize(context(), sizeof(Voxel), 1, 1, 1));
    require(vpSetVoxelField(context(), 0, sizeof(std::uint16_t), 0, kSteps - 1));
    voxels_ = volume.steps;
    require(vpSetRawVoxels(context(), voxels_.data(), static_cast<int>(voxels_.size() * sizeof(Voxel)), sizeof(Voxel),
                           n.x * static_cast<int>(sizeof(Voxel)), n.x * n.y * static_cast<int>(sizeof(Voxel))));
    colours_.resize(3 * kSteps);
    opacities_.resize(kSteps);
    for (int step = 0; step < kSteps; ++step) {
      const Medium medium = transfer(volume.valueOf(step));
      const auto at = static_cast<std::size_t>(step);
      opacities_[at] = static_cast<float>(-std::expm1(-medium.sigma_t * way.world / way.volpack));
      for (std::size_t c = 0; c < 3; ++c)
        colours_[3 * at + c] = static_cast<float>(255 * medium.albedo[static_cast<int>(c)]);
    }
    require(vpSetClassifierTable(context(), 0, 0, opacities_.data(), kSteps * static_cast<int>(sizeof(float))));
    require(vpSetLookupShader(context(), 3, 1, 0, colours_.data(), 3 * kSteps * static_cast<int>(sizeof(float)), 0,
                              nullptr, 0));
    require(vpSetd(context(), VP_MIN_VOXEL_OPACITY, 1.0 / 512));
    require(vpSetd(context(), VP_MAX_RAY_OPACITY, 0.999));
    Stopwatch watch;
    require(vpClassifyVolume(context()));
    classifyMs_ = watch.elapsedMs();
    look(n, view, volume.origin);
  }

  double classifyMs() const { return classifyMs_; }

  Image frame() {
    require(vpRenderClassifiedVolume(context()));
    Image picture(size_.x, size_.y, kChannels);
    for (std::size_t i = 0; i < pixels_.size(); ++i) picture.pixels[i] = static_cast<float>(pixels_[i]) / 255;
    return picture;
  }

 private:
  vpContext* context() const { return context_.get(); }
  void require(vpResult result) const {
    if (result != VP_OK) throw InvalidArgument(std::string("VolPack: ") + vpGetErrorString(vpGetError(context())));
  }

  // VolPack puts voxel i at (i - size / 2) / longest edge.
  void look(const glm::ivec3& n, const IndexView& view, const glm::ivec3& origin) {
    const double longest = std::max({n.x, n.y, n.z});
    vpMatrix4 matrix;
    vpIdentity4(matrix);
    const glm::dvec3 middle = view.toView(glm::dvec3(origin) + 0.5 * glm::dvec3(n));
    for (int row = 0; row < 3; ++row) {
      const double sign = row == 2 ? -1 : 1;  // eyes look along -z
      for (int column = 0; column < 3; ++column)
        matrix[row][column] = sign * longest * view.axis[static_cast<std::size_t>(column)][row];
      matrix[row][3] = sign * middle[row];
    }
    require(vpCurrentMatrix(context(), VP_VIEW));
    require(vpIdentityMatrix(context()));
    require(vpSetMatrix(context(), matrix));
    require(vpCurrentMatrix(context(), VP_PROJECT));
    require(vpIdentityMatrix(context()));
    const glm::dvec2 h = view.halfExtent;
    const glm::dvec2 shift = 0.5 * kPixelShift * 2.0 * h / glm::dvec2(view.size);
    constexpr double kFar = 1e5;
    require(
        vpWindow(context(), VP_PARALLEL, -h.x + shift.x, h.x + shift.x, -h.y + shift.y, h.y + shift.y, -kFar, kFar));
    pixels_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * kChannels);
    require(vpSetImage(context(), pixels_.data(), size_.x, size_.y, size_.x * kChannels, VP_RGBA));
  }

  // Pixels are at whole numbers, where ours have their centres at halves.
  static constexpr double kPixelShift = 1;
  std::unique_ptr<vpContext, void (*)(vpContext*)> context_;
  glm::ivec2 size_;
  std::vector<std::uint16_t> voxels_;
  std::vector<float> opacities_, colours_;
  std::vector<unsigned char> pixels_;
  double classifyMs_ = 0;
};

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (i % 4 != 3) sum += std::pow(double(a.pixels[i]) - b.pixels[i], 2);
  return std::sqrt(sum / (0.75 * static_cast<double>(a.pixels.size())));
}

struct Way {
  std::string name;
  int threads;  // 0: all
  std::function<Image()> frame;
  Image picture = {};
  std::vector<double> ms = {}, cpuMs = {};
};

double processorMs() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  return numbers[numbers.size() / 2];
}

void measure(const char* file, int rounds) {
  Scene scene = readScene(file);
  scene.model = Model::emission;
  scene.background.reset();
  const Volume volume(scene.volume);
  ResolvedScene resolved = volume.resolve(scene);
  Camera& camera = resolved.camera;
  if (camera.projection == Projection::perspective)  // as large as it is where the camera looks at
    camera.viewHeight = 2 * glm::distance(camera.eye, camera.lookAt) * std::tan(camera.fov / 2);
  camera.projection = Projection::orthographic;
  const IndexView view = indexView(resolved.camera, volume.indexToWorld());
  const auto bricks = volume.cutForCpu(resolved);
  std::cerr << "reference ...\n";
  const Image truth = renderReference(volume.grid(), resolved).colour;
  ResolvedScene media = resolved;
  media.sampling.classification = Classification::pre;
  const Image mediaTruth = renderReference(volume.grid(), media).colour;
  const StepVolume steps = stepsOf(*bricks, resolved.transfer.valueDomain());
  VolPack volpack(steps, resolved.transfer, view, wayOf(view, volume.indexToWorld()));
  std::vector<Way> ways{{"VolPack", 1, [&] { return volpack.frame(); }}};
  std::vector<std::unique_ptr<Renderer>> renderers;
  const auto add = [&](const std::string& name, std::unique_ptr<Renderer> renderer) {
    Renderer* const one = renderer.get();
    renderers.push_back(std::move(renderer));
    for (const int threads : {1, 0}) ways.push_back({name, threads, [one] { return one->render().colour; }});
  };
  for (const double rays : {0.5, 1.0, 2.0})
    add("shear-warp, " + std::to_string(rays).substr(0, 3) + " rays a voxel",
        std::make_unique<ShearWarpRenderer>(*bricks, resolved, RenderOptions{}, ShearWarpSampling{1, rays, 0}));
  for (const int each : {1, 2})
    add("rays, " + std::to_string(each) + " a voxel",
        std::make_unique<RayRenderer>(*bricks, resolved, RenderOptions{}, each));
  for (int round = 0; round < rounds; ++round)
    for (Way& way : ways) {
      std::unique_ptr<tbb::global_control> limit;
      if (way.threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      static_cast<std::size_t>(way.threads));
      const Stopwatch watch;
      const double before = processorMs();
      way.picture = way.frame();
      way.cpuMs.push_back(processorMs() - before);
      way.ms.push_back(watch.elapsedMs());
    }
  std::printf("%d x %d pixels, voxels %d x %d x %d; VolPack classifies in %.0f ms\n", view.size.x, view.size.y,
              steps.size.x, steps.size.y, steps.size.z, volpack.classifyMs());
  std::printf("%-40s %10s %10s %10s %10s %10s\n", "", "CPU ms", "to VolPack", "clock ms", "error", "to media");
  const double first = median(ways.front().cpuMs);
  for (const Way& way : ways)
    std::printf("%-28s %-11s %10.1f %10.2f %10.1f %10.4f %10.4f\n", way.name.c_str(),
                way.threads == 1 ? "1 thread" : "all threads", median(way.cpuMs), median(way.cpuMs) / first,
                median(way.ms), rmse(way.picture, truth), rmse(way.picture, mediaTruth));
}

}  // namespace

int main(int count, char** words) {
  try {
    if (count < 2) throw InvalidArgument("give a scene");
    measure(words[1], count > 2 ? std::atoi(words[2]) : 9);
  } catch (const std::exception& error) {
    std::cerr << "umbrick_volpack_speed: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
