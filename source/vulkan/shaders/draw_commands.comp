#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 256) in;

// One command a mesh for the opaque objects, then one a transparent object.
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < mesh_count) {
    const MeshData mesh = meshes.at[i];
    const uint first = prefix.at[mesh.first_slot], next = prefix.at[meshes.at[i + 1].first_slot];
    commands.at[i] = CommandData(mesh.index_count, next - first, mesh.first_index, mesh.first_vertex, first);
    return;
  }
  i -= mesh_count;
  if (i >= transparent) return;
  const uint object = transparent_order.at[i];
  const MeshData mesh = meshes.at[objects.at[object].mesh];
  commands.at[mesh_count + i] =
      CommandData(mesh.index_count, meets(object, transparent_condition), mesh.first_index, mesh.first_vertex, opaque + i);
  list.at[opaque + i] = object;
}
