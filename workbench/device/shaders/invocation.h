// The number of this invocation, and of its workgroup, in a dispatch that may be laid out in several rows: a
// device may allow no more than 65,535 workgroups side by side. Included after the group's size.
uint workgroup() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}
uint invocation() {
  return workgroup() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

// Rows of workgroups, of which at most `widest` fit side by side.
uvec3 in_rows(uint groups, uint widest) {
  return uvec3(min(groups, widest), (groups + widest - 1) / widest, 1);
}
