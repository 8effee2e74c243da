// Random operations with random values on everything public of the world and of occlusion, through the C API
// and so through the C++ beneath it. Besides the sanitizers, the program checks what it can know.
#include <sightline/sightline.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "bytes.hpp"

namespace {

struct Bytes : sightline::fuzz::Bytes {
  using sightline::fuzz::Bytes::Bytes;
  // Mostly sane, sometimes any bits at all.
  double number(double scale) {
    const std::uint8_t kind = byte();
    if (kind < 8) return take<double>();
    if (kind < 40) return scale * 1e6 * take<std::int8_t>();
    return scale * take<std::int16_t>() / 256.0;
  }
};

void require(bool holds) {
  if (!holds) __builtin_trap();
}

sightline_box box_of(Bytes& in) {
  sightline_box box;
  const bool any = in.byte() < 16;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = in.number(1);
    box.max[a] = any ? in.number(1) : box.min[a] + in.byte() / 8.0;
  }
  return box;
}

sightline_view view_of(Bytes& in) {
  sightline_view view;
  const double eye[3] = {in.number(1), in.number(1), in.number(1)};
  const float forward[3] = {static_cast<float>(in.number(1)), static_cast<float>(in.number(1)),
                            static_cast<float>(in.number(1))};
  const float up[3] = {0, 1, 0};
  const auto fov = static_cast<float>(in.byte()) / 80, near = static_cast<float>(in.byte()) / 64;
  const std::uint32_t width = in.byte(), height = in.byte();
  if (sightline_view_perspective(eye, forward, up, fov, near, width, height, &view) != SIGHTLINE_OK) {
    const float ahead[3] = {0, 0, -1};
    const double origin[3] = {0, 0, 0};
    require(sightline_view_perspective(origin, ahead, up, 1, 0.1f, 64, 48, &view) == SIGHTLINE_OK);
  }
  const std::uint8_t harm = in.byte();
  if (harm < 12) view.eye_to_clip[harm] = in.take<float>();
  if (harm >= 12 && harm < 28) view.world_to_eye[harm - 12] = in.take<float>();
  if (harm == 28) view.origin[0] = in.take<double>();
  if (harm == 29) view.eye_to_clip[11] = 0, view.eye_to_clip[15] = 1;  // orthographic
  return view;
}

void run_here(void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
  for (std::uint32_t i = count; i-- > 0;) job(data, i);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  const std::unique_ptr<sightline_world, void (*)(sightline_world*)> world(sightline_world_create(),
                                                                           sightline_world_destroy);
  const std::unique_ptr<sightline_culler, void (*)(sightline_culler*)> culler(sightline_culler_create(),
                                                                              sightline_culler_destroy);
  const std::unique_ptr<sightline_occlusion, void (*)(sightline_occlusion*)> occlusion(
      sightline_occlusion_create(), sightline_occlusion_destroy);
  std::vector<sightline_handle> handles;
  std::size_t standing = 0;
  for (int step = 0; step < 200 && !in.empty(); ++step) {
    const std::uint8_t operation = in.byte() % 8;
    const std::size_t count = in.byte() % 40;
    std::vector<sightline_box> boxes(count);
    std::vector<sightline_handle> chosen(count);
    for (sightline_handle& h : chosen) {
      if (!handles.empty()) h = handles[in.take<std::uint16_t>() % handles.size()];
      if (in.byte() == 0) h = in.take<sightline_handle>();
    }
    if (operation < 3 || operation == 5) {
      for (sightline_box& box : boxes) box = box_of(in);
    }
    if (operation < 2) {
      std::vector<sightline_handle> added(count);
      if (sightline_world_insert(world.get(), boxes.data(), count, added.data()) == SIGHTLINE_OK) {
        handles.insert(handles.end(), added.begin(), added.end());
        standing += count;
      }
    } else if (operation == 2) {
      if (sightline_world_move(world.get(), chosen.data(), boxes.data(), count) == SIGHTLINE_OK) {
        for (std::size_t i = 0; i < count; ++i) require(sightline_world_contains(world.get(), chosen[i]));
      }
    } else if (operation == 3) {
      if (sightline_world_remove(world.get(), chosen.data(), count) == SIGHTLINE_OK) {
        for (const sightline_handle& h : chosen) require(!sightline_world_contains(world.get(), h));
        standing -= count;
      }
    } else if (operation == 4) {
      const sightline_view view = view_of(in);
      (void)sightline_occlusion_begin(occlusion.get(), &view);
    } else if (operation == 5) {
      (void)sightline_occlusion_draw_boxes(occlusion.get(), boxes.data(), count);
    } else if (operation == 6) {
      std::vector<float> positions(3 * count);
      std::vector<std::uint32_t> indices(3 * (in.byte() % 30));
      for (float& f : positions) f = static_cast<float>(in.number(1));
      for (std::uint32_t& i : indices) i = in.byte() % 44;
      float transform[12];
      for (float& f : transform) f = static_cast<float>(in.number(0.01));
      const std::unique_ptr<sightline_occluder_mesh, void (*)(sightline_occluder_mesh*)> mesh(
          sightline_occluder_mesh_create(positions.data(), count, indices.data(), indices.size()),
          sightline_occluder_mesh_destroy);
      if (mesh) (void)sightline_occlusion_draw_mesh(occlusion.get(), mesh.get(), transform);
    } else {
      std::vector<sightline_view> views(in.byte() % 10);
      for (sightline_view& view : views) view = view_of(in);
      std::vector<const sightline_occlusion*> buffers(views.size());
      for (auto& buffer : buffers) buffer = in.byte() & 1 ? occlusion.get() : nullptr;
      sightline_cull_options options{};
      options.threads = in.byte() % 70, options.run_jobs = run_here;
      options.min_area = static_cast<float>(in.number(1));
      options.occlusion = in.byte() & 1 ? buffers.data() : nullptr;
      const std::size_t room = sightline_cull_capacity(world.get(), &options) - (in.byte() == 0 ? 1 : 0);
      std::vector<std::uint32_t> ids(room);
      std::vector<std::uint8_t> masks(room);
      sightline_cull_result result;
      if (sightline_cull(culler.get(), world.get(), views.data(), views.size(), &options, ids.data(),
                         in.byte() & 1 ? masks.data() : nullptr, room, &result) == SIGHTLINE_OK) {
        require(result.count <= standing);
        for (std::size_t i = 0; i < result.count; ++i)
          require(ids[i] < sightline_world_id_limit(world.get()));
      }
    }
    require(sightline_world_size(world.get()) == standing);
  }
  return 0;
}
