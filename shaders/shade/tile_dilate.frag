// Spreads the need for light along one axis: a tile is needed when one within reach is.
// Reads   need_before  by tile
// Writes  need         by tile
layout(binding = 3) uniform sampler2D need_before;
uniform float reach;   // tiles
uniform float shrink;  // a slice reads the one before farther from the image's centre: from here back to the last slice, at most
uniform vec2 centre;   // of the image, tiles
uniform vec2 axis;     // (1, 0) or (0, 1)
layout(location = 0) out float need;

void main() {
  ivec2 last = textureSize(need_before, 0) - 1, along = ivec2(axis);
  float here = dot(gl_FragCoord.xy, axis), middle = dot(centre, axis);
  float behind = middle + (here - middle) * shrink;  // where the last slice has what is straight behind this tile
  int from = int(floor(min(here, behind) - reach)), to = int(floor(max(here, behind) + reach));
  ivec2 tile = ivec2(gl_FragCoord.xy) * (1 - along);
  need = 0.0;
  for (int i = max(from, 0); i <= min(to, last.x * along.x + last.y * along.y); ++i)
    need = max(need, texelFetch(need_before, tile + i * along, 0).r);
}
