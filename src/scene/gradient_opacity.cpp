// A transfer function of the value becomes one of value and gradient magnitude.
// SPDX-License-Identifier: Apache-2.0
#include "scene/gradient_opacity.h"

#include "umbrick/scene/resolve.h"

namespace umbrick {

TransferFunction withGradientOpacity(const TransferFunction& transfer, const glm::dvec2& ramp) {
  // A 2D function is constant beyond its edges and linear between them, so that two rows make the ramp.
  std::vector<Medium> media = transfer.media();
  for (Medium& medium : media) medium.sigma_t = 0;
  media.insert(media.end(), transfer.media().begin(), transfer.media().end());
  return TransferFunction(transfer.values(), {ramp.x, ramp.y}, std::move(media)).withUnit(transfer.unit());
}

std::optional<TransferFunction> withoutGradientOpacity(const TransferFunction& transfer, const glm::dvec2& ramp) {
  const std::vector<double>& gradients = transfer.gradients();
  if (gradients.size() != 2 || gradients[0] != ramp.x || gradients[1] != ramp.y) return std::nullopt;
  const std::size_t count = transfer.values().size();
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({transfer.values()[i], transfer.media()[count + i]});
  TransferFunction given = TransferFunction(std::move(points)).withUnit(transfer.unit());
  if (withGradientOpacity(given, ramp) != transfer) return std::nullopt;
  return given;
}

}  // namespace umbrick
