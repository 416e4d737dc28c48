// Segments of rays: the ends of one are shared with its neighbours, so that a value is read once where slices read it
// twice.
// SPDX-License-Identifier: Apache-2.0
#include "shade/brick_walk.glsl"
#include "shade/medium.glsl"
#include "shade/voxel_fetch.glsl"
uniform vec3 inverse_size;       // of the atlas's textures

vec3 texelAt(vec3 point, int number) {
  vec3 texel = textureLod(atlas, point, 0.0).rgb;
  for (int i = 1; i < kTextures; ++i)
    if (number == i) texel = textureLod(more_atlas[i - 1], point, 0.0).rgb;
  return texel;
}

// Where a ray runs in the atlas while it crosses a cell.
struct Course {
  vec3 at, step;   // atlas coordinates, as those of the ray
  vec3 to_texels;  // from places
  int number;      // of the texture
  End end;         // where the next segment begins
};

Course courseOf(Ray ray, Crossing crossing, float front) {
  Course course;
  course.to_texels = crossing.to_texels + float(apron);
  course.at = (ray.at + course.to_texels) * inverse_size;
  course.step = ray.step * inverse_size;
  course.number = crossing.number;
  if (kQuadrature == 0 || kQuadrature == 2) course.end = endOf(texelAt(course.at + front * course.step, course.number));
  return course;
}

// Tells whether a segment between two values may hold any medium, or emit something. Most segments of most volumes hold none.
bool shows(End front, End back) {
  if (kEmission != 0 || kQuadrature > 1 || front.stretch.x != back.stretch.x) return true;
  vec4 ends = stretchAt(front.stretch.x).ends;
  return max(ends.b, ends.a) > 0.0;
}

// Integrates the next segment, of length `ray`, world units. @return whether it may hold anything
bool takeSegment(inout Course course, float front, float back, float ray, out Slab piece) {
  const bool midpoint = kQuadrature == 1 || kQuadrature == 3;
  End end = endOf(texelAt(course.at + (midpoint ? 0.5 * (front + back) : back) * course.step, course.number));
  if (midpoint) course.end = end;
  piece = emptySlab();
  bool shown = shows(course.end, end);
  if (shown) {
    if (midpoint)
      addMiddle(piece, end, ray);
    else
      addSegment(piece, course.end, end, ray);
  }
  course.end = end;
  return shown;
}
