// Takes the view ray of a pixel through the bricks of one run, from cell to cell of voxels, and composites the surfaces
// of single values that it crosses, nearest first. Places are counted from a voxel, so that the cells of the table hold
// the spaces between voxels. A voxel is inside of a surface where its value is larger. All crossings of the cubic in a
// cell are found, so that no feature is lost, however thin.
// Reads   atlas, more_atlas   slots (see brick_walk.glsl)
//         light, more_light  kLit: see light_share.glsl
// Writes  eye      premultiplied RGBA, blended under what is nearer: (ONE_MINUS_DST_ALPHA, ONE)
//         count    number of cells that were looked at, added
//         depth_sum, normal, nearest  kAux, blended as eye:
//           depth_sum  r: places along the ray, weighted by opacity; g: shares of the light that arrive, the same
//           normal     of the nearest surface, in the world, on the viewer's side
//           nearest    r: its place along the ray, in segments; g: its number
// Source of the walk: Amanatides and Woo 1987, doi:10.2312/egtp.19871000
// SPDX-License-Identifier: Apache-2.0
#include "shade/brick_walk.glsl"
#include "shade/cell_cubic.glsl"
#include "shade/light_share.glsl"
#include "shade/phong_lights.glsl"
#include "shade/voxel_gradient.glsl"
uniform vec4 surfaces[kSurfaces];       // colour and opacity
uniform vec4 surface_codes[kSurfaces];  // x: value of a surface, in codes above base_code
uniform float base_code;                // the least of them
uniform float highest;                  // the largest, above base_code
uniform vec3 ambient_light;
uniform vec3 world_to_index[3];         // columns of the matrix that takes directions there
uniform float light_distance;           // in front of a surface, where its light is taken: see scene/surface_light.h
uniform vec3 inverse_size;              // of the atlas's textures
uniform float saturation;               // transmittance below which a ray ends
uniform float place_shift;              // from places of this run to those of the picture, segments
layout(location = 0) out vec4 eye;
layout(location = 1) out float count;
layout(location = 2) out vec4 depth_sum;
layout(location = 3) out vec4 normal;
layout(location = 4) out vec4 nearest;

// What is known of the ray so far.
vec4 sum = vec4(0.0);
vec2 seen = vec2(0.0);  // places and arriving light, weighted by opacity
vec4 first_normal = vec4(0.0), first_place = vec4(0.0);
vec3 viewer = vec3(0.0);
int above = 0;      // bit k: the ray is above surface k
bool known = false;  // whether that is known
float reached = -1e30;  // up to where

// Returns the share of the light that reaches a point of a surface. Beyond planes that cut the medium there is more
// light than arrives.
vec4 arrivingAtSurface(vec3 texel, int number, vec3 facing) {
  vec3 way = facing.x * world_to_index[0] + facing.y * world_to_index[1] + facing.z * world_to_index[2];
  vec3 size = abs(way);
  way *= light_distance / max(size.x, max(size.y, size.z));
  return min(arrivingAt((texel + way + 0.5) * inverse_size, number), 1.0);
}

// Adds a crossing. @return whether the ray goes on
bool tell(ivec3 texel, int number, vec3 share, float place, int surface) {
  share = clamp(share, 0.0, 1.0);
  vec3 facing = normalOf(differencesBetween(texel, number, share), viewer);
  vec3 colour = surfaces[surface].rgb;
  float part_of = (1.0 - sum.a) * surfaces[surface].a;
  vec4 arriving = vec4(1.0);
  if (kLit != 0) arriving = arrivingAtSurface(vec3(texel) + share, number, facing);
  if (kShaded != 0)
    colour = reflectedBy(colour, facing, viewer, arriving.rgb);
  else if (kLit != 0)
    colour *= arriving.rgb * whole_light;
  if (sum.a == 0.0 && part_of > 0.0) {
    first_normal = vec4(facing, 1.0);
    first_place = vec4(place + place_shift, float(surface), 0.0, 1.0);
  }
  sum += part_of * vec4(ambient_light * colour, 1.0);
  seen += part_of * vec2(place + place_shift, arriving.a);
  return sum.a < 1.0 - saturation;
}

// Adds the surfaces of which the ray, where it comes to a cell, is on another side than it was: rounding has put the
// crossing between two cells. @return whether the ray goes on
bool tellChanged(int sides, ivec3 texel, int number, vec3 share, float place) {
  int changed = sides ^ above;
  above = sides;
  for (int k = 0; k < kSurfaces; ++k)
    if ((changed >> k & 1) != 0 && !tell(texel, number, share, place, k)) return false;
  return true;
}

CellCorners cornersAt(ivec3 texel, int number) {
  const ivec3 x = ivec3(1, 0, 0), y = ivec3(0, 1, 0), z = ivec3(0, 0, 1);
  CellCorners corners;
  corners.low = vec4(codeAt(texel, number), codeAt(texel + x, number), codeAt(texel + y, number),
                     codeAt(texel + x + y, number)) - base_code;
  corners.high = vec4(codeAt(texel + z, number), codeAt(texel + x + z, number), codeAt(texel + y + z, number),
                      codeAt(texel + x + y + z, number)) - base_code;
  return corners;
}

// Takes the ray through a cell. @param from, along  where it enters, from the cell's first voxel, and its way, voxels
// @param enter, leave  places along the ray   @return whether the ray goes on
bool walkCell(ivec3 texel, int number, vec3 from, vec3 along, float enter, float leave) {
  CellCorners corners = cornersAt(texel, number);
  vec4 least = min(corners.low, corners.high), most = max(corners.low, corners.high);
  float low = min(min(least.x, least.y), min(least.z, least.w)), high = max(max(most.x, most.y), max(most.z, most.w));
  bool adjacent = enter <= reached;
  float gap = adjacent ? enter : reached;  // where a side that has changed meanwhile changed
  reached = leave;
  const int kAll = (1 << kSurfaces) - 1;
  if (high <= 0.0 || low > highest) {
    int sides = low > highest ? kAll : 0;
    if (known && sides != above) return tellChanged(sides, texel, number, from, gap);
    above = sides;
    known = true;
    return true;
  }
  vec4 cubic = cubicBetween(corners, from, along);
  if (!known || !adjacent) {
    int sides = 0;
    for (int k = 0; k < kSurfaces; ++k) sides |= cubic.x > surface_codes[k].x ? 1 << k : 0;
    if (known && sides != above && !tellChanged(sides, texel, number, from, gap)) return false;
    above = sides;
    known = true;
  }
  vec2 turns = turnsOf(cubic);
  for (float s = 0.0; s <= 1.0;) {
    float next = 2.0;
    int surface = 0;
    for (int k = 0; k < kSurfaces; ++k) {
      float crossing = crossingOf(cubic, turns, surface_codes[k].x, s, (above >> k & 1) != 0);
      if (crossing < next) {
        next = crossing;
        surface = k;
      }
    }
    if (next > 1.0) return true;
    above ^= 1 << surface;
    if (!tell(texel, number, from + next * along, enter + next * (leave - enter), surface)) return false;
    s = next;
  }
  return true;
}

// Tells of the axis along which the least of three numbers is.
bvec3 leastOf(vec3 v) {
  return v.x <= v.y && v.x <= v.z ? bvec3(true, false, false)
         : v.y <= v.z             ? bvec3(false, true, false)
                                  : bvec3(false, false, true);
}
float leastIn(vec3 v) { return min(v.x, min(v.y, v.z)); }

void main() {
  Ray ray = rayThrough(gl_FragCoord.xy);
  viewer = viewerOf(gl_FragCoord.xy * screen_scale + screen_offset);
  eye = vec4(0.0);
  count = 0.0;
  depth_sum = normal = nearest = vec4(0.0);
  ivec3 size = textureSize(slots, 0), part_edge = ivec3(part);
  vec2 way = between(ray, medium_low, medium_high), run = between(ray, vec3(first_cell) * part, vec3(first_cell + size) * part);
  float place = max(max(way.x, run.x), ray.kept.x), last = min(min(way.y, run.y), ray.kept.y);
  if (!(place < last)) return;
  bvec3 rises = greaterThan(ray.per_step, vec3(0.0));
  ivec3 towards = mix(ivec3(-1), ivec3(1), rises), ahead = mix(ivec3(0), ivec3(1), rises);
  vec3 width = abs(ray.per_step);
  ivec3 box = clamp(ivec3(floor((ray.at + place * ray.step) / part)), first_cell, first_cell + size - 1);
  float cells = 0.0;
  bool goes_on = true;
  while (goes_on && place < last) {
    ivec3 at = box - first_cell;
    if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, size))) break;
    uvec4 slot = texelFetch(slots, at, 0);
    if (slot.w == 0u) {
      int around = max(int(slot.x) - 1, 0);
      ivec3 low = box - around, high = box + around;  // boxes without a surface
      vec3 faces = vec3(mix(low, high + 1, rises)) * part;
      vec3 far = (faces - ray.at) * ray.per_step;
      bvec3 through = leastOf(far);
      place = max(place, leastIn(far));
      box = mix(clamp(ivec3(floor((ray.at + place * ray.step) / part)), low, high), mix(low - 1, high + 1, rises),
                through);
      continue;
    }
    int number = int(slot.w & uint(kWholeBrick - 1)) - 1;
    ivec3 first = box * part_edge, cell = clamp(ivec3(floor(ray.at + place * ray.step)), first, first + part_edge - 1);
    ivec3 texel = ivec3(slot.xyz) + apron - first;
    vec3 next = (vec3(cell + ahead) - ray.at) * ray.per_step;
    bool inside = true;
    while (goes_on && inside && place < last) {
      float until = min(leastIn(next), last);
      if (until > place) {
        cells += 1.0;
        goes_on = walkCell(texel + cell, number, ray.at + place * ray.step - vec3(cell), (until - place) * ray.step, place,
                           until);
        place = until;
      }
      bvec3 through = leastOf(next);
      cell += mix(ivec3(0), towards, through);
      next += mix(vec3(0.0), width, through);
      ivec3 within = cell - first;
      inside = all(greaterThanEqual(within, ivec3(0))) && all(lessThan(within, part_edge));
      if (!inside) box += mix(ivec3(0), towards, through);
    }
  }
  eye = sum;
  count = cells;
  if (kAux != 0) {
    depth_sum = vec4(seen, 0.0, sum.a);
    normal = first_normal;
    nearest = first_place;
  }
}
