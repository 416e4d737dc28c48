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
  vec4 medium = slabMedium(middle + kept.x * half_step, middle + kept.y * half_step);
  float ray = rayStretch(p) * half_spacing * (kept.y - kept.x);  // world length of the ray in the slab
  float tau = medium.a * ray;
  float factor = slabFactor(tau);
  Slab slab;
  slab.light = vec4(medium.rgb, medium.a) * (ray * factor);
  slab.sigma_t = medium.a;
  slab.share = 0.5 * (kept.y - kept.x);
  return slab;
}
