// Takes the light of some directions through one slice. There is one invocation for each texel of the lattice, in the
// tiles where something is seen or occludes. A path crosses a slice in one texel, so no two invocations share a path.
// Reads   extinction  optical depth of slabs along the view axis, one layer per slice of the run
// Writes  windows     behind the slice instead of in front of it, see light_windows.glsl
//         visibility  in front of the slice; kColoured 0: r the share of light that arrives, g that share with each
//                     direction weighted by 1 / (1 + 1/cos); kColoured 1: rgb the light that arrives, a as g. All of
//                     them are multiplied by the weight
//         weights     how much of a texel the eye sees, which the window of the view axis tells. Interpolation of both
//                     leaves out texels that are hidden in a medium, as with colours premultiplied by opacity
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_windows.glsl"
layout(local_size_x = kLatticeTile, local_size_y = kLatticeTile) in;
layout(binding = kExtinctionUnit) uniform sampler2DArray extinction;
layout(binding = kVisibilityImage, rg32f) coherent uniform image2DArray share_visibility;
layout(binding = kVisibilityImage, rgba32f) coherent uniform image2DArray coloured_visibility;
layout(binding = kVisibilityWeightImage, r32f) coherent uniform image2DArray weights;
layout(std430, binding = kTilesBuffer) readonly buffer Tiles { uint tiles[]; };
const float kLeastWeight = 1e-3;  // where the eye sees nothing of all four texels, all count alike
uniform int first_tile;              // of the tiles of the slice
uniform int tile_count;
uniform int layer;                   // layer of the slice
uniform vec4 view_window;            // window of the view axis
uniform vec2 view_path;              // view axis: window's minus lattice's texel
uniform vec4 window[kDirections];
uniform vec4 path[kDirections];      // xy: as view_path; z: 1/cos(angle to the view axis); w: 1 / (1 + z)
uniform vec4 radiance[kDirections];  // rgb; a: share of the light
uniform int direction_count;
uniform int first_layer;             // layer of the window of the first of these directions
uniform int add;                     // 1: add to what other directions have brought

// Dims the path through texel u of a window by a slab of optical depth tau. Returns what arrives in front of the slab.
float carryPath(vec2 u, vec4 of_path, int path_layer, float tau) {
  // Nothing has touched the paths outside of a window, or nothing will read them.
  if (!isInWindow(u, of_path)) return 1.0;
  ivec3 texel = windowTexel(u, of_path, path_layer);
  float arrives = loadWindow(texel);
  storeWindow(texel, arrives * exp(-tau));
  return arrives;
}

// Returns what the directions bring to lattice texel x, and dims them by a slab of optical depth tau (view axis).
vec4 carryDirections(ivec2 x, float tau) {
  vec4 sum = vec4(0.0);
  for (int k = 0; k < direction_count; ++k) {
    float arrives = carryPath(vec2(x) + path[k].xy, window[k], first_layer + k, tau * path[k].z);
    if (kColoured != 0)
      sum += arrives * vec4(radiance[k].rgb, radiance[k].a * path[k].w);
    else
      sum.rg += arrives * radiance[k].a * vec2(1.0, path[k].w);
  }
  return sum;
}

void storeVisibility(ivec3 place, vec4 sum) {
  if (kColoured != 0)
    imageStore(coloured_visibility, place, add != 0 ? sum + imageLoad(coloured_visibility, place) : sum);
  else
    imageStore(share_visibility, place, add != 0 ? sum + imageLoad(share_visibility, place) : sum);
}

void main() {
  int group = int(gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (group >= tile_count) return;
  uint tile = tiles[first_tile + group];
  ivec2 tile_place = ivec2(tile & ((1u << kTileRowShift) - 1u), tile >> kTileRowShift);
  ivec2 x = tile_place * kLatticeTile + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(x, textureSize(extinction, 0).xy))) return;
  ivec3 place = ivec3(x, layer);
  float tau = texelFetch(extinction, place, 0).r;
  float weight;
  if (add != 0) {
    weight = imageLoad(weights, place).r;
  } else {
    weight = max(carryPath(vec2(x) + view_path, view_window, kViewLayer, tau), kLeastWeight);
    imageStore(weights, place, vec4(weight));
  }
  storeVisibility(place, weight * carryDirections(x, tau));
}
