// The C API: each function checks its pointers, calls the C++ of the same name, and keeps the reason of a
// failure.
#include <sightline/sightline.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <sightline/occlusion.hpp>
#include <sightline/version.hpp>
#include <sightline/world.hpp>

struct sightline_world {
  sightline::World world;
};
struct sightline_culler {
  sightline::Culler culler;
};
struct sightline_occlusion {
  sightline::OcclusionBuffer buffer;
};
struct sightline_occluder_mesh {
  sightline::OccluderMesh mesh;
};

namespace {

using namespace sightline;

// What is cast below has one layout on both sides.
static_assert(sizeof(sightline_box) == sizeof(WorldBox) &&
              offsetof(sightline_box, max) == offsetof(WorldBox, max));
static_assert(sizeof(sightline_handle) == sizeof(Handle) &&
              offsetof(sightline_handle, generation) == offsetof(Handle, generation));
static_assert(sizeof(sightline_view) == sizeof(WorldView) &&
              offsetof(sightline_view, origin) == offsetof(WorldView, origin) &&
              offsetof(sightline_view, eye_to_clip) == offsetof(View, eye_to_clip) &&
              offsetof(sightline_view, width) == offsetof(View, width));
static_assert(sizeof(ObjectId) == sizeof(std::uint32_t));

#ifdef __wasm__
std::string last_error;  // WebAssembly has one thread
#else
thread_local std::string last_error;
#endif

sightline_status fail(sightline_status status, std::string reason) {
  last_error = std::move(reason);
  return status;
}

sightline_status missing(const char* function) {
  return fail(SIGHTLINE_BAD_ARGUMENT, std::string(function) + ": a pointer is NULL");
}

const WorldBox* boxes_of(const sightline_box* boxes) {
  return reinterpret_cast<const WorldBox*>(boxes);
}
const Handle* handles_of(const sightline_handle* handles) {
  return reinterpret_cast<const Handle*>(handles);
}
const WorldView* views_of(const sightline_view* views) {
  return reinterpret_cast<const WorldView*>(views);
}

bool valid(const WorldBox& b) {
  const auto within = [](double low, double high) {
    return low >= -kWorldReach && high <= kWorldReach && low <= high;
  };
  return within(b.min.x, b.max.x) && within(b.min.y, b.max.y) && within(b.min.z, b.max.z);
}

CullOptions options_of(const sightline_cull_options* from) {
  CullOptions options;
  if (!from) return options;
  options.min_area = from->min_area;
  options.jobs = {from->run_jobs, from->user, from->threads == 0 ? 1 : from->threads};
  return options;
}

}  // namespace

extern "C" {

const char* sightline_version(void) {
  return kVersion.data();
}
const char* sightline_last_error(void) {
  return last_error.c_str();
}

sightline_status sightline_view_perspective(const double eye[3], const float forward[3], const float up[3],
                                            float vertical_fov, float near_plane, uint32_t width,
                                            uint32_t height, sightline_view* view) {
  if (!eye || !forward || !up || !view) return missing("sightline_view_perspective");
  for (int a = 0; a < 3; ++a) {
    if (!(std::fabs(eye[a]) <= kWorldReach)) return fail(SIGHTLINE_BAD_VIEW, "view: the eye is out of range");
  }
  Camera camera;
  camera.forward = {forward[0], forward[1], forward[2]};
  camera.up = {up[0], up[1], up[2]};
  camera.vertical_fov = vertical_fov;
  camera.near_plane = near_plane;
  camera.far_plane = std::numeric_limits<float>::infinity();
  const Result<View> made = make_view(camera, width, height);
  if (!made) return fail(SIGHTLINE_BAD_VIEW, made.failure().message);
  *reinterpret_cast<WorldView*>(view) = {*made, {eye[0], eye[1], eye[2]}};
  return SIGHTLINE_OK;
}

sightline_world* sightline_world_create(void) {
  return new sightline_world;
}
void sightline_world_destroy(sightline_world* world) {
  delete world;
}

sightline_status sightline_world_insert(sightline_world* world, const sightline_box* boxes, size_t count,
                                        sightline_handle* handles) {
  if (!world || (count > 0 && (!boxes || !handles))) return missing("sightline_world_insert");
  const Check bad =
      world->world.insert({boxes_of(boxes), count}, {reinterpret_cast<Handle*>(handles), count});
  return bad ? fail(SIGHTLINE_BAD_BOX, bad->message) : SIGHTLINE_OK;
}

sightline_status sightline_world_move(sightline_world* world, const sightline_handle* handles,
                                      const sightline_box* boxes, size_t count) {
  if (!world || (count > 0 && (!boxes || !handles))) return missing("sightline_world_move");
  const Check bad = world->world.move({handles_of(handles), count}, {boxes_of(boxes), count});
  if (!bad) return SIGHTLINE_OK;
  bool all_stand = true;
  for (size_t i = 0; i < count; ++i) all_stand = all_stand && world->world.contains(handles_of(handles)[i]);
  return fail(all_stand ? SIGHTLINE_BAD_BOX : SIGHTLINE_STALE_HANDLE, bad->message);
}

sightline_status sightline_world_remove(sightline_world* world, const sightline_handle* handles,
                                        size_t count) {
  if (!world || (count > 0 && !handles)) return missing("sightline_world_remove");
  const Check bad = world->world.remove({handles_of(handles), count});
  return bad ? fail(SIGHTLINE_STALE_HANDLE, bad->message) : SIGHTLINE_OK;
}

size_t sightline_world_size(const sightline_world* world) {
  return world ? world->world.size() : 0;
}
size_t sightline_world_id_limit(const sightline_world* world) {
  return world ? world->world.id_limit() : 0;
}

int sightline_world_contains(const sightline_world* world, sightline_handle handle) {
  return world && world->world.contains({handle.index, handle.generation});
}

sightline_status sightline_world_box(const sightline_world* world, sightline_handle handle,
                                     sightline_box* box) {
  if (!world || !box) return missing("sightline_world_box");
  const Handle h{handle.index, handle.generation};
  if (!world->world.contains(h))
    return fail(SIGHTLINE_STALE_HANDLE, "world: the handle names no object that stands");
  *reinterpret_cast<WorldBox*>(box) = world->world.box(h);
  return SIGHTLINE_OK;
}

sightline_occluder_mesh* sightline_occluder_mesh_create(const float* positions, size_t position_count,
                                                        const uint32_t* indices, size_t index_count) {
  if ((position_count > 0 && !positions) || (index_count > 0 && !indices) || position_count > 0xffffffffu) {
    missing("sightline_occluder_mesh_create");
    return nullptr;
  }
  std::vector<Vec3> points(position_count);
  for (size_t i = 0; i < position_count; ++i) {
    points[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z)) {
      fail(SIGHTLINE_BAD_ARGUMENT, "occluder mesh: position " + std::to_string(i) + " is not finite");
      return nullptr;
    }
  }
  return new sightline_occluder_mesh{OccluderMesh(points, {indices, index_count})};
}

void sightline_occluder_mesh_destroy(sightline_occluder_mesh* mesh) {
  delete mesh;
}

sightline_occlusion* sightline_occlusion_create(void) {
  return new sightline_occlusion;
}
void sightline_occlusion_destroy(sightline_occlusion* occlusion) {
  delete occlusion;
}

sightline_status sightline_occlusion_begin(sightline_occlusion* occlusion, const sightline_view* view) {
  if (!occlusion || !view) return missing("sightline_occlusion_begin");
  const Check bad = occlusion->buffer.begin(*views_of(view));
  return bad ? fail(SIGHTLINE_BAD_VIEW, bad->message) : SIGHTLINE_OK;
}

sightline_status sightline_occlusion_draw_boxes(sightline_occlusion* occlusion, const sightline_box* boxes,
                                                size_t count) {
  if (!occlusion || (count > 0 && !boxes)) return missing("sightline_occlusion_draw_boxes");
  if (occlusion->buffer.width() == 0) return fail(SIGHTLINE_BAD_ARGUMENT, "occlusion: draw before begin");
  for (size_t i = 0; i < count; ++i) {
    if (!valid(boxes_of(boxes)[i]))
      return fail(SIGHTLINE_BAD_BOX, "occlusion: box " + std::to_string(i) + " is not valid");
  }
  occlusion->buffer.draw_boxes(std::span(boxes_of(boxes), count));
  return SIGHTLINE_OK;
}

sightline_status sightline_occlusion_draw_mesh(sightline_occlusion* occlusion,
                                               const sightline_occluder_mesh* mesh,
                                               const float transform[12]) {
  if (!occlusion || !mesh || !transform) return missing("sightline_occlusion_draw_mesh");
  if (occlusion->buffer.width() == 0) return fail(SIGHTLINE_BAD_ARGUMENT, "occlusion: draw before begin");
  Affine affine;
  for (std::size_t row = 0; row < 3; ++row) {
    const float* r = transform + 4 * row;
    affine.rows[row] = {r[0], r[1], r[2], r[3]};
    for (int i = 0; i < 4; ++i) {
      if (!std::isfinite(r[i])) return fail(SIGHTLINE_BAD_ARGUMENT, "occlusion: the transform is not finite");
    }
  }
  occlusion->buffer.draw_mesh(mesh->mesh, affine);
  return SIGHTLINE_OK;
}

sightline_culler* sightline_culler_create(void) {
  return new sightline_culler;
}
void sightline_culler_destroy(sightline_culler* culler) {
  delete culler;
}

size_t sightline_cull_capacity(const sightline_world* world, const sightline_cull_options* options) {
  return world ? cull_capacity(world->world, options_of(options)) : 0;
}

sightline_status sightline_cull(sightline_culler* culler, const sightline_world* world,
                                const sightline_view* views, size_t view_count,
                                const sightline_cull_options* options, uint32_t* ids, uint8_t* masks,
                                size_t capacity, sightline_cull_result* result) {
  if (!culler || !world || !views || !ids || !result) return missing("sightline_cull");
  if (view_count < 1 || view_count > kMaxViews) {
    return fail(SIGHTLINE_BAD_ARGUMENT, "cull: expected 1 to 8 views, got " + std::to_string(view_count));
  }
  CullOptions o = options_of(options);
  std::array<const OcclusionBuffer*, kMaxViews> buffers{};
  if (options && options->occlusion) {
    for (size_t v = 0; v < view_count; ++v) {
      if (options->occlusion[v]) buffers[v] = &options->occlusion[v]->buffer;
    }
    o.occlusion = {buffers.data(), view_count};
  }
  const CullResult r = culler->culler.cull(world->world, {views_of(views), view_count}, o, {ids, capacity},
                                           masks ? std::span(masks, capacity) : std::span<std::uint8_t>());
  switch (r.error) {
    case CullError::none:
      break;
    case CullError::view:
      return fail(SIGHTLINE_BAD_VIEW, "cull: a view is not finite, not invertible or out of range");
    case CullError::buffer:
      return fail(SIGHTLINE_BUFFER_TOO_SMALL, "cull: expected room for " +
                                                  std::to_string(cull_capacity(world->world, o)) +
                                                  " ids, got " + std::to_string(capacity));
    default:
      return fail(SIGHTLINE_BAD_ARGUMENT, "cull: an option is out of range, or an occlusion was not begun");
  }
  *result = {r.count, r.tested, r.nodes_visited, r.culled_occlusion};
  return SIGHTLINE_OK;
}

}  // extern "C"
