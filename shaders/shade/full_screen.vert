// Draws one triangle that covers the image.
// SPDX-License-Identifier: Apache-2.0
uniform float depth;  // normalised device coordinate

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, depth, 1.0);
}
