// The part of one slab that lies in one brick, as light sees it: drawn on the lattice of the light, in parallel projection
// along the view axis.
// Reads   atlas, transfer (see medium.glsl)
// Writes  tau  optical depth of the slab along the view axis, one layer per slice
#include "shade/slab.glsl"
flat in vec4 slab_centre;
layout(location = 0) out float tau;

void main() {
  Slab slab = evaluateSlab(slab_centre);
  tau = slab.sigma_t * slab.share * 2.0 * half_spacing;
}
