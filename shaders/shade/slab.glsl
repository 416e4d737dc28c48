// What one fragment finds in its slab.
#include "optics/slab.glsl"
#include "shade/ray.glsl"
#include "shade/clip.glsl"
#include "shade/medium.glsl"

struct Slab {
  vec4 light;     // what an unoccluded slab scatters to the eye, premultiplied by its opacity, and that opacity
  float sigma_t;  // mean extinction, 1/world unit
  float share;    // of the slab's thickness that clip planes leave
};

Slab evaluateSlab(vec4 slab_centre) {
  vec2 p = screenPoint();
  vec3 middle = slabMiddle(slab_centre, p);
  vec3 half_step = slabHalf(p);
  vec2 kept = vec2(-1.0, 1.0);
  if (kClipPlanes > 0) {
    kept = keptInterval(p, slab_centre.w);
    kept.y = max(kept.x, kept.y);
  }
  float thickness = kept.y - kept.x;
  float ray = rayStretch(p) * half_spacing * thickness / float(kSegments);  // world length of a segment
  vec3 segment = half_step * (thickness / float(kSegments));
  vec3 front = middle + kept.x * half_step;
  float front_end = kQuadrature == 0 ? endCoordinate(front) : 0.0;
  Slab slab = Slab(vec4(0.0), 0.0, 0.5 * thickness);
  for (int i = 0; i < kSegments; ++i) {
    vec4 medium;
    if (kQuadrature == 0) {
      float back_end = endCoordinate(front + float(i + 1) * segment);
      medium = rampMedium(front_end, back_end);
      front_end = back_end;
    } else {
      medium = pointMedium(front + (float(i) + 0.5) * segment);
    }
    slab.light += (1.0 - slab.light.a) * medium * (ray * slabFactor(medium.a * ray));
    slab.sigma_t += medium.a * (1.0 / float(kSegments));
  }
  return slab;
}
