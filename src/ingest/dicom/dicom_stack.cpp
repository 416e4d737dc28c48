// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_stack.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "ingest/dicom/dicom_alike.h"
#include "ingest/dicom/dicom_frames.h"
#include "ingest/dicom/dicom_place.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// Positions are written to a micron or so; slices are never that thin.
constexpr double kSame = 1e-3;

// How far positions may be off an even grid, mm: by 2 % of a step or a hundredth of a millimetre, which steps of no
// scanner are good to. Where positions are written in few digits, each is off by up to half of the last one, and so are
// the first and the last, from which the grid comes: in three components together by sqrt(3) of the last digit. A
// quarter of a step is the most, so that a slice that is missing is always seen.
struct Tolerance {
  double usual = 0, written = 0;
  double digit = 0;  // by which the distance of two positions may be off as they are written

  Tolerance(const std::vector<DicomSlice>& slices, double step) {
    digit = slices.front().frame->lastDigit;
    for (const DicomSlice& slice : slices) digit = std::min(digit, slice.frame->lastDigit);
    usual = std::max(0.02 * step, 0.01);
    written = std::max(usual, std::min(std::sqrt(3.0) * digit, 0.25 * step));
    digit = std::min(digit, 0.25 * step);
  }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace

DicomStack::DicomStack(std::string name, std::vector<DicomFile> files, const DicomOptions& options,
                       std::vector<std::string>& notes)
    : name_(std::move(name)), files_(std::move(files)) {
  checkPlanes(files_);
  keepAlike(files_, !options.series.empty(), notes);
  completePlaces(name_, files_, options, notes);
  for (DicomFile& file : files_)
    for (DicomFrame& frame : file.frames) {
      frame.alongRow = glm::normalize(*frame.alongRow);
      frame.alongColumn = glm::normalize(*frame.alongColumn);
      slices_.push_back({&file, &frame});
    }
  normal_ = glm::normalize(sliceNormal(*slices_.front().frame));
  sortSlices();
  checkOnePerPlace();
  for (std::size_t i = 0; i < slices_.size(); ++i) blends_.push_back({i, 0});
  const std::string uneven = unevenness(notes);
  if (uneven.empty()) return;
  if (!options.evenSlices) throw UnevenSlices(name_ + ": " + uneven);
  evenOut(notes);
}

double DicomStack::along(const DicomSlice& slice) const { return glm::dot(*slice.frame->position, normal_); }

void DicomStack::sortSlices() {
  std::stable_sort(slices_.begin(), slices_.end(),
                   [&](const DicomSlice& a, const DicomSlice& b) { return along(a) < along(b); });
}

glm::dmat4 DicomStack::indexToWorld() const {
  const DicomFrame& first = *slices_.front().frame;
  glm::dmat4 m(1);
  m[0] = glm::dvec4(*first.alongRow * first.spacing->x, 0);
  m[1] = glm::dvec4(*first.alongColumn * first.spacing->y, 0);
  m[2] = glm::dvec4(meanStep(), 0);
  m[3] = glm::dvec4(*first.position, 1);
  return m;
}

// From one slice to the next, the mean of all; a single slice is as thick as it says, or as its pixels are wide.
glm::dvec3 DicomStack::meanStep() const {
  const DicomFrame& first = *slices_.front().frame;
  if (blends_.size() > 1)
    return (*slices_.back().frame->position - *first.position) / static_cast<double>(blends_.size() - 1);
  const double thickness = files_.front().sliceDistance;
  return normal_ * (thickness > 0 ? thickness : std::sqrt(first.spacing->x * first.spacing->y));
}

void DicomStack::checkOnePerPlace() const {
  std::vector<std::size_t> places(slices_.size(), 0);
  std::size_t twice = 0;
  for (std::size_t i = 1; i < slices_.size(); ++i) {
    const bool same = along(slices_[i]) - along(slices_[i - 1]) < kSame;
    places[i] = places[i - 1] + (same ? 0 : 1);
    if (same && twice == 0) twice = i;
  }
  if (twice == 0) return;
  const DicomSlice &a = slices_[twice - 1], &b = slices_[twice];
  const std::string text = name_ + ": expected one slice at each position, found " + sliceName(*a.file, *a.frame) +
                           " and " + sliceName(*b.file, *b.frame) + " at " + pointText(*a.frame->position);
  const std::string differ = whatDiffers(slices_, places);
  if (differ.empty()) throw IoError(text);
  throw SeveralPhases(text + "; they differ in " + differ);
}

std::string DicomStack::unevenness(std::vector<std::string>& notes) const {
  if (slices_.size() < 2) return {};
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices_.size(); ++i) gaps.push_back(along(slices_[i]) - along(slices_[i - 1]));
  const double usual = median(gaps);
  const glm::dvec3 each = meanStep();
  const Tolerance tolerance(slices_, glm::length(each));
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const DicomSlice &a = slices_[i], &b = slices_[i + 1];
    if (gaps[i] > 1.5 * usual + tolerance.digit)
      return "expected slices " + std::to_string(usual) + " mm apart, found " + std::to_string(gaps[i]) +
             " mm between " + sliceName(*a.file, *a.frame) + " at " + pointText(*a.frame->position) + " and " +
             sliceName(*b.file, *b.frame) + " at " + pointText(*b.frame->position) + ": is a slice missing?";
  }
  double most = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    const glm::dvec3 expected = *slices_.front().frame->position + each * static_cast<double>(i);
    const glm::dvec3 found = *slices_[i].frame->position;
    most = std::max(most, glm::distance(expected, found));
    if (glm::distance(expected, found) > tolerance.written)
      return sliceName(*slices_[i].file, *slices_[i].frame) + ": ImagePositionPatient: expected " +
             pointText(expected) + " for slices that are evenly spaced, found " + pointText(found);
  }
  if (most > tolerance.usual)
    notes.push_back("positions are up to " + std::to_string(most) +
                    " mm off even steps, as those written in few digits are, and the steps are taken for even");
  return {};
}

void DicomStack::evenOut(std::vector<std::string>& notes) {
  const std::size_t count = slices_.size();
  const DicomSlice &first = slices_.front(), &last = slices_.back();
  const double length = along(last) - along(first);
  std::vector<double> at, gaps;
  for (const DicomSlice& slice : slices_) at.push_back(along(slice) - along(first));
  for (std::size_t i = 1; i < count; ++i) gaps.push_back(at[i] - at[i - 1]);
  const double usual = median(gaps), least = *std::min_element(gaps.begin(), gaps.end());
  const double closeness = Tolerance(slices_, usual).written;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 expected = glm::mix(*first.frame->position, *last.frame->position, at[i] / length);
    if (glm::distance(expected, *slices_[i].frame->position) > closeness)
      throw IoError(name_ + ": " + sliceName(*slices_[i].file, *slices_[i].frame) +
                    ": ImagePositionPatient: expected " + pointText(expected) + " for slices in line, found " +
                    pointText(*slices_[i].frame->position));
  }
  // Where slices are missing, the others lie on the grid of the usual distance. Else the grid is as fine as the closest
  // slices, within reason.
  auto steps = static_cast<std::size_t>(std::max(std::llround(length / usual), 1ll));
  const auto onGrid = [&](double t) {
    const double step = length / static_cast<double>(steps);
    return std::abs(t - std::round(t / step) * step) <= closeness;
  };
  constexpr std::size_t kMostPerSlice = 16;
  if (steps > kMostPerSlice * count || !std::all_of(at.begin(), at.end(), onGrid))
    steps = std::min<std::size_t>(static_cast<std::size_t>(std::max(std::llround(std::min(length / least, 1e9)), 1ll)),
                                  kMostPerSlice * count);
  const double step = length / static_cast<double>(steps);
  blends_.clear();
  std::size_t blended = 0;
  double widest = 0;
  for (std::size_t k = 0, i = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) * step;
    while (i + 2 < count && at[i + 1] <= t) ++i;
    const double low = std::abs(t - at[i]), high = std::abs(at[i + 1] - t);
    const double near = std::min(closeness, 0.25 * gaps[i]);
    if (std::min(low, high) <= near) {
      blends_.push_back({low <= high ? i : i + 1, 0});
      continue;
    }
    blends_.push_back({i, std::clamp((t - at[i]) / gaps[i], 0.0, 1.0)});
    ++blended;
    widest = std::max(widest, gaps[i]);
  }
  notes.push_back("slices are not evenly spaced: " + std::to_string(blended) + " of " + std::to_string(blends_.size()) +
                  ", " + std::to_string(step) + " mm apart, are interpolated between neighbours up to " +
                  std::to_string(widest) + " mm apart");
}

}  // namespace umbrick
