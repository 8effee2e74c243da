#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 64) in;

// Every block adds what stands before it and writes its part of the list; the block that ends last writes the
// commands: one a mesh for the opaque objects, then one a transparent object.
shared uint before, rank;

void write_command(uint job, CommandBuffer commands, WordBuffer list, uint i) {
  if (i < mesh_count) {
    const MeshData mesh = meshes.at[i];
    const uint first = scan.at[prefix_at(job) + mesh.first_slot];
    const uint next = scan.at[prefix_at(job) + meshes.at[i + 1].first_slot];
    commands.at[i] = CommandData(mesh.index_count, next - first, mesh.first_index, mesh.first_vertex, first);
    return;
  }
  i -= mesh_count;
  const uint object = transparent_order.at[i];
  const MeshData mesh = meshes.at[objects.at[object].mesh];
  commands.at[mesh_count + i] = CommandData(mesh.index_count, meets(object, transparent_condition),
                                            mesh.first_index, mesh.first_vertex, opaque + i);
  list.at[opaque + i] = object;
}

void main() {
  const uint lane = gl_LocalInvocationID.x, job = gl_WorkGroupID.y, block = gl_WorkGroupID.x;
  const uvec2 condition = job == 0 ? condition_of[0] : condition_of[1];
  WordBuffer list = job == 0 ? list_of[0] : list_of[1];
  CommandBuffer commands = job == 0 ? commands_of[0] : commands_of[1];
  if (lane == 0) before = 0;
  barrier();
  uint sum = 0;
  for (uint i = lane; i < block; i += kLanes) sum += scan.at[sums_at(job) + i];
  if (sum != 0) atomicAdd(before, sum);
  barrier();
  // Lanes side by side take slots side by side, so that memory is read in whole lines.
  for (uint i = 0; i < kEach; ++i) {
    const uint slot = block * kBlockSlots + i * kLanes + lane;
    if (slot >= opaque) break;
    const uint object = slot_objects.at[slot];
    const uint place = scan.at[prefix_at(job) + slot] + before;
    scan.at[prefix_at(job) + slot] = place;
    if (meets(object, condition) != 0) list.at[place] = object;
  }
  if (lane == 0 && block + 1 == gl_NumWorkGroups.x) {
    const uint total = before + (opaque > 0 ? scan.at[sums_at(job) + block] : 0);
    scan.at[prefix_at(job) + opaque] = total;
    if (job == 0) {
      const uint words[4] = uint[](total / 64 + uint(total % 64 != 0), 1, 1, total);
      for (uint i = 0; i < 4; ++i) scan.at[listed_at() + i] = words[i];
    }
  }
  memoryBarrierBuffer();
  barrier();
  if (lane == 0) rank = atomicAdd(scan.at[done_at(job)], 1);
  barrier();
  if (rank + 1 < gl_NumWorkGroups.x) return;
  memoryBarrierBuffer();
  const uint count = mesh_count + (job == 0 ? transparent : 0);
  for (uint i = lane; i < count; i += kLanes) write_command(job, commands, list, i);
}
