// What both geometry stages of vertex-chunk share. Where it is included, max_vertices is declared.
layout(points) in;

layout(location = 0) in vec3 box_centre[];
layout(location = 1) in vec3 box_half_extent[];
layout(location = 2) in flat uint box_object[];
layout(location = 3) in flat uint outcome[];
layout(location = 0) out flat uint id;

void emit(vec4 position) {
  id = box_object[0];
  gl_Position = SIGHTLINE_MUTANT(vertex_chunk_by_frustum) ? before_all(position) : position;
  EmitVertex();
}

void emit_face(vec4 middle, vec4 a, vec4 b, float slack) {
  emit(nearer(middle - a - b, slack));
  emit(nearer(middle + a - b, slack));
  emit(nearer(middle - a + b, slack));
  emit(nearer(middle + a + b, slack));
  EndPrimitive();
}

// Whether the box is not to be restored: it was dropped, or marked here without a test.
bool settled() {
  if (outcome[0] == 2) {
    for (uint i = 0; i < 4; ++i) emit(certain_mark(i));
    EndPrimitive();
  }
  return outcome[0] != 1;
}

// The box in clip space: its middle, and half of each side.
struct ClipBox {
  vec4 middle, x, y, z;
};

ClipBox clip_box() {
  const vec3 half_extent = box_half_extent[0];
  const mat4 m = view.world_to_clip;
  return ClipBox(m * vec4(box_centre[0], 1), m[0] * half_extent.x, m[1] * half_extent.y,
                 m[2] * half_extent.z);
}
