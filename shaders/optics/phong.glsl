// What a surface reflects of one directional light, by Phong's model. Also compiled as C++ by src/optics/phong.cpp.
// Cosines are between unit vectors. Needs max and pow.
// Phong 1975, doi:10.1145/360825.360839
// SPDX-License-Identifier: Apache-2.0

// Share that is scattered to all sides.
float phongDiffuse(float normal_light) { return max(normal_light, 0.0f); }

// Share that is mirrored to the viewer. The mirrored light is R = 2 (N.L) N - L, so that R.V follows from three
// cosines. A light behind the surface is not mirrored.
float phongSpecular(float normal_light, float normal_viewer, float light_viewer, float shininess) {
  float mirrored = 2.0f * normal_light * normal_viewer - light_viewer;
  return normal_light > 0.0f && mirrored > 0.0f ? pow(mirrored, shininess) : 0.0f;
}
