// What a slab of constant medium lets through and scatters. Also compiled as C++ by src/optics/medium.cpp.
// sigma_t in 1/world unit, lengths in world units.
// SPDX-License-Identifier: Apache-2.0

// (1 - exp(-x)) / x for x >= 0, 1 at x = 0: the mean transmittance over a segment of optical depth x, so a slab scatters
// sigma_s ds slabFactor(sigma_t ds). The difference would cancel for a small x: there it is the Taylor series, whose
// first term left out is below 2e-7 of the result at 0.5. Relative error below 1e-6 for every x.
float slabFactor(float x) {
  float series = 1.0f + x * (-1.0f / 2.0f + x * (1.0f / 6.0f + x * (-1.0f / 24.0f + x * (1.0f / 120.0f +
                 x * (-1.0f / 720.0f + x * (1.0f / 5040.0f))))));
  return x < 0.5f ? series : (1.0f - exp(-x)) / x;
}

// 1 - exp(-x) for x >= 0, the opacity of optical depth x, without cancellation: relative error below 1e-6.
float oneMinusExp(float x) { return x < 0.5f ? x * slabFactor(x) : 1.0f - exp(-x); }

// Where in a segment of constant medium the mean of what is seen of it lies, as a share of its length from the front:
// 1/tau - 1/(exp(tau) - 1), below 1 as a series, since the difference would cancel. Off by less than 2e-6.
float placeSeen(float tau) {
  float square = tau * tau;
  float series = 0.5f - tau * (1.0f / 12.0f - square * (1.0f / 720.0f - square * (1.0f / 30240.0f)));
  return tau < 1.0f ? series : 1.0f / tau - (tau < 60.0f ? 1.0f / (exp(tau) - 1.0f) : 0.0f);
}
