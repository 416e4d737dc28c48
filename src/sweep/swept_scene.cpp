// SPDX-License-Identifier: Apache-2.0
#include "sweep/swept_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "sweep/classified_voxels.h"
#include "sweep/index_planes.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/lights.h"

namespace umbrick {
namespace {

double longestVoxelEdge(const glm::dmat4& indexToWorld) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, glm::length(glm::dvec3(indexToWorld[axis])));
  return longest;
}

}  // namespace

bool sweptSupports(const SceneSettings& scene, Technique technique) {
  if (scene.sampling.classification == Classification::pre && traitsOf(scene.model).occlusion) return false;
  if (scene.sampling.classification == Classification::pre && emits(scene)) return false;
  if (!supports(Method::lightVolume, scene.model)) return false;
  const Method method = occlusionMethod(scene).value_or(Method::lightVolume);
  return method == Method::lightVolume ||
         (method == Method::coneRays && technique == Technique::rays && !traitsOf(scene.mode).surfaces);
}

SweptScene::SweptScene(const Bricks& volume, Technique technique)
    : technique_(technique), voxels_(volume), light_(volume) {}

void SweptScene::checkMethod(const ResolvedScene& next) const {
  if (technique_ != Technique::rays) refuseConeRays(next, techniqueName(technique_));
  checkConeRays(next);
  if (occlusionMethod(next) == Method::coneRays && next.transfer.is2d())
    throw InvalidArgument(
        "method: cone-rays on the CPU takes transfer functions of the value alone, without a gradient");
}

void SweptScene::update(const ResolvedScene& next, const ResolvedScene* before) {
  if (!supports(Method::lightVolume, next.model))
    throw InvalidArgument("model: " + modelName(next.model) + " is integrated by the reference alone; " +
                          techniqueName(technique_) + " renders emission, cone, ambient and lights");
  requireClassification(next);
  checkMethod(next);
  if (!sweptSupports(next, technique_))
    throw InvalidArgument("method: " + methodName(next.method) + " is one of slices; " + techniqueName(technique_) +
                          " takes light from a light volume");
  if (isShaded(next)) checkShading(next, volume().layout.apron);
  if (next.transfer.is2d()) requireGradients(volume(), next.gradients);
  constexpr std::size_t kMostVoxels = std::size_t{1} << 29;  // of a brick, whose places are 32-bit numbers of bytes
  if (volume().layout.voxels() > kMostVoxels)
    throw InvalidArgument("bricks: one brick has " + std::to_string(volume().layout.voxels()) + " voxels, " +
                          techniqueName(technique_) + " reads up to " + std::to_string(kMostVoxels));
  if (next.emitted) {
    if (!volume().hasEmission)
      throw InvalidArgument("volume.emissionGrid: '" + next.volume.emissionGrid +
                            "' needs bricks with the values of that grid, which there are none of");
    requireDarkBackground(*next.emitted, volume().emissionBackground);
  }
  const bool classified = next.sampling.classification == Classification::pre;
  const bool emission = before ? before->emitted != next.emitted : next.emitted.has_value();
  std::optional<MediumTable> emits;
  if (emission && next.emitted)
    emits.emplace(*next.emitted, volume().emissionBackground, std::numeric_limits<double>::max());
  const bool transfer =
      !before || before->transfer != next.transfer || before->sampling.classification != next.sampling.classification;
  std::optional<MediumTable> table;
  // A fourth of a segment, which is the least part that is taken, hides colours from an optical depth of 1 on.
  if (transfer)
    table.emplace(next.transfer, volume().background, largestExtinction(), 4 / longestVoxelEdge(volume().indexToWorld));
  if (transfer || emission || before->bricks.culling != next.bricks.culling ||
      before->bricks.budgetMiB != next.bricks.budgetMiB) {
    const MediumTable& now = table ? *table : *table_;
    const Range background{volume().background, volume().background};
    const bool backgroundVisible = !volume().domain.empty() && !now.isTransparent(background, {0, 0});
    const Stopwatch watch;
    const ShownValues shown(now, emits ? &*emits : next.emitted ? &*emission_ : nullptr);
    const bool emitting = next.emitted.has_value();
    std::vector<Brick> visible = voxels_.visible(shown, next.bricks.culling, backgroundVisible);
    const std::uint64_t most = next.bricks.budgetMiB << 20,
                        each = voxels_.bytesEach(now.is2d(), emitting) + mediaBytes(classified);
    const std::uint64_t needed =
        voxels_.bytesOf(visible, now.is2d(), emitting) + visible.size() * mediaBytes(classified);
    if (needed > 0 && each > most)
      throw InvalidArgument("bricks.budgetMiB: the voxels of one brick take " + std::to_string((each >> 20) + 1) +
                            " MiB, more than " + std::to_string(most >> 20) + " MiB");
    const bool inBands = needed > most;
    voxels_.hold(inBands ? std::span<const Brick>() : visible, shown, next.bricks.culling);
    if (classified)
      classify(voxels_, next.transfer, largestExtinction());
    else
      forgetMedia(voxels_);
    visible_ = std::move(visible);
    inBands_ = inBands;
    backgroundVisible_ = backgroundVisible;
    loadMs_ += watch.elapsedMs();
    loaded_ += voxels_.loaded();
  }
  if (table) table_.emplace(std::move(*table));
  if (emission) emission_ = std::move(emits);
}

// What this extinction leaves of light on the way through a thousandth of a voxel is nothing.
double SweptScene::largestExtinction() const { return 1e5 / shortestVoxelEdge(volume().indexToWorld); }

std::uint64_t SweptScene::mediaBytes(bool classified) const {
  return classified ? volume().layout.voxels() * kMediumNumbers * sizeof(float) : 0;
}

void SweptScene::prepare(const ResolvedScene& scene, const RenderSample& sample, RenderStats& stats) {
  const Stopwatch watch;
  stats.uploadMs = std::exchange(loadMs_, 0);
  stats.uploadedBricks = std::exchange(loaded_, 0);
  view_ = indexView(scene.camera, volume().indexToWorld);
  view_.seeThrough(sample.pixel);
  planes_ = indexPlanes(scene, volume(), backgroundVisible_);
  lights_ = 0;
  whole_ = glm::vec3(1);
  if (occlusionMethod(scene) == Method::lightVolume) {
    std::vector<glm::ivec3> cells;
    for (const Brick& brick : visible_) cells.push_back(brick.origin);
    light_.update(lightInMedium(scene, lightsOf(scene, sample), std::move(cells)), scene, planes_, volume().layout);
    if (!inBands_) light_.store(voxels_);
    light_.addTo(stats);
    lights_ = light_.channels();
    whole_ = glm::vec3(light_.whole());
  }
  coneDirections_.clear();
  if (occlusionMethod(scene) == Method::coneRays) {
    if (inBands_)
      throw InvalidArgument("bricks.budgetMiB: cone-rays need all visible bricks at once, which take more than " +
                            std::to_string(scene.bricks.budgetMiB) + " MiB");
    coneDirections_ = lightsOf(scene, sample);
    lightPlanes_ = planes_;
    stats.directions = static_cast<int>(coneDirections_.size());
  }
  if (isShaded(scene)) {
    const Stopwatch shading;
    lights_ = shading_.begin(scene, occlusionMethod(scene) ? &light_ : nullptr);
    if (!inBands_) shade();
    whole_ = glm::vec3(1);  // what is reflected is light and all
    stats.lightMs += shading.elapsedMs();
  }
  if (scene.camera.projection == Projection::orthographic) planes_.push_back(frontPlane(scene, volume()));
  stats.geometryMs = watch.elapsedMs() - stats.lightMs;
  stats.bricks = volume().bricks.size();
  stats.visibleBricks = stats.brickSlots = visible_.size();
  stats.textureBytes = voxels_.bytes();
}

void SweptScene::drawInBands(const ResolvedScene& scene, int rows, int multiple,
                             const std::function<RowSpan(const Brick& brick)>& rowsOf,
                             const std::function<void(int begin, int end)>& draw, RenderStats& stats) {
  if (!inBands_) {
    draw(0, rows);
    return;
  }
  const bool classified = scene.sampling.classification == Classification::pre;
  std::vector<RowSpan> spans;
  for (const Brick& brick : visible_) spans.push_back(rowsOf(brick));
  for (const RowBand& band : cutBands(spans, rows, multiple,
                                      voxels_.bytesEach(table_->is2d(), emission_.has_value()) + mediaBytes(classified),
                                      scene.bricks.budgetMiB << 20)) {
    const Stopwatch watch;
    std::vector<Brick> needed;
    for (std::size_t i = 0; i < spans.size(); ++i)
      if (spans[i].meets(band.begin, band.end)) needed.push_back(visible_[i]);
    voxels_.hold(needed, shown(), scene.bricks.culling, true);
    if (classified) classify(voxels_, scene.transfer, largestExtinction());
    if (occlusionMethod(scene)) light_.store(voxels_);
    if (isShaded(scene)) shade();
    stats.uploadMs += watch.elapsedMs();
    stats.uploadedBricks += voxels_.loaded();
    stats.textureBytes = std::max(stats.textureBytes, voxels_.bytes());
    draw(band.begin, band.end);
  }
}

// Puts what voxels reflect in the place of their light.
void SweptScene::shade() {
  shading_.update(voxels_);
  light_.forget();
}

SweptFrame SweptScene::frame(const ResolvedScene& scene, bool aux) const {
  SweptFrame frame;
  frame.voxels = &voxels_;
  frame.table = &*table_;
  if (emission_) frame.emission = &*emission_;
  frame.saturation = static_cast<float>(scene.sampling.saturation);
  frame.classified = scene.sampling.classification == Classification::pre;
  frame.midpoint = scene.sampling.quadrature == Quadrature::midpoint;
  frame.aux = aux;
  frame.lights = lights_;
  frame.lightUnit = isShaded(scene) ? shading_.unit() : light_.unit();
  const float sum = whole_.r + whole_.g + whole_.b;
  for (int c = 0; c < 3; ++c) frame.power[static_cast<std::size_t>(c)] = sum > 0 ? whole_[c] / sum : 0;
  return frame;
}

Box SweptScene::visibleBox() const {
  Box box{glm::dvec3(std::numeric_limits<double>::infinity()), glm::dvec3(-std::numeric_limits<double>::infinity())};
  for (const Brick& brick : visible_) {
    box.min = glm::min(box.min, glm::dvec3(brick.origin) - 1.0);
    box.max = glm::max(box.max, glm::dvec3(brick.origin + volume().layout.interior));
  }
  return box;
}

double segmentsPerVoxel(const ResolvedScene& scene, const Bricks& volume) {
  return shortestVoxelEdge(volume.indexToWorld) * scene.sampling.segments / scene.sampling.spacing;
}

void SweptScene::storePixel(const ResolvedScene& scene, std::size_t at, const glm::vec4& colour, const glm::vec2& aux,
                            Picture& picture, const glm::vec3& emitted) const {
  float* out = &picture.colour.pixels[4 * at];
  const float opacity = std::clamp(colour.w, 0.0f, 1.0f), through = 1 - opacity;
  const glm::vec3 scale(lightScale(scene));
  for (int c = 0; c < 3; ++c) {
    out[c] = std::max(colour[c], 0.0f) * whole_[c] * scale[c] + emitted[c];
    if (scene.background) out[c] += through * static_cast<float>((*scene.background)[c]);
  }
  out[3] = scene.background ? 1 : opacity;
  if (picture.depth.pixels.empty()) return;
  // What is reflected is no light that something is in the way of.
  picture.visibility.pixels[at] = isShaded(scene) ? opacity : aux.x;
  picture.opacity.pixels[at] = opacity;
  picture.depth.pixels[at] = opacity > 0 ? aux.y / opacity : std::numeric_limits<float>::infinity();
}

Picture emptyPicture(const ResolvedScene& scene, bool layers) {
  const double pixels = static_cast<double>(scene.camera.width) * scene.camera.height;
  requireMemory("camera.size: buffers of " + std::to_string(scene.camera.width) + " x " +
                    std::to_string(scene.camera.height) + " pixels",
                pixels * sizeof(float) * (layers ? 7 : 4) * 2);  // one is held and one is handed out
  Picture picture;
  picture.colour = Image(scene.camera.width, scene.camera.height, 4);
  if (layers)
    for (Image* image : {&picture.visibility, &picture.depth, &picture.opacity})
      *image = Image(scene.camera.width, scene.camera.height, 1);
  return picture;
}

}  // namespace umbrick
