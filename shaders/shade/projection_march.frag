// Takes the view ray of a pixel through the bricks of one run, from slice to slice of voxels along its main axis, and
// finds the largest or the smallest value, or sums them up. Places are counted from a voxel, so that the cells of the
// table hold the spaces between voxels.
//   kProjection 0  the largest   1  the smallest, as the largest of what has the other sign   2  the sum
// Reads   atlas, more_atlas   slots (see brick_walk.glsl)
//         bounds  R32F, by cell: no value in it is beyond this, in codes; kProjection 1: with the other sign
// Writes  found   r: the extreme in codes; or the sum of what codes are above empty space, each times the way it stands
//         for, voxels along the main axis
//         g: samples that were taken   b: those that lie in cells of the run, both ends included
//         a: those of the ray; of sums the way in all; 0 where the ray meets no voxel
// SPDX-License-Identifier: Apache-2.0
#include "shade/brick_walk.glsl"
#include "shade/voxel_fetch.glsl"
layout(binding = kBoundsUnit) uniform sampler3D bounds;
uniform vec3 box_low;   // voxels between which rays are taken
uniform vec3 box_high;
layout(location = 0) out vec4 found;

const float kNone = -3e38;

// The values that are looked for are the largest.
float signedCode(float code) { return kProjection == 1 ? -code : code; }

// A ray as brick_walk.glsl takes it, whose segments are slices: slice k is where the place along the main axis is
// k * towards / kPerVoxel.
struct SliceRay {
  Ray ray;
  ivec3 main, u, v;       // unit vectors of the axes
  float low, high;        // the part that counts, voxels along the main axis, ascending along the ray
  float first, last;      // slices in it
};

// A ray that is still across the slices goes through the same voxels on all of them, where it is as near to them as
// single precision tells.
void settle(inout Ray ray) {
  const float kStill = 1e-6, kOnVoxels = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(ray.step[axis]) > kStill) continue;
    float nearest = round(ray.at[axis]);
    ray.step[axis] = 0.0;
    if (abs(ray.at[axis] - nearest) < kOnVoxels) ray.at[axis] = nearest;
  }
}

SliceRay slicesOf(Ray ray) {
  SliceRay slices;
  vec3 along = abs(ray.step);
  slices.main = along.z >= max(along.x, along.y) ? ivec3(0, 0, 1)
                : along.y >= along.x             ? ivec3(0, 1, 0)
                                                 : ivec3(1, 0, 0);
  slices.u = slices.main.x == 1 ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
  slices.v = slices.main.z == 1 ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
  vec3 main = vec3(slices.main);
  float speed = dot(ray.step, main), from = dot(ray.at, main), towards = sign(speed), per = float(kPerVoxel);
  vec2 seen = between(ray, medium_low, medium_high);
  seen = vec2(max(ray.kept.x, seen.x), min(ray.kept.y, seen.y));
  vec2 faces = towards * vec2(dot(box_low, main), dot(box_high, main));
  faces = vec2(min(faces.x, faces.y), max(faces.x, faces.y));
  slices.low = clamp(towards * from + abs(speed) * seen.x, faces.x, faces.y);
  slices.high = clamp(towards * from + abs(speed) * seen.y, faces.x, faces.y);
  if (!(seen.x <= seen.y)) slices.high = slices.low - 1.0;  // it meets no voxel
  const float kRounding = 1e-4;
  slices.first = ceil(slices.low * per - kRounding);
  slices.last = floor(slices.high * per + kRounding);
  slices.ray = ray;
  slices.ray.step = mix(ray.step / abs(speed), vec3(towards), main);
  slices.ray.at = mix(ray.at - ray.step * (from / speed), vec3(0.0), main);
  settle(slices.ray);
  slices.ray.step /= per;
  slices.ray.per_step = 1.0 / mix(slices.ray.step, vec3(1e-20), lessThan(abs(slices.ray.step), vec3(1e-20)));
  return slices;
}

vec3 placeOf(SliceRay slices, float slice) { return slices.ray.at + slice * slices.ray.step; }

// Returns the value at an end of the ray, where it lies in a cell of the run.
// @param least  values up to this are not asked for
float codeAtEnd(vec3 place, float least, out bool mine) {
  place = clamp(place, box_low, box_high);
  vec3 cell = floor(place / part);
  ivec3 at = ivec3(cell) - first_cell;
  mine = !any(lessThan(at, ivec3(0))) && all(lessThan(at, textureSize(slots, 0)));
  if (!mine) return kNone;
  uvec4 slot = texelFetch(slots, at, 0);
  mine = slot.w != 0u;
  if (!mine || (kProjection != 2 && texelFetch(bounds, at, 0).r <= least)) return kNone;
  vec3 voxel = floor(place);
  ivec3 texel = ivec3(slot.xyz) + apron + ivec3(voxel - cell * part);
  return signedCode(codeBetween(texel, int(slot.w & uint(kWholeBrick - 1)) - 1, place - voxel));
}

// The way that a slice stands for by the trapezoidal rule: half of that to each neighbour, or to the ray's end.
float wayOf(SliceRay slices, float slice) {
  float at = slice / float(kPerVoxel), reach = 1.0 / float(kPerVoxel);
  return 0.5 * max(min(at + reach, slices.high) - max(at - reach, slices.low), 0.0);
}

void main() {
  SliceRay slices = slicesOf(rayThrough(gl_FragCoord.xy));
  bool sums = kProjection == 2;
  found = vec4(sums ? 0.0 : kNone, 0.0, 0.0, 0.0);
  if (slices.high < slices.low) return;
  vec2 run = between(slices.ray, vec3(first_cell) * part, vec3(first_cell + textureSize(slots, 0)) * part);
  float k = max(slices.first, ceil(run.x) - 1.0), last = min(slices.last, floor(run.y) + 1.0);
  float best = sums ? 0.0 : kNone, samples = 0.0, covered = 0.0;
  while (k <= last) {
    uvec4 slot = slotOf(slices.ray, k);
    bool empty = slot.w == 0u;
    vec3 cell = cellOf(slices.ray, k), corner = cell * part;
    float until = min(empty ? skips(slices.ray, k, float(slot.x)) : leaves(slices.ray, k, corner, part), last + 1.0);
    if (!empty) covered += until - k;
    if (empty || (!sums && texelFetch(bounds, ivec3(cell) - first_cell, 0).r <= best)) k = until;
    int number = int(slot.w & uint(kWholeBrick - 1)) - 1;
    ivec3 texel = ivec3(slot.xyz) + apron - ivec3(corner);
    while (k < until) {
      vec3 place = placeOf(slices, k), voxel = floor(place), share = place - voxel;
      ivec3 at = texel + ivec3(voxel);
      float code = signedCode(kPerVoxel == 1 ? codeOnPlane(at, number, slices.u, slices.v,
                                                           vec2(dot(share, vec3(slices.u)), dot(share, vec3(slices.v))))
                                             : codeBetween(at, number, share));
      if (sums)
        best += wayOf(slices, k) * (code - empty_code.y);
      else
        best = max(best, code);
      samples += 1.0;
      k += 1.0;
    }
  }
  float way = slices.high - slices.low, per = float(kPerVoxel);
  bool first_is_mine, last_is_mine;
  vec3 first_place = placeOf(slices, slices.low * per), last_place = placeOf(slices, slices.high * per);
  if (sums) {
    const float kShort = 1e-5;  // voxels: of such a way the value is that of its begin
    float first = codeAtEnd(first_place, kNone, first_is_mine), end = codeAtEnd(last_place, kNone, last_is_mine);
    first = first_is_mine ? first - empty_code.y : 0.0;
    end = last_is_mine ? end - empty_code.y : 0.0;
    bool met = slices.first <= slices.last;
    float to_first = met ? slices.first / per - slices.low : way, from_last = met ? slices.high - slices.last / per : way;
    if (way < kShort)
      best = first;
    else
      best += 0.5 * (max(to_first, 0.0) * first + max(from_last, 0.0) * end);
    found = vec4(best, samples, 0.0, way < kShort ? 1.0 : way);
    return;
  }
  best = max(best, codeAtEnd(first_place, best, first_is_mine));
  best = max(best, codeAtEnd(last_place, best, last_is_mine));
  covered += float(first_is_mine) + float(last_is_mine);
  found = vec4(best, samples, covered, max(slices.last - slices.first + 1.0, 0.0) + 2.0);
}
