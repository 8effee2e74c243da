// Push constants of the four steps from flags to draw commands.
layout(push_constant, scalar) uniform Push {
  WordBuffer flags, slot_objects, prefix, sums, list;
  MeshBuffer meshes;
  ObjectBuffer objects;
  CommandBuffer commands;
  WordBuffer transparent_order;
  uint mask, value, opaque, mesh_count, transparent;
};

uint listed(uint object) {
  return (flags.at[object] & mask) == value ? 1 : 0;
}
