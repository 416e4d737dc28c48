// The maths of light in a medium that CPU and GPU share: the text of these functions is in shaders/optics.
// sigma_t in 1/world unit, lengths in world units, angles in radians.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {

/// Returns (1 - exp(-x)) / x, and 1 at x = 0; the relative error is below 1e-6 for x >= 0.
float slabFactor(float x);
/// Returns 1 - exp(-x) without cancellation; the relative error is below 1e-6 for x >= 0.
float oneMinusExp(float x);
/// Returns where in a segment of constant medium and of this optical depth the mean of what is seen of it lies, as a
/// share of its length from the front. It is off by less than 2e-6.
float placeSeen(float tau);
/// Returns the mean place, as a share from the front, of what a piece of linear extinction and constant albedo scatters
/// to the eye. It is off by less than 0.009. @param alpha  opacity: oneMinusExp(tau)
float scatteringCentroid(float sigma_front, float sigma_back, float tau, float alpha);

}  // namespace umbrick
