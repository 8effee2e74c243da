#version 460
#include "workbench/device/shared.h"

#include "scan.h"
layout(local_size_x = 64) in;
#include "workbench/device/shaders/invocation.h"

// Which slots are listed, and how many before each word of them in its block; the block that ends last adds up
// the blocks and writes the commands: one a batch, then one a transparent object. What costs
// on llvmpipe is a workgroup with barriers, whatever their number, so all that needs them is done here.
const uint kRow = 8;  // lanes, and rows of lanes
layout(constant_id = 0) const bool kAmongCandidates = false;
shared uvec2 of_lane[kLanes], of_row[kRow];
shared uint rank;

// What stands before this lane, and in all; one value a list.
void add_up(uvec2 own, out uvec2 before, out uvec2 total) {
  const uint lane = gl_LocalInvocationID.x, row = lane / kRow;
  of_lane[lane] = own;
  barrier();
  if (lane < kRow) {
    uvec2 sum = uvec2(0);
    for (uint i = 0; i < kRow; ++i) sum += of_lane[lane * kRow + i];
    of_row[lane] = sum;
  }
  barrier();
  before = total = uvec2(0);
  for (uint i = 0; i < row; ++i) before += of_row[i];
  for (uint i = row * kRow; i < lane; ++i) before += of_lane[i];
  for (uint i = 0; i < kRow; ++i) total += of_row[i];
}

// The place in the list of the object at a slot, were it listed.
uint place_of(uint list, uint slot) {
  const uint at = word_at(list, slot / kEach);
  return scan.at[block_at(list, slot / kBlockSlots)] + scan.at[at + 1] +
         bitCount(scan.at[at] & (1u << slot % kEach) - 1);
}

void write_command(uint list, CommandBuffer commands, WordBuffer objects_of, uint i) {
  if (i < batch_count) {
    const MeshData mesh = meshes.at[i];
    const uint first = place_of(list, mesh.first_slot), next = place_of(list, meshes.at[i + 1].first_slot);
    commands.at[i] = CommandData(mesh.index_count, next - first, mesh.first_index, mesh.first_vertex, first);
    return;
  }
  i -= batch_count;
  const uint object = transparent_order.at[i];
  const MeshData mesh = meshes.at[objects.at[object].mesh];
  commands.at[batch_count + i] = CommandData(mesh.index_count, meets(object, rest_condition),
                                             mesh.first_index, mesh.first_vertex, ordered + i);
  objects_of.at[ordered + i] = object;
}

// A bit a slot of a word, of those to look at. Candidates stand but once.
uint taken(uint word) {
  if (word >= word_count()) return 0;
  const uint last = min(kEach, ordered - word * kEach);
  if (!kAmongCandidates) return last == kEach ? ~0u : (1u << last) - 1;
  const uint bits = scan.at[candidate_at(word)];
  scan.at[candidate_at(word)] = 0;
  return bits;
}

void main() {
  const uint lane = gl_LocalInvocationID.x, block = gl_WorkGroupID.x, word = block * kLanes + lane;
  uvec2 met = uvec2(0);  // a bit a slot
  for (uint left = taken(word); left != 0; left &= left - 1) {
    const uint slot = word * kEach + findLSB(left), bit = left & -left;
    const uint flag = flags.at[slot_objects.at[slot]];
    const bool is_solid = slot < solid;
    const uvec2 condition = is_solid ? condition_of[0] : rest_condition;
    if ((flag & condition.x) == condition.y) met.x |= bit;
    if (is_solid && (flag & condition_of[1].x) == condition_of[1].y) met.y |= bit;
  }
  uvec2 before, total;
  add_up(uvec2(bitCount(met.x), bitCount(met.y)), before, total);
  for (uint list = 0; list < list_count; ++list) {
    if (word < word_count()) {
      scan.at[word_at(list, word)] = met[list];
      scan.at[word_at(list, word) + 1] = before[list];
    }
    if (lane == 0) scan.at[block_at(list, block)] = total[list];
  }
  memoryBarrierBuffer();
  barrier();
  if (lane == 0) rank = atomicAdd(scan.at[done_at()], 1);
  barrier();
  if (rank + 1 < block_count()) return;
  memoryBarrierBuffer();
  // The last block: a lane adds up blocks side by side.
  const uint each = (block_count() + kLanes - 1) / kLanes, start = lane * each;
  const uint end = min(start + each, block_count());
  uvec2 sum = uvec2(0);
  for (uint i = start; i < end; ++i) {
    for (uint list = 0; list < list_count; ++list) sum[list] += scan.at[block_at(list, i)];
  }
  add_up(sum, before, total);
  for (uint i = start; i < end; ++i) {
    for (uint list = 0; list < list_count; ++list) {
      const uint here = scan.at[block_at(list, i)];
      scan.at[block_at(list, i)] = before[list];
      before[list] += here;
    }
  }
  memoryBarrierBuffer();
  barrier();
  if (lane == 0) {
    scan.at[done_at()] = 0;
    const uint count = place_of(0, solid);
    const uvec3 groups = in_rows(count / 64 + uint(count % 64 != 0), widest);
    const uint words[4] = uint[](groups.x, groups.y, groups.z, count);
    for (uint i = 0; i < 4; ++i) scan.at[listed_at() + i] = words[i];
  }
  for (uint i = lane; i < batch_count + transparent; i += kLanes) {
    write_command(0, commands_of[0], list_of[0], i);
    if (list_count > 1 && i < batch_count) write_command(1, commands_of[1], list_of[1], i);
  }
}
