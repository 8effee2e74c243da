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
  vec4 far_end;    // the far plane itself: nothing beyond is drawn, be depth rounded as it may
  float width, height;
  float pixels_per_metre;
  float metres_per_w;
  float coordinate_error;
  float near_push;  // metres by which plane 4 lies before the near plane, at least
  uint reversed;    // 1: the near plane lies at depth 1
  // What is seen at x, y (-1 … 1) is the ray origin + t · direction, each of them [0] + x · [1] + y · [2]. t
  // grows away from the eye: it is w under perspective, else 0 at the near plane and 1 at the far one.
  vec3 ray_origin[3], ray_direction[3];
};

struct ObjectData {
  vec4 rows[3];  // mesh space to world space
  uint mesh;     // in the table of meshes
  uint colour;   // RGBA, 8 bits each, red lowest
  uint look;     // kFrontOnly …; from kCutoffShift on the least alpha that is drawn
  uint image;    // its alpha, or kNoImage
};

const uint kFrontOnly = 1, kMirrored = 2, kCutOut = 4;
const uint kSeeThrough = 8;  // hides nothing: whatever is not solid
const uint kCutoffShift = 8;
const uint kNoImage = 0xffffffffu;

/// An alpha image: where its first texel stands, four a word.
struct ImageData {
  uint first, width, height;
};

/// Axis-aligned box and bounding sphere about one centre; half extents rounded up.
struct BoxData {
  vec4 centre_radius;
  vec4 half_extent;
};

/// A batch of objects of one mesh and one state, which are drawn by one command; or a mesh by itself.
struct MeshData {
  uint first_index, index_count;
  int first_vertex;
  uint first_slot;  // of the batch's objects; those of the next batch follow
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
static_assert(sizeof(ViewData) == 64 + 96 + 48 + 28 + 72);
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
layout(buffer_reference, scalar) readonly buffer CoordinateBuffer {
  vec2 at[];
};
layout(buffer_reference, scalar) readonly buffer ImageBuffer {
  ImageData at[];
};
/// What fragments of cut-outs are tested by.
layout(buffer_reference, scalar) readonly buffer LookBuffer {
  ObjectBuffer objects;
  CoordinateBuffer coordinates;  // one a vertex, where there are images
  ImageBuffer images;
  WordBuffer alpha;
};
#endif
