// Draws the part of one slab that lies in one brick as light meets it: on the lattice of the light, in parallel
// projection along the view axis.
// Reads   atlas, transfer (see medium.glsl)
// Writes  tau  optical depth of the slab along the view axis, one layer per slice
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
flat in vec4 slab_centre;
layout(location = 0) out float tau;

void main() {
  tau = evaluateSlab(slab_centre).tau;
}
