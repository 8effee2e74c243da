// Push constants of the two steps from flags to draw commands, and what they share. Up to two lists are built
// at once, one a row of workgroups; the first holds transparent objects too.
const uint kLanes = 64, kEach = 32;       // slots a lane takes one after the other
const uint kBlockSlots = kLanes * kEach;  // slots a workgroup takes

layout(buffer_reference, scalar) coherent buffer SharedWords {
  uint at[];
};

layout(push_constant, scalar) uniform Push {
  WordBuffer flags, slot_objects;
  // A list: one a slot and one more, what stands before it; one a block, its sum; groups done. After both: a
  // VkDispatchIndirectCommand over the first list, and how long it is.
  SharedWords scan;
  MeshBuffer meshes;
  ObjectBuffer objects;
  WordBuffer transparent_order;
  WordBuffer list_of[2];
  CommandBuffer commands_of[2];
  uvec2 condition_of[2], transparent_condition;  // mask, value
  uint opaque, mesh_count, transparent;
};

uint block_count() {
  return (opaque + kBlockSlots - 1) / kBlockSlots;
}

// Where a list's prefix sums, its blocks' sums and its count of groups begin.
uint prefix_at(uint job) {
  return job * (opaque + block_count() + 2);
}
uint sums_at(uint job) {
  return prefix_at(job) + opaque + 1;
}
uint done_at(uint job) {
  return sums_at(job) + block_count();
}

uint listed_at() {
  return prefix_at(2);
}

uint meets(uint object, uvec2 condition) {
  return (flags.at[object] & condition.x) == condition.y ? 1 : 0;
}
