// The structs that C++ writes and GLSL reads, once for both. Scalar layout: members lie as in C++.
#ifdef __cplusplus
#pragma once

#include <cstdint>

#include <sightline/types.hpp>

namespace sightline::device::shared {
using mat4 = Mat4;
using vec4 = Vec4;
using vec3 = Vec3;
using uint = std::uint32_t;
#else
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#endif

/// A view with what culling shaders need of it: planes as make_frustum gives them, pixels as make_projector.
struct ViewData {
  mat4 world_to_clip;
  vec4 planes[6];  // inward, w = distance; 4 is the near plane, 5 the far one
  vec4 eye;        // w: 1 where the view is orthographic
  vec4 forward;    // unit
  float width, height;
  float pixels_per_metre;
  float metres_per_w;
  float coordinate_error;
  float near_push;  // metres by which plane 4 lies before the near plane, at least
  uint reversed;    // 1: the near plane lies at depth 1
};

struct ObjectData {
  vec4 rows[3];  // mesh space to world space
  uint mesh;
  uint colour;  // RGBA, 8 bits each, red lowest
  uint transparent;
  uint slot;  // position in the order of drawing
};

/// Axis-aligned box and bounding sphere about one centre; half extents rounded up.
struct BoxData {
  vec4 centre_radius;
  vec4 half_extent;
};

struct MeshData {
  uint first_index, index_count;
  int first_vertex;
  uint first_slot;  // of the opaque objects of this mesh; those of mesh m + 1 follow
};

/// A corner of a world-space triangle that knows its object.
struct CornerData {
  vec3 position;
  uint object, colour;
};

struct CommandData {
  uint index_count, instance_count, first_index;
  int vertex_offset;
  uint first_instance;
};

#ifdef __cplusplus
static_assert(sizeof(ViewData) == 64 + 96 + 32 + 28);
static_assert(sizeof(ObjectData) == 64 && sizeof(BoxData) == 32 && sizeof(MeshData) == 16 &&
              sizeof(CommandData) == 20 && sizeof(CornerData) == 20);
}  // namespace sightline::device::shared
#else
layout(buffer_reference, scalar) readonly buffer ObjectBuffer {
  ObjectData at[];
};
layout(buffer_reference, scalar) readonly buffer BoxBuffer {
  BoxData at[];
};
layout(buffer_reference, scalar) readonly buffer MeshBuffer {
  MeshData at[];
};
layout(buffer_reference, scalar) buffer CommandBuffer {
  CommandData at[];
};
layout(buffer_reference, scalar) readonly buffer PositionBuffer {
  vec3 at[];
};
layout(buffer_reference, scalar) buffer WordBuffer {
  uint at[];
};
#endif
