#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "hroc.h"

// A group's bounds as 36 vertices; of an object by itself, which may hold the eye, what box.vert makes of it.
layout(location = 0) out flat uint group;
layout(location = 1) out flat vec3 margin;  // by which boxes of the group are widened on either side
layout(location = 2) out flat float slack;  // of z and w anywhere in it

#include "box_corners.h"

void main() {
  group = groups.at[gl_VertexIndex / kBoxVertices];
  const uint turn = gl_VertexIndex % kBoxVertices;
  const NodeData node = nodes.at[group];
  const vec3 centre = centre_of(node), half_extent = half_extent_of(node);
  const vec3 wide = widened(centre, half_extent);
  margin = wide - half_extent;
  slack = depth_slack(centre, wide);
  const vec4 at = clip_position(corner(centre, wide, kCorners[turn]), slack);
  gl_Position = SIGHTLINE_MUTANT(hroc_by_frustum) ? before_all(at) : at;
  if (node.descendants > 0) return;
  if (!contributes(boxes.at[node.object].centre_radius, wide)) {
    gl_Position = kNowhere;
  } else if (reaches_near_plane(centre, wide)) {
    gl_Position = turn < 6 && !outside(centre, wide) ? certain_mark(kSquare[turn % 6]) : kNowhere;
  }
}
