// A corner of a world-space triangle. It knows its object, so that fragments need no triangle numbers: a
// software rasteriser takes every triangle apart to hand those over.
layout(location = 0) in vec3 position;
layout(location = 1) in uint object;
layout(location = 2) in uint colour;
layout(location = 0) out vec3 world_position;
layout(location = 1) out flat uint fragment_object;
layout(location = 2) out flat uint fragment_colour;
invariant gl_Position;
out float gl_ClipDistance[1];

void place_corner() {
  world_position = position;
  fragment_object = object;
  fragment_colour = colour;
  gl_Position = on_pixel_grid(position);
  gl_ClipDistance[0] = before_far_end(position);
}
