// The way back from withGradientOpacity() of umbrick/scene/resolve.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <optional>

#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// Returns the 1D function of which withGradientOpacity() makes this one; none where there is no such function.
std::optional<TransferFunction> withoutGradientOpacity(const TransferFunction& transfer, const glm::dvec2& ramp);

}  // namespace umbrick
