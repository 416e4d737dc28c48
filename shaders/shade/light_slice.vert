// A polygon of a proxy slice, for a target with one layer per slice. As slice.vert.
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 slab;
layout(location = 2) in float layer;
flat out vec4 slab_centre;

void main() {
  gl_Position = vec4(position, -0.6, 1.0);
  gl_Layer = int(layer);
  slab_centre = slab;
}
