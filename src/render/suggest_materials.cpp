// Transfer functions of things made of materials: CT, labels, and whatever has regions of one value each.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "render/suggest_colours.h"
#include "render/suggest_parts.h"

namespace umbrick {
namespace {

using Points = std::vector<TransferFunction::Point>;
constexpr double kFaintDepth = 1.5;  // mean optical depth of columns through what lies around the rest

// Weighs values of an interval with 1.
std::function<double(double)> within(double low, double high) {
  return [=](double value) { return value >= low && value < high ? 1.0 : 0.0; };
}

// --- regions ---

// The values that a region has, as bins of the survey.
struct Region {
  std::size_t centre = 0;    // where the mean gradient is smallest
  std::size_t boundary = 0;  // below it, where the mean gradient is largest
};

// Smooths the histogram, and the gradients weighted by it, over a few bins.
struct Smoothed {
  std::vector<double> count, gradient;
};
Smoothed smooth(const ValueSurvey& values) {
  constexpr int kReach = 6;
  constexpr double kWidth = 2.5;  // bins, standard deviation
  const int bins = static_cast<int>(values.histogram.size());
  Smoothed smoothed{std::vector<double>(values.histogram.size()), std::vector<double>(values.histogram.size())};
  for (int i = 0; i < bins; ++i) {
    double weights = 0, count = 0, gradient = 0;
    for (int j = std::max(0, i - kReach); j <= std::min(bins - 1, i + kReach); ++j) {
      const double weight = std::exp(-0.5 * (i - j) * (i - j) / (kWidth * kWidth));
      const auto bin = static_cast<std::size_t>(j);
      weights += weight;
      count += weight * values.histogram[bin];
      gradient += weight * values.histogram[bin] * values.gradient[bin];
    }
    smoothed.count[static_cast<std::size_t>(i)] = count / weights;
    smoothed.gradient[static_cast<std::size_t>(i)] = count > 0 ? gradient / count : 0;
  }
  return smoothed;
}

// Returns the bin of the air: the background, or the values that most voxels of the lower half have.
std::size_t airBin(const ValueSurvey& values, const Smoothed& smoothed) {
  if (values.background <= values.low) return 0;
  const std::size_t half = smoothed.count.size() / 2;
  return static_cast<std::size_t>(
      std::max_element(smoothed.count.begin(), smoothed.count.begin() + static_cast<std::ptrdiff_t>(half)) -
      smoothed.count.begin());
}

// Walks up the values from the air on. A region is confirmed where the mean gradient has fallen clearly and rises
// again, or where it has fallen and the values end.
std::vector<Region> findRegions(const Smoothed& smoothed, std::size_t air) {
  constexpr double kClearly = 0.62;
  const std::vector<double>& gradient = smoothed.gradient;
  std::vector<Region> regions;
  Region next{air, air};
  bool falling = false;
  for (std::size_t bin = air; bin < gradient.size(); ++bin) {
    if (!falling) {
      if (gradient[bin] > gradient[next.boundary]) next.boundary = bin;
      if (gradient[bin] < kClearly * gradient[next.boundary]) {
        falling = true;
        next.centre = bin;
      }
      continue;
    }
    if (gradient[bin] < gradient[next.centre]) next.centre = bin;
    if (gradient[bin] * kClearly > gradient[next.centre]) {
      regions.push_back(next);
      next = {bin, bin};
      falling = false;
    }
  }
  if (falling) regions.push_back(next);
  return regions;
}

double sumFrom(const std::vector<double>& counts, std::size_t first, std::size_t end) {
  double sum = 0;
  for (std::size_t bin = first; bin < end; ++bin) sum += counts[bin];
  return sum;
}

// Leaves out regions of too few voxels to be one: they join the one before.
void dropSmall(std::vector<Region>& regions, const ValueSurvey& values, double thing) {
  constexpr double kLeastShare = 0.002;
  for (std::size_t i = regions.size(); i-- > 0;) {
    const std::size_t end = i + 1 < regions.size() ? regions[i + 1].boundary : values.histogram.size();
    if (sumFrom(values.histogram, regions[i].boundary, end) < kLeastShare * thing)
      regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

// What light does in one region.
struct RegionMedium {
  double low = 0, centre = 0;  // values at its boundary and of the region itself
  Medium medium;
};

TransferFunction fromRegions(const std::vector<RegionMedium>& regions, double air, double high) {
  Points points;
  Medium before{regions.front().medium.albedo, 0};
  double centreBefore = air;
  for (const RegionMedium& region : regions) {
    // Around the boundary, where values are those of voxels that both regions share, the medium changes.
    points.push_back({region.low - 0.3 * (region.low - centreBefore), before});
    points.push_back({region.low + 0.6 * (region.centre - region.low), region.medium});
    before = region.medium;
    centreBefore = region.centre;
  }
  if (high > points.back().value) {
    points.push_back({high, before});
  }
  return TransferFunction(std::move(points));
}

}  // namespace

double SuggestInput::solid() const {
  constexpr double kPicture = 256;
  return std::min(2 * kPicture / diagonal, 1.5 / voxelEdge);
}

double SuggestInput::depthOf(double opticalDepth, const std::function<double(double)>& weight) const {
  const std::vector<double> columns = columnIntegrals(volume.grid(), axis, weight);
  if (columns.empty()) return solid();
  double sum = 0;
  for (const double column : columns) sum += column;
  return opticalDepth * static_cast<double>(columns.size()) / sum;
}

TransferFunction suggestCt(const SuggestInput& input, double air) {
  const double zero = air + 1000;  // water
  const glm::dvec3 skin(0.80, 0.50, 0.36), muscle(0.75, 0.36, 0.26), cartilage(0.84, 0.66, 0.50),
      bone(0.92, 0.86, 0.74), dense(0.97, 0.95, 0.90);
  const double tissue = std::min(input.depthOf(kFaintDepth, within(zero - 200, zero + 150)), 0.5 * input.solid());
  const double solid = input.solid();
  return TransferFunction({{zero - 300, {skin, 0}},
                           {zero - 100, {skin, tissue}},
                           {zero - 50, {skin, 0.8 * tissue}},
                           {zero + 60, {muscle, 0.8 * tissue}},
                           {zero + 140, {cartilage, tissue}},
                           {zero + 260, {bone, 0.5 * solid}},
                           {zero + 500, {bone, solid}},
                           {zero + 2000, {dense, 1.2 * solid}}});
}

std::optional<TransferFunction> suggestLabels(const SuggestInput& input) {
  const ValueSurvey& values = input.values;
  if (values.distinct.empty()) return std::nullopt;
  std::vector<double> labels;
  for (const auto& [value, count] : values.distinct)
    if (value != values.background) labels.push_back(value);
  constexpr double kLeastJumps = 0.15;
  const bool mask = labels.size() == 1;
  if (labels.empty() || (!mask && !(labels.size() > 2 && values.jumps > kLeastJumps))) return std::nullopt;
  const double solid = std::max(input.solid(), 2 / input.voxelEdge);
  Points points;
  if (mask) {  // one region and what is around it: the surface lies half way
    const double label = labels.front(), half = 0.5 * (label - values.background), width = 0.5 * std::abs(half);
    const Medium in{plainColour(), solid}, out{plainColour(), 0};
    const double middle = label - half;
    points.push_back({middle - width, half > 0 ? out : in});
    points.push_back({middle + width, half > 0 ? in : out});
    return TransferFunction(std::move(points));
  }
  // Between voxels of two labels values run through all labels between them. Each label is seen only close to its own
  // number, so that those on the way weigh little.
  constexpr double kHalfWidth = 0.06;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const glm::dvec3 colour = labelColour(i);
    for (const double side : {-2.0, -1.0, 1.0, 2.0})
      points.push_back({labels[i] + side * kHalfWidth, {colour, std::abs(side) > 1.5 ? 0 : solid}});
  }
  return TransferFunction(std::move(points));
}

std::optional<TransferFunction> suggestMaterials(const SuggestInput& input) {
  const ValueSurvey& values = input.values;
  const Smoothed smoothed = smooth(values);
  const std::size_t air = airBin(values, smoothed);
  std::vector<Region> regions = findRegions(smoothed, air);
  if (regions.empty()) return std::nullopt;
  // Where most of what is not air lies below the first boundary there are no regions, but a field that fades out.
  const std::size_t afterAir = std::min(air + kSurveyBins / 24, regions.front().boundary);
  const double thing = sumFrom(values.histogram, afterAir, values.histogram.size());
  constexpr double kLeastInRegions = 0.4;
  if (!(sumFrom(values.histogram, regions.front().boundary, values.histogram.size()) > kLeastInRegions * thing))
    return std::nullopt;
  dropSmall(regions, values, thing);
  if (regions.empty()) return std::nullopt;
  std::vector<RegionMedium> media;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const double low = values.binCentre(regions[i].boundary);
    const double high = i + 1 < regions.size() ? values.binCentre(regions[i + 1].boundary) : values.value.max + 1.0;
    const bool innermost = i + 1 == regions.size();
    const glm::dvec3 colour =
        regions.size() == 1 ? plainColour() : ascendingColour(double(i) / double(regions.size() - 1));
    const double faint = (i == 0 ? 1 : 2.5) * kFaintDepth;
    const double sigma_t = innermost ? input.solid() : std::min(input.depthOf(faint, within(low, high)), input.solid());
    media.push_back({low, values.binCentre(regions[i].centre), {colour, sigma_t}});
  }
  return fromRegions(media, values.binCentre(air), values.high);
}

}  // namespace umbrick
