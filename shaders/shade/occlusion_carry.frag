// Pixels of a slice that no brick covers: light keeps spreading in empty space.
// Reads   occlusion_prev (see footprint.glsl)
// Writes  occlusion  blending off
#include "shade/footprint.glsl"
layout(location = 0) out float occlusion;

void main() { occlusion = meanOverFootprint(previousPoint()); }
