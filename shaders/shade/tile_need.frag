// Which tiles of the image still have a pixel whose colour can change.
// Reads   eye_so_far  premultiplied RGBA
//         last_slice  R32F, by tile: the last slice with a brick there
// Writes  need  1 or 0, by tile
layout(binding = 3) uniform sampler2D eye_so_far;
layout(binding = 4) uniform sampler2D last_slice;
uniform float saturation;  // transmittance below which a pixel counts as saturated
uniform float slice;       // that is drawn next
layout(location = 0) out float need;

void main() {
  need = 0.0;
  ivec2 tile = ivec2(gl_FragCoord.xy);
  if (texelFetch(last_slice, tile, 0).r < slice) return;
  ivec2 last = textureSize(eye_so_far, 0) - 1;
  for (int y = 0; y < kTileEdge; ++y)
    for (int x = 0; x < kTileEdge; ++x) {
      ivec2 pixel = min(tile * kTileEdge + ivec2(x, y), last);
      if (1.0 - texelFetch(eye_so_far, pixel, 0).a >= saturation) need = 1.0;
    }
}
