// Takes the light of some directions through one slice: one invocation per texel of the lattice, in the tiles where
// something is seen or occludes. A path crosses a slice in one texel, so that no two invocations share one.
// Reads   extinction  optical depth of slabs along the view axis, one layer per slice of the run
// The first of all directions is the view axis, which brings no light.
// Writes  windows     behind the slice instead of in front of it, see light_windows.glsl
//         visibility  in front of the slice; kColoured 0: r the share of light that arrives, g that share with each
//                     direction weighted by 1 / (1 + 1/cos); kColoured 1: rgb the light that arrives, a as g; all times
//         weights     how much of a texel the eye sees. Interpolation between what is times this and this itself leaves
//                     out texels that are hidden in a medium, as with colours that are premultiplied by opacity
#include "shade/light_windows.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 5) uniform sampler2DArray extinction;
layout(binding = 1, rg32f) coherent uniform image2DArray share_visibility;
layout(binding = 1, rgba32f) coherent uniform image2DArray coloured_visibility;
layout(binding = 2, r32f) coherent uniform image2DArray weights;
const float kLeastWeight = 1e-3;  // where nothing is seen of all four texels, all count alike
layout(std430, binding = 0) readonly buffer Tiles { uint tiles[]; };  // x + 65536 y
uniform int first_tile;              // of the slice
uniform int tile_count;
uniform int layer;                   // of the slice
uniform vec4 path[kDirections];      // xy: window's minus lattice's texel; z: 1/cos(angle to the view axis); w: 1 / (1 + z)
uniform vec4 radiance[kDirections];  // rgb; a: share of the light
uniform int direction_count;
uniform int add;                     // 1: to what other directions have brought

void main() {
  int group = int(gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (group >= tile_count) return;
  uint tile = tiles[first_tile + group];
  ivec2 x = ivec2(tile & 0xffffu, tile >> 16) * 8 + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(x, textureSize(extinction, 0).xy))) return;
  float tau = texelFetch(extinction, ivec3(x, layer), 0).r;
  vec4 sum = vec4(0.0);
  float weight = add != 0 ? imageLoad(weights, ivec3(x, layer)).r : 1.0;
  for (int k = 0; k < direction_count; ++k) {
    vec2 u = vec2(x) + path[k].xy;
    float seen = 1.0;
    // Nothing has touched the paths outside of a window, or nothing will read them.
    if (all(greaterThanEqual(u, vec2(0.0))) && all(lessThan(u, window[k].xy))) {
      ivec3 texel = windowTexel(u, k);
      seen = loadWindow(texel);
      storeWindow(texel, seen * exp(-tau * path[k].z));
    }
    if (k == 0 && add == 0) weight = max(seen, kLeastWeight);
    if (kColoured != 0)
      sum += seen * vec4(radiance[k].rgb, radiance[k].a * path[k].w);
    else
      sum.rg += seen * radiance[k].a * vec2(1.0, path[k].w);
  }
  sum *= weight;
  if (add == 0) imageStore(weights, ivec3(x, layer), vec4(weight));
  if (kColoured != 0) {
    if (add != 0) sum += imageLoad(coloured_visibility, ivec3(x, layer));
    imageStore(coloured_visibility, ivec3(x, layer), sum);
  } else {
    if (add != 0) sum += imageLoad(share_visibility, ivec3(x, layer));
    imageStore(share_visibility, ivec3(x, layer), sum);
  }
}
