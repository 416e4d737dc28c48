// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/resample.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "grid/box_overlap.h"
#include "grid/slab_builder.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"

namespace umbrick {
namespace {

constexpr std::int64_t kReadVoxels = std::int64_t(1) << 22;

// The values of the source in some box: their mean, which a new voxel gets, and what tells how far the
// voxels are from it.
struct Moments {
  double mean = 0, variance = 0;
  float low = std::numeric_limits<float>::infinity(), high = -low;
};

// Joins boxes one after the other. Variances are joined by the law of total variance, so that no digits cancel where
// values are large and nearly equal.
class MomentSum {
 public:
  void add(const Moments& part, double weight) {
    const double before = weight_, delta = part.mean - sum_.mean;
    weight_ += weight;
    const double share = weight / weight_;
    sum_.mean = before == 0 ? part.mean : sum_.mean + delta * share;
    sum_.variance = before == 0 ? part.variance
                                : sum_.variance + (part.variance - sum_.variance) * share +
                                      delta * delta * share * (before / weight_);
    sum_.low = std::min(sum_.low, part.low);
    sum_.high = std::max(sum_.high, part.high);
  }
  const Moments& moments() const { return sum_; }
  double weight() const { return weight_; }

 private:
  Moments sum_;
  double weight_ = 0;
};

glm::dvec3 spacingOf(const glm::dmat4& matrix) {
  return {glm::length(glm::dvec3(matrix[0])), glm::length(glm::dvec3(matrix[1])), glm::length(glm::dvec3(matrix[2]))};
}

BoxOverlap overlapOf(const VolumeInfo& info, int axis, double spacing) {
  const auto refuse = [&](const char* expected) {
    std::ostringstream text;
    text.precision(9);
    text << info.name << ": resample: " << expected << ", found " << spacing;
    throw InvalidArgument(text.str());
  };
  if (!(spacing > 0) || !std::isfinite(spacing)) refuse("expected a spacing > 0");
  const BoxOverlap overlap(info.dims[axis], spacing / spacingOf(info.indexToWorld)[axis]);
  if (!(overlap.count() <= std::numeric_limits<std::int32_t>::max()))
    refuse("expected a spacing of at most 2147483647 voxels along an axis");
  return overlap;
}

class ResampledSource : public VoxelSource {
 public:
  ResampledSource(std::unique_ptr<VoxelSource> source, const glm::dvec3& spacing,
                  std::shared_ptr<ResampleReport> report)
      : source_(std::move(source)),
        from_(source_->info().dims),
        x_(overlapOf(source_->info(), 0, spacing.x)),
        y_(overlapOf(source_->info(), 1, spacing.y)),
        z_(overlapOf(source_->info(), 2, spacing.z)),
        report_(report ? std::move(report) : std::make_shared<ResampleReport>()) {
    checkSlabFits(source_->info(), 1);
    const double plane = double(x_.count()) * double(y_.count()), rows = double(x_.count()) * double(from_.y);
    std::ostringstream step;
    step << source_->info().name << ": resample: a slice of " << x_.count() << " x " << y_.count() << " voxels";
    requireMemory(step.str(), plane * double(sizeof(Moments) + sizeof(MomentSum) + 2 * sizeof(float)) +
                                  rows * double(sizeof(Moments)));
    info_ = source_->info();
    info_.dims = {std::int64_t(x_.count()), std::int64_t(y_.count()), std::int64_t(z_.count())};
    info_.type = VoxelType::f32;
    const glm::dvec3 before = spacingOf(info_.indexToWorld);
    glm::dmat4& matrix = info_.indexToWorld;
    for (int axis = 0; axis < 3; ++axis) {
      const glm::dvec4 column = matrix[axis];
      matrix[axis] *= spacing[axis] / before[axis];
      // The faces stay where they are, the centres of the first voxels do not.
      matrix[3] += 0.5 * (matrix[axis] - column);
    }
    sourceVoxel_ = std::abs(glm::determinant(glm::dmat3(source_->info().indexToWorld)));
    *report_ = {from_, info_.dims, spacing};
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const auto slice = static_cast<std::size_t>(info_.dims.x * info_.dims.y);
    double error = 0;
    for (std::int64_t i = 0; i < count; ++i)
      error = std::max(error, readSlice(out.subspan(static_cast<std::size_t>(i) * slice, slice)));
    return error;
  }
  void skipSlices(std::int64_t count) override {
    next_ += count;
    if (next_ == info_.dims.z) goTo(from_.z);
  }
  bool skipsFast() const override { return source_->skipsFast(); }

 private:
  double readSlice(std::span<float> out) {
    double error = 0;
    sums_.assign(out.size(), {});
    for (std::int64_t z = z_.first(next_); z < z_.end(next_); ++z) {
      error = std::max(error, loadSlice(z));
      const double weight = z_.weight(next_, z);
      forRows(info_.dims.y, [&](std::int64_t y) {
        for (auto i = std::size_t(y * info_.dims.x); i < std::size_t((y + 1) * info_.dims.x); ++i)
          sums_[i].add(plane_[i], weight);
      });
    }
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(sums_[i].moments().mean);
    tally(out);
    if (++next_ == info_.dims.z) finish();
    return error;
  }

  // Fills plane_ with slice z of the source, which is the one at hand or lies ahead.
  double loadSlice(std::int64_t z) {
    if (z == planeSlice_) return 0;
    double error = 0;
    const std::int64_t slice = from_.x * from_.y;
    if (z >= readFrom_ + readCount_) {
      goTo(z);
      readCount_ = std::clamp<std::int64_t>(kReadVoxels / slice, 1, z_.end(next_) - z);
      read_.resize(static_cast<std::size_t>(readCount_ * slice));
      error = source_->readSlab(readCount_, read_);
      readFrom_ = z;
      position_ += readCount_;
    }
    planeSlice_ = z;
    reducePlane(read_.data() + (z - readFrom_) * slice);
    return error;
  }

  // Reduces the rows along x first, then the columns of the result.
  void reducePlane(const float* voxels) {
    const std::int64_t nx = info_.dims.x, ny = info_.dims.y;
    rows_.resize(static_cast<std::size_t>(nx * from_.y));
    plane_.resize(static_cast<std::size_t>(nx * ny));
    forRows(from_.y, [&](std::int64_t y) {
      const float* row = voxels + y * from_.x;
      for (std::int64_t x = 0; x < nx; ++x) {
        MomentSum sum;
        for (std::int64_t i = x_.first(x); i < x_.end(x); ++i) sum.add({row[i], 0, row[i], row[i]}, x_.weight(x, i));
        rows_[static_cast<std::size_t>(y * nx + x)] = sum.moments();
      }
    });
    forRows(ny, [&](std::int64_t y) {
      std::vector<MomentSum> sums(static_cast<std::size_t>(nx));
      for (std::int64_t i = y_.first(y); i < y_.end(y); ++i) {
        const double weight = y_.weight(y, i);
        for (std::int64_t x = 0; x < nx; ++x)
          sums[static_cast<std::size_t>(x)].add(rows_[static_cast<std::size_t>(i * nx + x)], weight);
      }
      for (std::int64_t x = 0; x < nx; ++x)
        plane_[static_cast<std::size_t>(y * nx + x)] = sums[static_cast<std::size_t>(x)].moments();
    });
  }

  // Adds up in one thread, so that the sums do not depend on the number of threads.
  void tally(std::span<const float> out) {
    const double depth = z_.edge(next_ + 1) - z_.edge(next_);
    std::size_t i = 0;
    for (std::int64_t y = 0; y < info_.dims.y; ++y) {
      const double area = depth * (y_.edge(y + 1) - y_.edge(y));
      for (std::int64_t x = 0; x < info_.dims.x; ++x, ++i) {
        const Moments& source = sums_[i].moments();
        if (!std::isfinite(source.low) || !std::isfinite(source.high) || !std::isfinite(source.mean)) continue;
        const double volume = area * (x_.edge(x + 1) - x_.edge(x)), value = out[i];
        volume_ += volume;
        report_->integralBefore += volume * source.mean;
        report_->integralAfter += volume * value;
        squares_ += volume * (source.variance + (source.mean - value) * (source.mean - value));
        report_->max = std::max({report_->max, source.high - value, value - source.low});
      }
    }
  }

  void finish() {
    goTo(from_.z);
    report_->rms = volume_ > 0 ? std::sqrt(squares_ / volume_) : 0;
    report_->integralBefore *= sourceVoxel_;
    report_->integralAfter *= sourceVoxel_;
  }

  void goTo(std::int64_t slice) {
    if (slice > position_) source_->skipSlices(slice - position_);
    position_ = std::max(position_, slice);
  }

  template <class Row>
  static void forRows(std::int64_t rows, const Row& row) {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, rows, 16), [&](const auto& range) {
      for (std::int64_t y = range.begin(); y != range.end(); ++y) row(y);
    });
  }

  std::unique_ptr<VoxelSource> source_;
  glm::i64vec3 from_;
  BoxOverlap x_, y_, z_;
  std::shared_ptr<ResampleReport> report_;
  double sourceVoxel_ = 0, volume_ = 0, squares_ = 0;
  std::int64_t next_ = 0, position_ = 0;       // next slice to give; next slice of the source
  std::int64_t readFrom_ = 0, readCount_ = 0;  // slices of the source that are in read_
  std::vector<float> read_;
  std::int64_t planeSlice_ = -1;
  std::vector<Moments> rows_, plane_;  // one slice of the source, resampled along x; along x and y
  std::vector<MomentSum> sums_;        // sums of the slice at hand
};

}  // namespace

std::unique_ptr<VoxelSource> resampleSource(std::unique_ptr<VoxelSource> source, const glm::dvec3& spacing,
                                            std::shared_ptr<ResampleReport> report) {
  return std::make_unique<ResampledSource>(std::move(source), spacing, std::move(report));
}

}  // namespace umbrick
