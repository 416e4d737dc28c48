// SPDX-License-Identifier: Apache-2.0
#include "reference/classifier.h"

namespace umbrick {
namespace {

// Returns the integral over the first `extent` of a stretch, which may be negative below the first control point.
MediumIntegral integralOf(const LinearStretch& stretch, double extent) {
  const double half = extent / 2, third = extent * extent / 3;
  return {extent * (stretch.sigma_t + half * stretch.sigmaSlope),
          extent * (stretch.sigma_t * stretch.albedo +
                    half * (stretch.sigma_t * stretch.albedoSlope + stretch.sigmaSlope * stretch.albedo) +
                    third * stretch.sigmaSlope * stretch.albedoSlope)};
}

}  // namespace

Classifier::Classifier(const TransferFunction& transfer) : transfer_(transfer) {
  if (is2d()) return;
  values_ = transfer.values();
  const std::vector<Medium>& media = transfer.media();
  const std::size_t count = values_.size();
  stretches_.resize(count + 1);
  stretches_[0] = {values_[0], media[0].sigma_t, 0, media[0].albedo, glm::dvec3(0)};
  stretches_[count] = {values_[count - 1], media[count - 1].sigma_t, 0, media[count - 1].albedo, glm::dvec3(0)};
  for (std::size_t i = 1; i < count; ++i) {
    const double extent = values_[i] - values_[i - 1];
    const Medium &low = media[i - 1], &high = media[i];
    if (extent > 0)
      stretches_[i] = {values_[i - 1], low.sigma_t, (high.sigma_t - low.sigma_t) / extent, low.albedo,
                       (high.albedo - low.albedo) / extent};
  }
  if (count <= kMostCrossed) return;
  integrals_.resize(count + 1);  // nothing below the first point
  for (std::size_t i = 1; i < count; ++i) {
    const MediumIntegral part = integralOf(stretches_[i], values_[i] - values_[i - 1]), &before = integrals_[i];
    integrals_[i + 1] = {before.sigma_t + part.sigma_t, before.sigma_s + part.sigma_s};
  }
}

MediumIntegral Classifier::integral(double value) const {
  const std::size_t index = locate(value);
  const MediumIntegral part = integralOf(stretches_[index], value - stretches_[index].origin);
  return {integrals_[index].sigma_t + part.sigma_t, integrals_[index].sigma_s + part.sigma_s};
}

Cubic Classifier::throughThirds(const std::array<double, 4>& y, double begin, double h) {
  // Newton's divided differences are taken at 0, 1, 2 and 3 thirds, and then u = 3 (s - begin) / h is replaced by s.
  const double d1 = y[1] - y[0], d2 = (y[2] - 2 * y[1] + y[0]) / 2, d3 = (y[3] - 3 * y[2] + 3 * y[1] - y[0]) / 6;
  const std::array<double, 4> inU{y[0], d1 - d2 + 2 * d3, d2 - 3 * d3, d3};
  const double scale = 3 / h, shift = -scale * begin;  // u = shift + scale s
  // This is Horner's scheme with polynomials.
  Cubic result;
  for (int i = 3; i >= 0; --i) {
    std::array<double, 4> next{};
    for (std::size_t k = 0; k < 4; ++k) {
      next[k] += shift * result.c[k];
      if (k < 3) next[k + 1] += scale * result.c[k];
    }
    next[0] += inU[static_cast<std::size_t>(i)];
    result.c = next;
  }
  return result;
}

}  // namespace umbrick
