#version 460
#include "workbench/device/shared.h"

#include "scan.h"
layout(local_size_x = 64) in;

// Every lane writes its word's part of the list; a list a row of workgroups.
void main() {
  const uint list = gl_WorkGroupID.y, word = gl_GlobalInvocationID.x;
  if (word >= word_count()) return;
  uint met = scan.at[word_at(list, word)];
  if (met == 0) return;
  uint place = scan.at[block_at(list, gl_WorkGroupID.x)] + scan.at[word_at(list, word) + 1];
  WordBuffer out_list = list == 0 ? list_of[0] : list_of[1];
  for (; met != 0; met &= met - 1) out_list.at[place++] = slot_objects.at[word * kEach + findLSB(met)];
}
