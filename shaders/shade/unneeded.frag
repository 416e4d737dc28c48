// Marks pixels in tiles that nothing needs any more, so that the depth test spares them all later slices.
// Reads   need  by tile
// Writes  depth 0, by the vertices
layout(binding = 3) uniform sampler2D need;

void main() {
  if (texelFetch(need, ivec2(gl_FragCoord.xy) / kTileEdge, 0).r > 0.0) discard;
}
