// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <string>
#include <vector>

#include "check/kit_hints.h"
#include "umbrick/core/short_number.h"

namespace umbrick {
namespace {

// A mistake has to explain this share of the wrong samples, each but for a twentieth of its error.
constexpr double kMostWrong = 0.95, kRestOfError = 0.05;

struct SampleMistake {
  std::string sentence;
  std::function<double(const KitSample&)> value;  // that a renderer with this mistake gives
};

// Returns how far a sample moves in units of index space where its coordinates are rounded to single precision.
double roundingOf(const glm::dvec3& coordinates, const glm::dvec3& toIndexScale) {
  double moved = 0;
  for (int axis = 0; axis < 3; ++axis)
    moved = std::max(moved, std::abs(coordinates[axis]) * 0x1p-24 * toIndexScale[axis]);
  return moved;
}

class SampleHints {
 public:
  SampleHints(const AskedCase& asked, const std::vector<double>& answer, double limit)
      : asked_(asked),
        answer_(answer),
        limit_(limit),
        voxel_(voxelsOf(asked.grid)),
        toWorld_(asked.grid.indexToWorld()) {
    for (std::size_t i = 0; i < answer.size(); ++i)
      if (!(std::abs(answer[i] - asked.samples[i].value) <= limit)) wrong_.push_back(i);
  }

  std::string explain() const {
    std::string best;
    std::size_t most = static_cast<std::size_t>(std::ceil(kMostWrong * static_cast<double>(wrong_.size())));
    for (const SampleMistake& mistake : mistakes()) {
      const std::size_t explained = countExplained(mistake);
      if (explained < most || (explained == most && !best.empty())) continue;
      most = explained;
      best = "the samples agree when " + mistake.sentence;
    }
    return best.empty() ? explainByRounding() : best;
  }

 private:
  std::size_t countExplained(const SampleMistake& mistake) const {
    return static_cast<std::size_t>(std::count_if(wrong_.begin(), wrong_.end(), [&](std::size_t i) {
      const KitSample& sample = asked_.samples[i];
      const double error = std::abs(answer_[i] - sample.value);
      return std::abs(answer_[i] - mistake.value(sample)) <= std::max(limit_, kRestOfError * error);
    }));
  }

  std::vector<SampleMistake> mistakes() const {
    const auto at = [this](const glm::dvec3& index) { return trilinear(voxel_, index); };
    // Interpolates in the sample's brick, whose apron is something else.
    const auto inBrick = [this](const KitSample& sample,
                                const std::function<double(const glm::i64vec3&, bool)>& voxel) {
      const glm::i64vec3 low(asked_.bricks.originAt(sample.index));
      const glm::i64vec3 high = low + glm::i64vec3(asked_.bricks.interior()) - std::int64_t(1);
      return trilinear(
          [&](const glm::i64vec3& p) {
            const glm::i64vec3 owned = glm::clamp(p, low, high);
            return voxel(owned, owned == p);
          },
          sample.index);
    };
    const double background = backgroundOf();
    const IndexBox box = asked_.box;
    const glm::dvec3 ends = glm::dvec3(box.min) + glm::dvec3(box.max);
    std::vector<SampleMistake> list{
        {"the nearest voxel's value is taken: values are not interpolated",
         [this](const KitSample& s) { return voxel_(glm::i64vec3(glm::round(s.index))); }},
        {"aprons repeat the outermost voxels of their own brick: they are those of the neighbours",
         [=, this](const KitSample& s) {
           return inBrick(s, [this](const glm::i64vec3& owned, bool) { return voxel_(owned); });
         }},
        {"aprons hold the background: they are the voxels of the neighbours",
         [=, this](const KitSample& s) {
           return inBrick(
               s, [=, this](const glm::i64vec3& owned, bool mine) { return mine ? voxel_(owned) : background; });
         }},
        {"aprons hold 0: they are the voxels of the neighbours",
         [=, this](const KitSample& s) {
           return inBrick(s, [this](const glm::i64vec3& owned, bool mine) { return mine ? voxel_(owned) : 0.0; });
         }},
        {"points are moved by half a voxel up each axis: voxel centres lie at whole index coordinates",
         [=](const KitSample& s) { return at(s.index + 0.5); }},
        {"points are moved by half a voxel down each axis: voxel centres lie at whole index coordinates",
         [=](const KitSample& s) { return at(s.index - 0.5); }},
        {"0 is taken for what lies around the volume: it is the background",
         [=, this](const KitSample& s) {
           return trilinear(
               [&](const glm::i64vec3& p) {
                 const bool within = glm::all(glm::lessThan(glm::i64vec3(box.min), p)) &&
                                     glm::all(glm::lessThan(p, glm::i64vec3(box.max)));
                 return within ? voxel_(p) : 0.0;
               },
               s.index);
         }},
    };
    for (int axis = 0; axis < 3; ++axis)
      list.push_back({std::string("voxels are mirrored along ") + "ijk"[axis], [=](const KitSample& s) {
                        glm::dvec3 index = s.index;
                        index[axis] = ends[axis] - index[axis];
                        return at(index);
                      }});
    const glm::i64vec3 dims = box.extent(), first(box.min);
    list.push_back({"volume.raw is read with z fastest: x is fastest in it", [=, this](const KitSample& s) {
                      return trilinear(
                          [&](const glm::i64vec3& p) {
                            const glm::i64vec3 q = p - first;
                            if (glm::any(glm::lessThan(q, glm::i64vec3(0))) || glm::any(glm::greaterThanEqual(q, dims)))
                              return background;
                            const std::int64_t place = (q.x * dims.y + q.y) * dims.z + q.z;
                            return voxel_(first + glm::i64vec3(place % dims.x, place / dims.x % dims.y,
                                                               place / (dims.x * dims.y)));
                          },
                          s.index);
                    }});
    return list;
  }

  double backgroundOf() const { return voxel_(glm::i64vec3(asked_.box.min)); }

  // Coordinates of single precision are rounded in several places, so that only the size of what follows is known.
  std::string explainByRounding() const {
    const glm::dmat4 toIndex = glm::inverse(toWorld_);
    glm::dvec3 perWorld(0);
    for (int axis = 0; axis < 3; ++axis)
      for (int row = 0; row < 3; ++row) perWorld[axis] = std::max(perWorld[axis], std::abs(toIndex[axis][row]));
    std::size_t byWorld = 0, byIndex = 0;
    double movedInWorld = 0, movedInIndex = 0;
    for (const std::size_t i : wrong_) {
      const KitSample& sample = asked_.samples[i];
      const double error = std::abs(answer_[i] - sample.value), slope = steepness(sample.index);
      const double world = roundingOf(glm::dvec3(toWorld_ * glm::dvec4(sample.index, 1)), perWorld);
      const double index = roundingOf(sample.index, glm::dvec3(1));
      // Three roundings along each of three axes.
      constexpr double kRoundings = 9;
      byWorld += error <= limit_ + kRoundings * world * slope;
      byIndex += error <= limit_ + kRoundings * index * slope;
      movedInWorld = std::max(movedInWorld, world);
      movedInIndex = std::max(movedInIndex, index);
    }
    const auto enough = [&](std::size_t count) {
      return static_cast<double>(count) >= kMostWrong * static_cast<double>(wrong_.size());
    };
    const auto sentence = [](const std::string& kind, double moved) {
      return kind + " coordinates in single precision, which are off by " + shortNumber(moved, 2) +
             " voxels here, would explain the errors: subtract an origin in double precision first";
    };
    // The smaller one says more.
    if (enough(byIndex) && !wrong_.empty()) return sentence("index", movedInIndex);
    if (enough(byWorld) && !wrong_.empty()) return sentence("world", movedInWorld);
    return {};
  }

  // Returns the largest difference between voxels around a point: what a voxel's way changes the value by.
  double steepness(const glm::dvec3& index) const {
    const glm::i64vec3 low = glm::i64vec3(glm::floor(index)) - std::int64_t(1);
    double least = voxel_(low), most = least;
    for (int n = 0; n < 64; ++n) {
      const double value = voxel_(low + glm::i64vec3(n & 3, n >> 2 & 3, n >> 4));
      least = std::min(least, value);
      most = std::max(most, value);
    }
    return most - least;
  }

  const AskedCase& asked_;
  const std::vector<double>& answer_;
  double limit_;
  VoxelAt voxel_;
  glm::dmat4 toWorld_;
  std::vector<std::size_t> wrong_;
};

}  // namespace

std::string explainSamples(const AskedCase& asked, const std::vector<double>& answer, double limit) {
  return SampleHints(asked, answer, limit).explain();
}

}  // namespace umbrick
