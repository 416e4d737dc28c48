// What Phong's model makes of the scene's lights at a point with a normal.
// SPDX-License-Identifier: Apache-2.0
#include "optics/phong.glsl"
uniform vec4 phong;  // shares that are ambient, diffuse and specular; shininess
uniform vec3 light_towards[kShadingLights > 0 ? kShadingLights : 1];   // unit vectors of the world
uniform vec3 light_radiance[kShadingLights > 0 ? kShadingLights : 1];
uniform vec3 view_right;     // the camera's axes in the world
uniform vec3 view_up;
uniform vec3 view_forward;
uniform vec3 gradient_to_world[3];  // columns of the matrix that takes gradients of index space there

// Returns the direction towards the eye in the world. @param p  screen point of the ray
vec3 viewerOf(vec2 p) {
  return kPerspective != 0 ? -normalize(view_forward + p.x * view_right + p.y * view_up) : -view_forward;
}

// Returns the normal on the viewer's side. Where the value has no gradient it faces the viewer.
vec3 normalOf(vec3 gradient, vec3 viewer) {
  vec3 rise = gradient.x * gradient_to_world[0] + gradient.y * gradient_to_world[1] + gradient.z * gradient_to_world[2];
  float size = max(abs(rise.x), max(abs(rise.y), abs(rise.z)));
  if (!(size > 0.0)) return viewer;
  vec3 normal = normalize(rise / size);
  return dot(normal, viewer) < 0.0 ? -normal : normal;
}

// What comes from one light: x is scattered, and y mirrored.
vec2 reflectedShares(vec3 normal, vec3 viewer, vec3 towards) {
  float normal_light = dot(normal, towards);
  return phong.yz * vec2(phongDiffuse(normal_light), phongSpecular(normal_light, dot(normal, viewer),
                                                                   dot(towards, viewer), phong.w));
}

// Returns what a surface of a colour sends to the viewer. @param arriving  share of the light that reaches it
vec3 reflectedBy(vec3 colour, vec3 normal, vec3 viewer, vec3 arriving) {
  vec3 sum = vec3(0.0);
  if (kShadingLights == 0) {
    vec2 shares = reflectedShares(normal, viewer, viewer);
    sum = shares.x * colour + shares.y;
  }
  for (int i = 0; i < kShadingLights; ++i) {
    vec2 shares = reflectedShares(normal, viewer, light_towards[i]);
    sum += light_radiance[i] * (shares.x * colour + shares.y);
  }
  return phong.x * colour + arriving * sum;
}
