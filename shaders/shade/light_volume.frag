// Draws the part of one proxy slice that lies in one brick, lit by what reaches its voxels. Within a slab light is read
// once a segment, at its middle.
// Reads   atlas, transfer (see medium.glsl)   light  share of whole_light that reaches a voxel
// Writes  eye  premultiplied RGBA, blended under: (ONE_MINUS_DST_ALPHA, ONE)
//         aux  kAux: opacity-weighted visibility and depth, blended alike
// SPDX-License-Identifier: Apache-2.0
#include "optics/slab.glsl"
#include "optics/ramp.glsl"
#include "shade/ray.glsl"
#include "shade/clip.glsl"
#include "shade/medium.glsl"
layout(binding = kLightUnit) uniform sampler3D light;
uniform vec3 whole_light;  // light that arrives where nothing is in the way
uniform float brightest;   // light of this radiance is 1 in the eye buffer
flat in vec4 slab_centre;
layout(location = 0) out vec4 eye;
layout(location = 1) out vec4 aux;

// Returns the light that arrives at a point as shares of whole_light, in rgb, and by power in a.
vec4 arrivingAt(vec3 point) {
  vec4 texel = textureLod(light, point, 0.0);
  return kColoured != 0 ? vec4(texel.rgb, dot(texel.rgb, whole_light) / dot(whole_light, vec3(1.0))) : texel.rrrr;
}

void main() {
  vec2 p = screenPoint();
  if (kStack == 2 && !liesInStack(p)) discard;
  vec3 half_step = slabHalf(p);
  vec2 kept = vec2(-1.0, 1.0);
  if (kClipPlanes > 0) {
    kept = keptInterval(p, viewDepth(slab_centre, p), halfDepth(p));
    kept.y = max(kept.x, kept.y);
  }
  float thickness = kept.y - kept.x;
  float ray = rayStretch(p) * halfDepth(p) * thickness / float(kSegments);  // world length of a segment
  vec3 segment = half_step * (thickness / float(kSegments));
  vec3 front = slabMiddle(slab_centre, p) + kept.x * half_step;
  vec4 sum = vec4(0.0);
  float seen = 0.0;  // visibility, weighted by opacity
  vec3 glow = vec3(0.0);
  End front_end = endAt(front);
  for (int i = 0; i < kSegments; ++i) {
    Slab piece = emptySlab();
    vec3 middle = front + (float(i) + 0.5) * segment;
    if (kQuadrature == 1 || kQuadrature == 3) {
      addMiddle(piece, endAt(middle), ray);
    } else {
      End back_end = endAt(front + float(i + 1) * segment);
      addSegment(piece, front_end, back_end, ray);
      front_end = back_end;
    }
    vec4 arriving = arrivingAt(middle);
    float through = 1.0 - sum.a;
    sum += through * vec4(piece.eye.rgb * arriving.rgb, piece.eye.a);
    seen += through * piece.eye.a * arriving.a;
    glow += through * piece.emitted;
  }
  eye = vec4(withEmission(sum.rgb * whole_light / brightest, glow), sum.a);
  if (kAux != 0) aux = vec4(seen, eye.a * viewDepth(slab_centre, p), 0.0, eye.a);
}
