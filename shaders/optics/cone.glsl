// The occlusion cone: directions within `aperture` of its axis. Also compiled as C++ by src/optics/medium.cpp.
// Angles in radians, aperture in (0, pi/2). Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x
// SPDX-License-Identifier: Apache-2.0

// Solid angle of the cone, sr. Written with the half angle, since 1 - cos(aperture) would cancel for a narrow cone.
float coneSolidAngle(float aperture) {
  float s = sin(0.5f * aperture);
  return 4.0f * 3.14159265f * s * s;
}

// Uniform phase function on the cone, in 1/sr: one over the cone's solid angle inside, zero outside.
float conePhase(float cosAngle, float aperture) {
  return cosAngle >= cos(aperture) ? 1.0f / coneSolidAngle(aperture) : 0.0f;
}

// Radius of the cone's footprint at a distance along its axis, world units. Eq. 11.
float coneRadius(float ds, float aperture) { return ds * tan(aperture); }
