// The value along a ray within one cell of voxels, which is a polynomial of degree three, and where it crosses a value:
// the same as src/sweep/cell_cubic.cpp, in single precision.
// SPDX-License-Identifier: Apache-2.0

// The values at the corners of a cell: of the four below, x fastest, and of the four above.
struct CellCorners {
  vec4 low, high;
};

// Returns the trilinear value at p + s d, p and d within the cell [0, 1]^3, as x + y s + z s^2 + w s^3.
vec4 cubicBetween(CellCorners v, vec3 p, vec3 d) {
  float x = v.low.y - v.low.x, y = v.low.z - v.low.x, z = v.high.x - v.low.x;
  float xy = v.low.w - v.low.y - y, xz = v.high.y - v.low.y - z, yz = v.high.z - v.low.z - z;
  float xyz = v.high.w - v.high.y - v.high.z + v.high.x - xy;
  vec4 cubic;
  cubic.x = v.low.x + x * p.x + y * p.y + z * p.z + xy * p.x * p.y + xz * p.x * p.z + yz * p.y * p.z +
            xyz * p.x * p.y * p.z;
  cubic.y = d.x * (x + xy * p.y + xz * p.z + xyz * p.y * p.z) + d.y * (y + xy * p.x + yz * p.z + xyz * p.x * p.z) +
            d.z * (z + xz * p.x + yz * p.y + xyz * p.x * p.y);
  cubic.z = d.x * d.y * (xy + xyz * p.z) + d.x * d.z * (xz + xyz * p.y) + d.y * d.z * (yz + xyz * p.x);
  cubic.w = d.x * d.y * d.z * xyz;
  return cubic;
}

float cubicAt(vec4 cubic, float s) { return cubic.x + s * (cubic.y + s * (cubic.z + s * cubic.w)); }

// Returns where the slope changes its sign in (0, 1), ascending; 2 stands for none.
vec2 turnsOf(vec4 cubic) {
  float a = 3.0 * cubic.w, b = cubic.z, c = cubic.y;  // a s^2 + 2 b s + c
  float root = b * b - a * c;
  if (!(root > 0.0)) return vec2(2.0);
  // The sum of two numbers of one sign loses no digits.
  float q = -(b + (b < 0.0 ? -sqrt(root) : sqrt(root)));
  vec2 turns = vec2(a != 0.0 ? q / a : 2.0, q != 0.0 ? c / q : 2.0);
  turns = mix(turns, vec2(2.0), lessThanEqual(turns, vec2(0.0)));
  turns = mix(turns, vec2(2.0), greaterThanEqual(turns, vec2(1.0)));
  return vec2(min(turns.x, turns.y), max(turns.x, turns.y));
}

// Returns where the cubic, monotonic on [a, b], takes a value, to 2^-20 of the cell's way. Newton's steps may not leave
// a bracket that shrinks around the crossing.
float solveCubic(vec4 cubic, float value, float a, float b, bool rising) {
  const float kEnough = 1e-6;
  float at_a = cubicAt(cubic, a) - value, at_b = cubicAt(cubic, b) - value;
  // Where rounding has put an end on the wrong side, the crossing is that end.
  if ((at_a > 0.0) == rising) return a;
  if ((at_b > 0.0) != rising) return b;
  float s = a + (b - a) * (at_a / (at_a - at_b));
  for (int i = 0; i < 24 && b - a > kEnough; ++i) {
    float f = cubicAt(cubic, s) - value;
    if ((f > 0.0) == rising)
      b = s;
    else
      a = s;
    float newton = s - f / (cubic.y + s * (2.0 * cubic.z + 3.0 * s * cubic.w));
    float next = newton > a && newton < b ? newton : 0.5 * (a + b);
    if (abs(next - s) < kEnough) return next;
    s = next;
  }
  return s;
}

// Returns the first place from `from` on where the cubic crosses a value; 2 where there is none.
// @param above  whether the ray comes from above the value: rounding at the face between two cells loses no crossing
float crossingOf(vec4 cubic, vec2 turns, float value, float from, bool above) {
  float a = from;
  for (int i = 0; i < 3; ++i) {
    float b = min(i == 0 ? turns.x : i == 1 ? turns.y : 1.0, 1.0);
    if (b <= a && i < 2) continue;
    bool next = cubicAt(cubic, b) > value;
    if (next != above) return solveCubic(cubic, value, a, b, next);
    a = b;
  }
  return 2.0;
}
