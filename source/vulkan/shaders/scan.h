// Push constants of the four steps from flags to draw commands.
layout(push_constant, scalar) uniform Push {
  WordBuffer flags, slot_objects, prefix, sums, list;
  MeshBuffer meshes;
  ObjectBuffer objects;
  CommandBuffer commands;
  WordBuffer transparent_order;
  uvec2 opaque_condition, transparent_condition;  // mask, value
  uint opaque, mesh_count, transparent;
};

uint meets(uint object, uvec2 condition) {
  return (flags.at[object] & condition.x) == condition.y ? 1 : 0;
}
