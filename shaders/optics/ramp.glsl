// A piece of a ray on which extinction runs linearly. Also compiled as C++ by src/optics/medium.cpp.
// sigma_t in 1/world unit, optical depths without unit. Needs log, max and sqrt.
// SPDX-License-Identifier: Apache-2.0

// Where the light comes from that a piece of constant albedo scatters to the eye: the mean place, as a share of the piece
// counted from its front, weighted by extinction and by what the piece itself lets through. Since albedo is linear
// on a piece as well, the piece scatters the albedo at that place times its opacity. sigma_front and sigma_back are the
// extinctions at its ends, tau its optical depth and alpha its opacity.
// The weight is the growth of opacity, so the mean is taken over equal shares of the opacity, by the three nodes of Gauss and
// Legendre: share w of it is reached at the optical depth -ln(1 - w alpha), and that at the place where the quadratic
// function that optical depth is has this value. Off by less than 0.009 for any tau.
float scatteringCentroid(float sigma_front, float sigma_back, float tau, float alpha) {
  const float w1 = 0.11270167f, w3 = 0.88729833f;
  float sum = sigma_front + sigma_back;
  float front = sum > 0.0f ? sigma_front / sum : 0.5f;
  float curve = 1.0f - 2.0f * front;
  // Shares of tau; where it is small the logarithm is its argument.
  float thin = 1.0f / max(tau, 1e-3f);
  float r1 = tau > 1e-3f ? -log(1.0f - w1 * alpha) * thin : w1;
  float r2 = tau > 1e-3f ? -log(1.0f - 0.5f * alpha) * thin : 0.5f;
  float r3 = tau > 1e-3f ? -log(1.0f - w3 * alpha) * thin : w3;
  float x1 = r1 / max(front + sqrt(max(front * front + curve * r1, 0.0f)), 1e-30f);
  float x2 = r2 / max(front + sqrt(max(front * front + curve * r2, 0.0f)), 1e-30f);
  float x3 = r3 / max(front + sqrt(max(front * front + curve * r3, 0.0f)), 1e-30f);
  return (5.0f * (x1 + x3) + 8.0f * x2) * (1.0f / 18.0f);
}
