// Push constants of the two steps from flags to draw commands, and what they share. Up to two lists are built
// at once; the first holds what is not solid, too.
const uint kLanes = 64, kEach = 32;       // a lane takes as many slots as a word has bits
const uint kBlockSlots = kLanes * kEach;  // slots a workgroup takes

layout(buffer_reference, scalar) coherent buffer SharedWords {
  uint at[];
};

layout(push_constant, scalar) uniform Push {
  WordBuffer flags, slot_objects;
  // A list: two a word of 32 slots, which of them are listed and how many before it in its block; one a
  // block, how many before it. After both: groups done, 0 between dispatches; a VkDispatchIndirectCommand
  // over the solid objects of the first list, and how many they are; a bit a slot, who is a candidate.
  SharedWords scan;
  MeshBuffer meshes;
  ObjectBuffer objects;
  WordBuffer transparent_order;
  WordBuffer list_of[2];
  CommandBuffer commands_of[2];
  uvec2 condition_of[2], rest_condition;  // mask, value; the rest is what is not solid
  uint solid, ordered, batch_count, transparent, list_count;
  uint widest;  // workgroups that fit side by side
};

// The slot after the last has its place in a word, too.
uint word_count() {
  return ordered / kEach + 1;
}
uint block_count() {
  return ordered / kBlockSlots + 1;
}

uint word_at(uint list, uint word) {
  return list * (2 * word_count() + block_count()) + 2 * word;
}
uint block_at(uint list, uint block) {
  return word_at(list, word_count()) + block;
}
uint done_at() {
  return word_at(2, 0);
}
uint listed_at() {
  return done_at() + 1;
}

uint candidate_at(uint word) {
  return listed_at() + 4 + word;
}

uint meets(uint object, uvec2 condition) {
  return (flags.at[object] & condition.x) == condition.y ? 1 : 0;
}
