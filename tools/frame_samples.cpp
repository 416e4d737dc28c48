// SPDX-License-Identifier: Apache-2.0
#include "frame_samples.h"

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "progress.h"

namespace umbrick::tools {
namespace {

using Progress = std::function<void(double)>;

// Returns the volume of a frame; null where it holds nothing, or where it cannot be read and is to be skipped.
std::shared_ptr<const Volume> loadSample(const FrameJob& job, const FrameJob::Frame& frame, const Progress& progress) {
  try {
    return openVolumeOf(frame.volume, progress);
  } catch (const EmptyVolume&) {
    return nullptr;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error&) {
    if (!job.skipMissing) throw;
    return nullptr;  // is told when its turn comes
  }
}

// What the samples show together.
class SampleView {
 public:
  SampleView(const SceneOptions& options, const Scene& scene) : options_(options), scene_(scene) {}

  void add(std::int64_t number, const Volume& volume) {
    Scene shown = scene_;
    if (scene_.transfer) {
      shown.transfer = fitted(*scene_.transfer, volume);
    } else {
      const SuggestedTransfer suggested = suggestTransfer(volume);
      const Range values = suggested.transfer.valueDomain();
      if (!hints_.transfer || values.max - values.min > reach_) {
        reach_ = values.max - values.min;
        number_ = number;
        hints_.transfer = suggested;
      }
      shown.transfer = suggested.transfer;
      applyWindow(options_, shown);
    }
    numbers_.push_back(number);
    if (!scene_.orbit) return;
    const Box box = visibleAtAnyKey(volume, shown);
    if (!hints_.seen) hints_.seen = Box{};
    hints_.seen->include(box.min);
    hints_.seen->include(box.max);
  }

  SceneHints hints() const {
    SceneHints hints = hints_;
    if (!hints.transfer || numbers_.size() < 2) return hints;
    std::string frames;
    for (std::size_t i = 0; i < numbers_.size(); ++i)
      frames += (i == 0 ? "" : i + 1 == numbers_.size() ? " and " : ", ") + std::to_string(numbers_[i]);
    hints.transfer->reason += ", by frame " + std::to_string(number_) + ", whose values reach farthest of " + frames;
    return hints;
  }

 private:
  const SceneOptions& options_;
  const Scene& scene_;
  SceneHints hints_;
  double reach_ = 0;
  std::int64_t number_ = 0;
  std::vector<std::int64_t> numbers_;
};

}  // namespace

OpenedScene openFrames(const SceneOptions& options, const FrameJob& job, const Scene& scene, const Progress& progress) {
  if (job.oneVolume) {
    OpenedScene opened = openScene(options, scene, progress);
    // An orbit looks at one box in all frames.
    if (scene.orbit && !scene.tracks.empty()) opened.seen = visibleAtAnyKey(*opened.volume, opened.scene);
    return opened;
  }
  const std::size_t count = job.frames.size();
  SampleView view(options, scene);
  std::shared_ptr<const Volume> first;
  std::size_t next = 0;
  for (; next < count && !first; ++next) {
    first = loadSample(job, job.frames[next], progress);
    if (first) view.add(job.frames[next].number, *first);
  }
  if (!first) throw InvalidArgument(scene.volume.file.string() + ": none of its frames holds anything to show");
  const std::size_t shown = next - 1;
  const bool open = !scene.transfer || scene.orbit;
  for (const std::size_t sample : std::set<std::size_t>{count / 2, count - 1})
    if (open && sample >= next)
      if (const auto volume = loadSample(job, job.frames[sample], progress))
        view.add(job.frames[sample].number, *volume);
  OpenedScene opened = completeScene(options, scene, first, view.hints());
  opened.frame = shown;
  return opened;
}

Box visibleAtAnyKey(const Volume& volume, const Scene& scene) {
  Box seen = volume.visibleBounds(*scene.transfer);
  for (const SceneTrack& track : scene.tracks)
    for (const SceneTrack::Key& key : track.keys)
      if (key.transfer) {
        const Box box = volume.visibleBounds(*key.transfer);
        seen.include(box.min);
        seen.include(box.max);
      }
  return seen;
}

FrameKind kindOf(const Volume& volume) {
  return {volume.name(), volume.indexToWorld(), volume.grid().isLevelSet(), volume.valueUnit()};
}

void requireAlike(const Volume& frame, const FrameKind& first) {
  const auto refuse = [&](const std::string& what) {
    throw InvalidArgument(frame.name() + ": " + what + " " + first.name);
  };
  const glm::dmat4 &own = frame.indexToWorld(), &other = first.indexToWorld;
  // Files round transforms to single precision at worst; places count in voxels.
  const double edge = shortestVoxelEdge(other);
  constexpr double kRounding = 1e-4;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(own[column][row] - other[column][row]) <= kRounding * edge))
        refuse(column == 3 ? "its voxels begin at another place than those of"
                           : "its voxels are of another size than those of");
  if (frame.grid().isLevelSet() != first.levelSet)
    refuse(first.levelSet ? "is no level set, unlike" : "is a level set, unlike");
  if (frame.valueUnit() != first.unit)
    refuse("its values are in '" + frame.valueUnit() + "', and not in '" + first.unit + "' as those of");
}

}  // namespace umbrick::tools
