#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"

// A box as 36 vertices, the box and its corner out of the vertex index.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  WordBuffer list;
  uint listed;      // 0: box i is vertex i / 36's; 1: box list[i] is
  uint first_leaf;  // boxes before it hold others: by area only objects are judged
};

layout(location = 0) out flat uint id;

#include "box_corners.h"

void main() {
  const uint place = gl_VertexIndex / 36, turn = gl_VertexIndex % 36;
  id = listed != 0 ? list.at[place] : place;
  const BoxData box = boxes.at[id];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if ((kContribution == 1 || id >= first_leaf) && !contributes(box.centre_radius, half_extent)) {
    gl_Position = kNowhere;
    return;
  }
  if (reaches_near_plane(centre, half_extent)) {
    const bool drawn = turn < 6 && !outside(centre, half_extent);
    gl_Position = drawn ? certain_mark(kSquare[turn % 6]) : kNowhere;
    return;
  }
  const vec4 at = clip_position(corner(centre, half_extent, kCorners[turn]), depth_slack(centre, half_extent));
  const bool by_frustum = listed == 0 ? SIGHTLINE_MUTANT(roc_by_frustum)
                                      : SIGHTLINE_MUTANT(ioc_by_frustum) || SIGHTLINE_MUTANT(ihzb_by_frustum);
  gl_Position = by_frustum ? before_all(at) : at;
}
