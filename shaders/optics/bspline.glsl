// The uniform cubic B-spline between two knots. Also compiled as C++ by src/optics/bspline.cpp. Needs vec4.
// Knots are at whole numbers, and t in [0, 1] is the place behind one of them: the weights are those of the
// coefficients of the knots at -1, 0, 1 and 2 from it.
// Sigg and Hadwiger 2005, "Fast Third-Order Texture Filtering", GPU Gems 2, chapter 20
// SPDX-License-Identifier: Apache-2.0

vec4 bsplineWeights(float t) {
  float s = 1.0f - t;
  return vec4(s * s * s, 4.0f + 3.0f * t * t * (t - 2.0f), 4.0f + 3.0f * s * s * (s - 2.0f), t * t * t) / 6.0f;
}

// Weights for the slope of the spline, per knot distance. Their sum is 0.
vec4 bsplineSlopes(float t) {
  float s = 1.0f - t;
  return 0.5f * vec4(-s * s, t * (3.0f * t - 4.0f), s * (4.0f - 3.0f * s), t * t);
}
