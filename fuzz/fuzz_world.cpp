// Random operations with random values on worlds, occlusion and rays, through the C API and so through the
// C++ beneath it; right calls, and calls with null pointers, strides and counts that are none, structs of
// other versions, and buffers of other views. Besides the sanitizers, the program checks what it can know.
#include <sightline/sightline.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "instances.hpp"
#include "ranges.hpp"

namespace {

using namespace sightline::fuzz;

constexpr std::size_t kMost = 40;

// Objects as a caller has them, laid out so that nothing is aligned to more than it must.
struct Thing {
  std::uint8_t tag;
  sightline_box box;
  float centre[3], half[3];
  sightline_handle handle;
  std::uint32_t layer, value;
  sightline_distance_range range;
};
using Things = std::array<Thing, kMost>;

void fill(CallBytes& in, Things& things, std::size_t count) {
  for (Thing& t : std::span(things).first(count)) {
    const bool any = in.byte() < 16;
    for (int a = 0; a < 3; ++a) {
      t.box.min[a] = in.number(1);
      t.box.max[a] = any ? in.number(1) : t.box.min[a] + in.byte() / 8.0;
      t.half[a] = static_cast<float>(0.5 * (t.box.max[a] - t.box.min[a]));
      t.centre[a] = static_cast<float>(t.box.min[a]) + t.half[a];
    }
    t.layer = in.byte(), t.value = in.byte();
    t.range.min = in.byte() < 128 ? 0 : in.byte();
    t.range.max = t.range.min + in.byte();
    if (in.rarely()) t.range = {in.single(1), in.single(1)};
  }
}

// What a pointer, a stride and a count can be made of that is refused.
template <class Pointer>
void harm(CallBytes& in, Pointer& first, std::size_t& stride, std::size_t& count) {
  switch (in.byte() % 5) {
    case 0:
      first = nullptr;
      break;
    case 1:
      stride = in.byte() % 4;
      break;
    case 2:
      stride = kTooMuch;
      break;
    case 3:
      count = kTooMuch - in.byte();
      break;
    default:
      break;
  }
}

sightline_box_view boxes_of(CallBytes& in, Things& things, std::size_t count) {
  Thing* t = things.data();
  sightline_box_view view = in.byte() & 1
                                ? sightline_boxes_centre_half_float(t->centre, t->half, sizeof *t, count)
                                : sightline_boxes_min_max_double(t->box.min, t->box.max, sizeof *t, count);
  if (in.byte() < 16) view.origin[in.byte() % 3] = in.number(1);
  if (!in.rarely()) return view;
  harm(in, view.data[in.byte() % 2], view.stride, view.count);
  if (in.rarely()) view.form = in.byte();
  if (in.rarely()) view.struct_size = in.take<std::uint32_t>();
  return view;
}

sightline_handles handles_of(CallBytes& in, Things& things, std::size_t count) {
  sightline_handles handles = sightline_handles_of(&things[0].handle, sizeof(Thing), count);
  if (in.rarely()) harm(in, handles.first, handles.stride, handles.count);
  return handles;
}

sightline_column column_of(CallBytes& in, const std::uint32_t* first, std::size_t count) {
  sightline_column column = sightline_column_of(first, sizeof(Thing), count);
  if (in.rarely()) harm(in, column.first, column.stride, column.count);
  return column;
}

sightline_distances distances_of(CallBytes& in, const Things& things, std::size_t count) {
  sightline_distances distances = sightline_distances_of(&things[0].range, sizeof(Thing), count);
  if (in.rarely()) harm(in, distances.first, distances.stride, distances.count);
  return distances;
}

sightline_view view_of(CallBytes& in) {
  sightline_camera camera = sightline_camera_default();
  sightline_view view;
  for (int a = 0; a < 3; ++a) camera.eye[a] = in.number(1), camera.forward[a] = in.single(1);
  if (in.byte() & 1) std::copy_n(camera.eye, 3, camera.origin);
  camera.vertical_fov = static_cast<float>(in.byte()) / 80;
  camera.near_plane = static_cast<float>(in.byte()) / 64;
  camera.reversed_depth = in.byte() % 2;
  if (in.rarely()) camera.struct_size = in.take<std::uint32_t>();
  if (!done(sightline_camera_view(&camera, in.byte(), in.byte(), &view))) {
    camera = sightline_camera_default();
    require(sightline_camera_view(&camera, 64, 48, &view) == SIGHTLINE_OK);
  }
  const std::uint8_t harm = in.byte();
  if (harm < 12) view.eye_to_clip[harm] = in.take<float>();
  if (harm >= 12 && harm < 28) view.world_to_eye[harm - 12] = in.take<float>();
  if (harm == 28) view.origin[0] = in.take<double>();
  if (harm == 29) view.eye_to_clip[11] = 0, view.eye_to_clip[15] = 1;  // orthographic
  return view;
}

class Play {
public:
  explicit Play(CallBytes& in) : in_(in) {}

  void step() {
    const std::uint8_t operation = in_.byte() % 18;
    count_ = in_.byte() % (kMost + 1);
    for (Thing& t : things_) {
      t.handle = {};
      if (!handles_.empty()) t.handle = handles_[in_.take<std::uint16_t>() % handles_.size()];
      if (in_.rarely()) t.handle = in_.take<sightline_handle>();
    }
    if (operation < 7) fill(in_, things_, count_);
    constexpr void (Play::*operations[])() = {
        &Play::insert,       &Play::insert,    &Play::move,          &Play::draw_boxes, &Play::ask,
        &Play::rays,         &Play::columns,   &Play::remove,        &Play::begin,      &Play::draw_mesh,
        &Play::draw_spheres, &Play::cull,      &Play::add_occluders, &Play::carry,      &Play::cull,
        &Play::shadows,      &Play::instances, &Play::ranges};
    (this->*operations[operation])();
    require(sightline_world_size(world_.get()) == standing_);
  }

private:
  void insert() {
    const sightline_box_view boxes = boxes_of(in_, things_, count_);
    const sightline_handles handles = handles_of(in_, things_, count_);
    sightline_object_columns columns = sightline_object_columns_default();
    if (in_.byte() & 1) columns.layers = column_of(in_, &things_[0].layer, count_);
    if (in_.byte() & 1) columns.values = column_of(in_, &things_[0].value, count_);
    if (in_.byte() & 1) columns.distances = distances_of(in_, things_, count_);
    if (in_.rarely()) columns.struct_size = in_.byte();
    const auto* given = in_.byte() & 1 ? &columns : nullptr;
    if (!done(sightline_world_insert(world_.get(), in_.rarely() ? nullptr : &boxes, &handles, given))) return;
    for (std::size_t i = 0; i < handles.count; ++i) handles_.push_back(things_[i].handle);
    standing_ += handles.count;
  }

  void move() {
    const sightline_box_view boxes = boxes_of(in_, things_, count_);
    const sightline_handles handles = handles_of(in_, things_, count_);
    if (!done(sightline_world_move(world_.get(), &handles, &boxes))) return;
    for (std::size_t i = 0; i < handles.count; ++i) {
      sightline_box box;
      require(sightline_world_box(world_.get(), things_[i].handle, &box) == SIGHTLINE_OK);
      for (int a = 0; a < 3; ++a) require(box.min[a] <= box.max[a]);
    }
  }

  void remove() {
    const sightline_handles handles = handles_of(in_, things_, count_);
    if (!done(sightline_world_remove(world_.get(), in_.rarely() ? nullptr : &handles))) return;
    for (std::size_t i = 0; i < handles.count; ++i)
      require(!sightline_world_contains(world_.get(), things_[i].handle));
    standing_ -= handles.count;
  }

  void columns() {
    const sightline_handles handles = handles_of(in_, things_, count_);
    const sightline_column layers = column_of(in_, &things_[0].layer, count_),
                           values = column_of(in_, &things_[0].value, count_);
    (void)done(sightline_world_set_layers(world_.get(), &handles, &layers));
    float sizes[9];
    for (std::size_t i = 0; i < std::size(sizes); ++i)
      sizes[i] = in_.rarely() ? in_.single(1) : 900.0f - 100 * i;
    std::uint32_t table = 0;
    (void)done(sightline_world_add_levels(world_.get(), sizes, in_.byte() % 10u, &table));
    (void)done(sightline_world_set_levels(world_.get(), &handles, &layers));
    const sightline_distances distances = distances_of(in_, things_, count_);
    if (done(sightline_world_set_distances(world_.get(), &handles, &distances)) && handles.count > 0) {
      const Thing& one = things_[handles.count - 1];
      sightline_distance_range range;
      require(sightline_world_distances(world_.get(), one.handle, &range) == SIGHTLINE_OK &&
              range.min == one.range.min && range.max == one.range.max);
    }
    if (!done(sightline_world_set_values(world_.get(), &handles, &values)) || handles.count == 0) return;
    std::uint32_t value = 0;
    const Thing& last = things_[handles.count - 1];
    require(sightline_world_value(world_.get(), last.handle, &value) == SIGHTLINE_OK && value == last.value);
  }

  void begin() {
    const sightline_view view = view_of(in_);
    if (done(sightline_occlusion_begin(occlusion_.get(), &view))) last_view_ = view;
  }

  void draw_boxes() {
    const sightline_box_view boxes = boxes_of(in_, things_, count_);
    (void)done(sightline_occlusion_draw_boxes(occlusion_.get(), &boxes));
  }

  sightline_sphere_view spheres() {
    Thing* t = things_.data();
    sightline_sphere_view view = sightline_spheres_of(t->centre, t->half, sizeof *t, count_);
    if (in_.rarely()) harm(in_, view.data[in_.byte() % 4], view.stride, view.count);
    if (in_.rarely()) view.struct_size = in_.byte();
    return view;
  }

  void draw_spheres() {
    const sightline_sphere_view given = spheres();
    (void)done(sightline_occlusion_draw_spheres(occlusion_.get(), &given));
  }

  void draw_mesh() {
    std::vector<float> positions(3 * count_);
    std::vector<std::uint32_t> indices(3 * (in_.byte() % 30) + (in_.rarely() ? 1 : 0));
    for (float& f : positions) f = in_.single(1);
    const std::uint32_t range =
        in_.rarely() ? 44 : static_cast<std::uint32_t>(std::max<std::size_t>(count_, 1));
    for (std::uint32_t& i : indices) i = in_.byte() % range;
    float transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (int i = 0; i < 16; ++i) {
      if (i % 4 != 3 || in_.rarely()) transform[i] = in_.single(0.01);
    }
    std::vector<std::uint8_t> sides(in_.byte() & 1 ? indices.size() / 3 : in_.byte() % 3);
    for (std::uint8_t& s : sides) s = in_.rarely() ? in_.byte() : in_.byte() & 1;
    sightline_occluder_mesh* made = nullptr;
    (void)done(sightline_occluder_mesh_create(positions.data(), in_.rarely() ? kTooMuch : count_,
                                              indices.data(), indices.size(), sides.data(), sides.size(),
                                              &made));
    const Owned<sightline_occluder_mesh, sightline_occluder_mesh_destroy> mesh(made);
    require(sightline_occluder_mesh_triangles(made) <= indices.size() / 3);
    (void)done(sightline_occlusion_draw_mesh(occlusion_.get(), made, in_.byte() & 1 ? transform : nullptr));
    if (in_.byte() % 64 == 0) make_occluder(positions, indices, sides);
  }

  void make_occluder(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices,
                     const std::vector<std::uint8_t>& sides) {
    sightline_occluder* made = nullptr;
    const std::uint32_t most = in_.rarely() ? 5000 : in_.byte() % 32u;
    (void)done(sightline_occluder_create(positions.data(), count_, indices.data(), indices.size(),
                                         sides.data(), sides.size(), most, in_.byte() % 4, &made));
    const Owned<sightline_occluder, sightline_occluder_destroy> occluder(made);
    sightline_occluder_parts parts = sightline_occluder_parts_default();
    if (!done(sightline_occluder_contents(made, &parts))) return;
    require(parts.index_count <= 3 * most && parts.yield <= SIGHTLINE_OCCLUDES_EMPTY);
    for (std::size_t i = 0; i < parts.index_count; ++i) require(parts.indices[i] < parts.position_count);
  }

  void add_occluders() {
    std::vector<float> numbers(6 * kMost);
    for (float& f : numbers) f = in_.single(1);
    const std::size_t boxes = in_.rarely() ? kTooMuch : count_ / 2;
    for (std::size_t b = 0; b < count_ / 2; ++b) {
      for (std::size_t a = 0; a < 3 && !in_.rarely(); ++a)
        numbers[6 * b + 3 + a] = numbers[6 * b + a] + static_cast<float>(in_.byte());
    }
    std::uint32_t name = 0;
    if (done(sightline_world_add_solids(world_.get(), numbers.data(), boxes, numbers.data(),
                                        in_.rarely() ? kTooMuch : in_.byte() % 8u, &name)))
      names_.push_back(name);
    std::vector<std::uint32_t> indices(3 * (in_.byte() % 20) + (in_.rarely() ? 1 : 0));
    for (std::uint32_t& i : indices) i = in_.byte() % (in_.rarely() ? 90u : 80u);
    const std::uint8_t side = in_.rarely() ? in_.byte() : in_.byte() & 1;
    if (done(sightline_world_add_surface(world_.get(), numbers.data(), 80, indices.data(), indices.size(),
                                         &side, in_.byte() & 1, in_.rarely() ? nullptr : &name)))
      names_.push_back(name);
    if (!in_.rarely()) return;
    (void)done(sightline_world_remove_occluder(world_.get(), in_.rarely() ? in_.byte() : some_occluder()));
  }

  std::uint32_t some_occluder() {
    return names_.empty() || in_.rarely() ? SIGHTLINE_NO_OCCLUDER : names_[in_.byte() % names_.size()];
  }

  void carry() {
    const sightline_handles handles = handles_of(in_, things_, count_);
    std::vector<sightline_occluder_placement> placements(count_);
    for (sightline_occluder_placement& p : placements) {
      p = sightline_occluder_placement_of(in_.rarely() ? in_.byte() : some_occluder(), nullptr);
      for (int i = 12; i < 15; ++i) p.transform[i] = in_.single(1);
      if (in_.byte() & 1) p.transform[in_.byte() % 12] = in_.single(0.01);
      if (in_.byte() < 32) p.origin[in_.byte() % 3] = in_.number(1);
    }
    (void)done(sightline_world_set_occluders(world_.get(), &handles, placements.data(),
                                             in_.rarely() ? kTooMuch : count_));
    std::vector<std::uint8_t> on(count_);
    for (std::uint8_t& s : on) s = in_.rarely() ? 2 : in_.byte() & 1;
    (void)done(sightline_world_set_occluding(world_.get(), &handles, on.data(), count_));
    if (count_ == 0) return;
    std::vector<float> corners(9 * (in_.byte() % 40));
    for (float& f : corners) f = in_.single(1);
    const double origin[3] = {in_.number(1), in_.number(1), in_.number(1)};
    const std::size_t points = corners.size() / 3;
    (void)done(sightline_world_set_triangles(
        world_.get(), things_[0].handle, corners.data(), points > 0 && in_.rarely() ? points - 1 : points,
        in_.byte() & 1 ? origin : nullptr, in_.rarely() ? 2 : in_.byte() & 1));
  }

  void ask() {
    std::array<std::uint8_t, kMost> seen;
    seen.fill(9);
    const std::size_t room = in_.rarely() ? count_ / 2 : kMost;
    const sightline_box_view boxes = boxes_of(in_, things_, count_);
    if (done(sightline_occlusion_may_see_boxes(occlusion_.get(), &boxes, seen.data(), room)))
      require(std::all_of(seen.begin(), seen.begin() + boxes.count, [](std::uint8_t s) { return s <= 1; }));
    const sightline_sphere_view given = spheres();
    (void)done(sightline_occlusion_may_see_spheres(occlusion_.get(), &given, seen.data(), room));
    int visible = 0;
    std::vector<float> corners(9 * (in_.byte() % 20));
    for (float& f : corners) f = in_.single(1);
    (void)done(sightline_occlusion_may_see_triangles(occlusion_.get(), corners.data(),
                                                     in_.rarely() ? kTooMuch : corners.size() / 3, &visible));
    std::vector<float> pixels(in_.byte() & 1 ? 256 * 256 : in_.byte());
    (void)done(sightline_occlusion_read_nearness(occlusion_.get(), pixels.data(), pixels.size()));
  }

  void rays() {
    const sightline_box_view boxes = boxes_of(in_, things_, count_);
    const double origin[3] = {in_.number(1), in_.number(1), in_.number(1)};
    (void)done(sightline_bvh_build(bvh_.get(), &boxes, in_.byte() & 1 ? origin : nullptr));
    fill(in_, things_, count_);
    (void)done(sightline_bvh_refit(bvh_.get(), &boxes));
    const std::size_t size = sightline_bvh_size(bvh_.get());
    std::array<sightline_ray, 8> rays;
    std::array<std::uint32_t, 8> met;
    std::array<float, 8> distances;
    for (sightline_ray& ray : rays) {
      for (int a = 0; a < 3; ++a) ray.origin[a] = in_.single(1), ray.direction[a] = in_.single(1);
      ray.max_distance = in_.byte() & 1 ? 1e6f : in_.single(10);
    }
    sightline_jobs jobs{run_here, nullptr, in_.byte() % 70u, in_.rarely() ? 1u : 0u};
    if (done(sightline_bvh_cast(bvh_.get(), rays.data(), in_.rarely() ? kTooMuch : rays.size(), met.data(),
                                in_.byte() & 1 ? distances.data() : nullptr, &jobs)))
      require(
          std::ranges::all_of(met, [&](std::uint32_t m) { return m < size || m == SIGHTLINE_NO_OBJECT; }));
    const sightline_view view = view_of(in_);
    std::array<std::uint32_t, kMost> visible;
    std::size_t count = 0;
    if (done(sightline_bvh_visible_set(bvh_.get(), &view, in_.byte() % 20, in_.byte() % 20, visible.data(),
                                       in_.rarely() ? 1 : kMost, nullptr, &count)))
      require(count <= size && (count == 0 || visible[count - 1] < size));
  }

  // Of any light, beside any camera; and what the camera sees may be any ids at all.
  void shadows() {
    const sightline_view camera = view_of(in_);
    sightline_light light = sightline_light_default();
    light.kind = in_.byte() % (in_.rarely() ? 9u : 3u);
    for (int a = 0; a < 3; ++a) light.direction[a] = in_.single(1), light.position[a] = in_.number(1);
    if (in_.byte() & 1)
      light.range = in_.single(10), light.reach = in_.single(10), light.cone = in_.single(1);
    const sightline_depth_range depths{in_.single(1), in_.single(10)};
    const sightline_depth_range* range = in_.byte() & 1 ? &depths : nullptr;
    const std::uint32_t pixels = in_.byte() * 4u;
    sightline_view shadow = camera;
    sightline_cascade cascades[3];
    (void)done(sightline_split_cascades(&light, &camera, range, in_.single(0.1), pixels, cascades, 3));
    if (in_.byte() & 1)
      (void)done(sightline_shadow_view(&light, &camera, range, pixels, in_.byte() % 7u, &shadow));
    if (!done(sightline_shadow_casters_begin(casters_.get(), &shadow, &camera, range, in_.single(1),
                                             in_.byte() & 1 ? in_.single(1) : 0)))
      return;
    shadow_ = shadow;
    std::vector<std::uint32_t> ids(in_.byte() % 40);
    for (std::uint32_t& id : ids) id = things_[in_.byte() % kMost].handle.index;
    (void)done(sightline_shadow_casters_receive(casters_.get(), world_.get(), ids.data(),
                                                in_.rarely() ? kTooMuch : ids.size(),
                                                in_.byte() & 1 ? occlusion_.get() : nullptr));
    int casts = 2;
    (void)done(sightline_shadow_casters_may_cast(casters_.get(), &things_[0].box, &casts));
    require(casts <= 1);
  }

  void instances() {
    instances_.step(world_.get(), in_.byte() & 1 ? last_view_ : view_of(in_), occlusion_.get());
  }

  void ranges() {
    ranges_.step(world_.get(), in_.byte() & 1 ? last_view_ : view_of(in_), occlusion_.get(), culler_.get());
  }

  void cull() {
    std::vector<sightline_cull_view> views(in_.byte() % 10);
    const bool automatic = in_.byte() & 1;
    for (sightline_cull_view& view : views) {
      const sightline_view camera = in_.byte() & 1 ? last_view_ : view_of(in_);
      const bool casts = in_.byte() < 64;
      view = sightline_cull_view_of(casts && !in_.rarely() ? &shadow_ : &camera);
      if (casts) view.casters = casters_.get();
      if (automatic ? in_.rarely() : in_.byte() & 1) view.occlusion = occlusion_.get();
      if (in_.byte() & 1) view.layers = in_.byte();
      if (in_.byte() & 1) view.min_area = in_.single(1);
      if (in_.byte() & 1) view.distance_scale = in_.single(1);
      if (in_.byte() < 64) view.distance_view = in_.byte() % 8u;
      if (in_.rarely()) view.struct_size = in_.byte();
    }
    sightline_cull_options options = sightline_cull_options_default();
    options.jobs = {run_here, nullptr, in_.byte() % 70u, 0};
    options.values_for_ids = in_.rarely() ? 1 : 0;
    if (automatic)
      options.occlusion = in_.rarely() ? in_.byte() : std::uint32_t{SIGHTLINE_OCCLUSION_AUTOMATIC};
    options.costs.object = in_.byte() & 1 ? 1e6f : in_.single(1000);
    (void)done(sightline_report_frame_time(culler_.get(), in_.number(1)));
    int zones = 0;
    options.zones.user = &zones;
    if (in_.byte() & 1) {
      options.zones.begin = [](void* user, const char*) { ++*static_cast<int*>(user); };
      options.zones.end = [](void* user) { --*static_cast<int*>(user); };
    }
    if (in_.rarely()) options.zones.end = nullptr;
    options.levels.view = in_.rarely() ? in_.byte() : 0, options.levels.key = in_.byte() % 9;
    if (in_.byte() & 1) options.levels.hysteresis = in_.single(0.01), options.levels.fade = in_.single(0.01);
    if (in_.rarely()) options.levels.scale = in_.single(0.1), options.levels.cut = 1;
    if (in_.rarely()) options.struct_size = in_.byte();
    const std::size_t needed = sightline_cull_capacity(world_.get(), &options);
    const std::size_t room = needed > 0 && in_.rarely() ? needed - 1 : needed;
    std::vector<std::uint32_t> ids(room);
    std::vector<std::uint8_t> masks(room);
    sightline_cull_output output =
        sightline_cull_output_of(ids.data(), in_.byte() & 1 ? masks.data() : nullptr, room);
    std::vector<std::uint8_t> levels(room), fades(room);
    if (in_.byte() & 1) output.levels = levels.data(), output.fades = in_.byte() & 1 ? fades.data() : nullptr;
    if (in_.rarely()) output.capacity = kTooMuch;
    sightline_cull_result result;
    if (!done(sightline_cull(culler_.get(), world_.get(), views.data(), views.size(), &options, &output,
                             &result)))
      return;
    require(result.count <= standing_ && zones == 0);
    require(options.occlusion == SIGHTLINE_OCCLUSION_NONE || result.cost <= 1.05 * result.frustum_cost);
    for (std::size_t i = 0; i < result.count && options.values_for_ids == 0; ++i)
      require(ids[i] < sightline_world_id_limit(world_.get()) && (!output.masks || masks[i] != 0));
    for (std::size_t i = 0; i < result.count && output.levels; ++i) require(levels[i] < SIGHTLINE_MAX_LEVELS);
  }

  CallBytes& in_;
  Owned<sightline_world, sightline_world_destroy> world_{sightline_world_create()};
  Owned<sightline_culler, sightline_culler_destroy> culler_{sightline_culler_create()};
  Owned<sightline_occlusion, sightline_occlusion_destroy> occlusion_{sightline_occlusion_create()};
  Owned<sightline_bvh, sightline_bvh_destroy> bvh_{sightline_bvh_create()};
  Owned<sightline_shadow_casters, sightline_shadow_casters_destroy> casters_{
      sightline_shadow_casters_create()};
  sightline::fuzz::InstancesPlay instances_{in_};
  sightline::fuzz::RangesPlay ranges_{in_};
  sightline_view last_view_{}, shadow_{};
  std::vector<sightline_handle> handles_;
  std::vector<std::uint32_t> names_;  // of occluders
  std::size_t standing_ = 0, count_ = 0;
  Things things_{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CallBytes in(data, size);
  Play play(in);
  for (int step = 0; step < 200 && !in.empty(); ++step) play.step();
  return 0;
}
