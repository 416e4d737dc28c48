// Tells what segments of a view ray scatter and absorb. A transfer function is linear between its control points, so a
// segment is integrated stretch by stretch (umbrick/optics/transfer_stretches.h), and no table is needed in between.
//   kQuadrature 0  1D function; the value runs linearly from the front of the segment to its back
//               1  1D function; the medium at the middle
//               2  2D function; value and gradient magnitude run linearly from front to back
//               3  2D function; the medium at the middle
// SPDX-License-Identifier: Apache-2.0
#include "optics/slab.glsl"
#include "shade/atlas.glsl"
#include "shade/glow.glsl"
// RGBA32F, one column for each stretch of the values; the last stretch is repeated up to a power of two. Ends are in
// texel units, and 1e38 stands for infinity:
//   row 0     lower end, upper end; 1D: sigma_t at the lower end and at the upper one, 1/world unit
//   1D, rows 1 and 2   albedo at the lower end and at the upper one
//   2D, row 1          lower end and upper end of the stretches of the gradients, one stretch in each column
//       from row 2     the media (albedo, sigma_t) at the four corners of each cell: columns 2 i and 2 i + 1, rows
//                      2 + 2 j and 3 + 2 j for stretch i of the values and j of the gradients
layout(binding = kTransferUnit) uniform sampler2D transfer;
uniform vec3 empty_texel;    // x: what empty space is read as; y: what rounding may add; z: what it is; texel units

// What a segment, or a part of one, sends to the eye and lets through.
struct Slab {
  vec4 eye;   // premultiplied colour for light of radiance 1, and opacity
  float tau;  // optical depth
  vec3 emitted;  // radiance of a second grid that gets out, kEmission
};

Slab emptySlab() { return Slab(vec4(0.0), 0.0, vec3(0.0)); }

void addPiece(inout Slab slab, vec3 albedo, float tau, float alpha) {
  slab.eye += (1.0 - slab.eye.a) * alpha * vec4(albedo, 1.0);
  slab.tau += tau;
}

// Puts the value of empty space right: it must be exact, as it may be the only transparent value of a solid medium.
float snapped(float value) { return abs(value - empty_texel.x) <= empty_texel.y ? empty_texel.z : value; }

// Returns the number of the stretch that a value lies in, which is the number of control points at or below the value.
// It is found by bisection of the upper ends in a row of 2^steps columns.
int stretchOf(float value, int row, int steps) {
  int number = 0;
  for (int step = 1 << (steps - 1); step > 0; step >>= 1)
    if (value >= texelFetch(transfer, ivec2(number + step - 1, row), 0).g) number += step;
  return number;
}

// Returns where a value lies between the ends of a stretch, from 0 to 1; anywhere where the ends are infinitely far.
float placeIn(vec4 ends, float value) { return clamp((value - ends.r) / max(ends.g - ends.r, 1e-37), 0.0, 1.0); }

// A stretch of a 1D function, as rows 0 to 2 hold it.
struct Stretch {
  vec4 ends, low, high;
};

// Where a function has few enough stretches, they are in uniforms too, which a software rasteriser reads several times
// as fast as a texture. Up to 24 upper ends are there once more, four in each vector, since it is faster to compare a
// value with all of them than to bisect.
uniform vec4 stretches[3 * max(kUniformStretches, 1)];
uniform vec4 few_ends[6];

Stretch stretchAt(int number) {
  if (kUniformStretches == 0)
    return Stretch(texelFetch(transfer, ivec2(number, 0), 0), texelFetch(transfer, ivec2(number, 1), 0),
                   texelFetch(transfer, ivec2(number, 2), 0));
  return Stretch(stretches[3 * number], stretches[3 * number + 1], stretches[3 * number + 2]);
}

int endsBelow(float value, vec4 ends) { return int(dot(vec4(greaterThanEqual(vec4(value), ends)), vec4(1.0))); }

int valueStretchOf(float value) {
  if (kUniformStretches == 0) return stretchOf(value, 0, kValueSteps);
  int number = 0;
  if (kUniformStretches > 25) {
    for (int step = 1 << (kValueSteps - 1); step > 0; step >>= 1)
      if (value >= stretches[3 * min(number + step - 1, kUniformStretches - 1)].g) number += step;
    return min(number, kUniformStretches - 1);
  }
  number = endsBelow(value, few_ends[0]);
  if (kUniformStretches > 5) number += endsBelow(value, few_ends[1]);
  if (kUniformStretches > 9) number += endsBelow(value, few_ends[2]);
  if (kUniformStretches > 13) number += endsBelow(value, few_ends[3]);
  if (kUniformStretches > 17) number += endsBelow(value, few_ends[4]);
  if (kUniformStretches > 21) number += endsBelow(value, few_ends[5]);
  return number;
}

// A point of a ray as the transfer function sees it.
struct End {
  vec2 value;    // value and gradient magnitude, texel units
  ivec2 stretch;
  float glow;    // value of a second grid
};

End endOf(vec3 texel) {
  End end;
  end.value = texel.rg;
  end.glow = kEmission != 0 ? texel.b : 0.0;
  end.value.r = clamp(snapped(end.value.r), -1e38, 1e38);
  end.stretch.x = valueStretchOf(end.value.r);
  end.stretch.y = kQuadrature > 1 ? stretchOf(end.value.g, 1, kGradientSteps) : 0;
  return end;
}

End endAt(vec3 point) { return endOf(textureLod(atlas, point, 0.0).rgb); }

// Adds a piece of length `ray` within one stretch, over which the value runs from `front` to `back`.
void addStretch(inout Slab slab, Stretch stretch, float front, float back, float ray) {
  vec2 place = vec2(placeIn(stretch.ends, front), placeIn(stretch.ends, back));
  vec2 sigma_t = stretch.ends.b + place * (stretch.ends.a - stretch.ends.b);
  float tau = 0.5 * (sigma_t.x + sigma_t.y) * ray, alpha = oneMinusExp(tau);
  float lit_place = place.x + scatteringCentroid(sigma_t.x, sigma_t.y, tau, alpha) * (place.y - place.x);
  addPiece(slab, stretch.low.rgb + lit_place * (stretch.high.rgb - stretch.low.rgb), tau, alpha);
}

// Adds a segment whose value runs from front to back through the stretches in between. Most segments stay in one.
void addRamp(inout Slab slab, End front, End back, float ray) {
  int number = front.stretch.x, last = back.stretch.x, towards = number < last ? 1 : -1;
  float per_value = 1.0 / (back.value.r - front.value.r);  // does not matter where both are equal
  float value = front.value.r, done = 0.0;
  while (true) {
    Stretch stretch = stretchAt(number);
    float end = number == last ? back.value.r : towards > 0 ? stretch.ends.g : stretch.ends.r;
    float until = number == last ? 1.0 : clamp((end - front.value.r) * per_value, done, 1.0);
    addStretch(slab, stretch, value, end, (until - done) * ray);
    if (number == last) break;
    number += towards;
    value = end;
    done = until;
  }
}

// One cell of the lattice of a 2D function: the ends of its stretches and the media at its corners.
struct Cell {
  vec4 value_ends, gradient_ends;
  vec4 a, b, c, d;  // media at the lower and the upper value for the lower gradient, then for the upper one
};

Cell cellAt(ivec2 number) {
  ivec2 corner = ivec2(2 * number.x, 2 + 2 * number.y);
  return Cell(texelFetch(transfer, ivec2(number.x, 0), 0), texelFetch(transfer, ivec2(number.y, 1), 0),
              texelFetch(transfer, corner, 0), texelFetch(transfer, corner + ivec2(1, 0), 0),
              texelFetch(transfer, corner + ivec2(0, 1), 0), texelFetch(transfer, corner + ivec2(1, 1), 0));
}

// Returns albedo and sigma_t at a point of the cell.
vec4 mediumIn(Cell cell, vec2 value) {
  vec4 low = cell.a + placeIn(cell.value_ends, value.x) * (cell.b - cell.a);
  vec4 high = cell.c + placeIn(cell.value_ends, value.x) * (cell.d - cell.c);
  return low + placeIn(cell.gradient_ends, value.y) * (high - low);
}

// Adds a piece of a segment within one cell. Extinction is quadratic along it, so that Simpson's rule gives its optical
// depth exactly. Extinction counts as linear for the place at which the piece scatters on average.
void addCell(inout Slab slab, ivec2 number, vec2 front, vec2 back, float ray) {
  Cell cell = cellAt(number);
  float first = mediumIn(cell, front).a, middle = mediumIn(cell, 0.5 * (front + back)).a, last = mediumIn(cell, back).a;
  float tau = (first + 4.0 * middle + last) * (1.0 / 6.0) * ray, alpha = oneMinusExp(tau);
  vec2 lit = front + scatteringCentroid(first, last, tau, alpha) * (back - front);
  addPiece(slab, mediumIn(cell, lit).rgb, tau, alpha);
}

// Adds a segment for a 2D function: the segment is cut where it crosses the lines of the lattice.
void addPath(inout Slab slab, End front, End back, float ray) {
  ivec2 cell = front.stretch, last = back.stretch, towards = sign(last - cell);
  vec2 change = back.value - front.value;
  float done = 0.0;
  while (true) {
    vec2 until = vec2(2.0);  // where each of the two coordinates leaves its stretch
    for (int axis = 0; axis < 2; ++axis) {
      vec2 ends = texelFetch(transfer, ivec2(cell[axis], axis), 0).rg;
      float end = towards[axis] > 0 ? ends.g : ends.r;
      if (cell[axis] != last[axis]) until[axis] = clamp((end - front.value[axis]) / change[axis], done, 1.0);
    }
    int axis = until.x <= until.y ? 0 : 1;
    float end = min(until[axis], 1.0);
    addCell(slab, cell, front.value + done * change, front.value + end * change, (end - done) * ray);
    if (cell == last) break;
    done = end;
    cell[axis] += towards[axis];
  }
}

// Adds what a segment emits, once its medium is added. What gets out of it is what a segment of the same optical depth
// lets out that is the same all along.
// @param before  the slab without the segment
void addEmitted(inout Slab slab, Slab before, float from, float to, float ray) {
  if (kEmission == 0) return;
  slab.emitted += (1.0 - before.eye.a) * ray * slabFactor(slab.tau - before.tau) * meanEmission(from, to);
}

// Adds a segment of length `ray`, world units, between two points of which the ends are known.
void addSegment(inout Slab slab, End front, End back, float ray) {
  Slab before = slab;
  if (kQuadrature == 0)
    addRamp(slab, front, back, ray);
  else
    addPath(slab, front, back, ray);
  addEmitted(slab, before, front.glow, back.glow, ray);
}

// Adds a segment whose medium is that at its middle.
void addMiddle(inout Slab slab, End middle, float ray) {
  Slab before = slab;
  if (kQuadrature == 1) {
    addStretch(slab, stretchAt(middle.stretch.x), middle.value.r, middle.value.r, ray);
  } else {
    vec4 medium = mediumIn(cellAt(middle.stretch), middle.value);
    addPiece(slab, medium.rgb, medium.a * ray, oneMinusExp(medium.a * ray));
  }  addEmitted(slab, before, middle.glow, middle.glow, ray);
}
