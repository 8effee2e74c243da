#include "workbench/methods/ray_pvs/device_rays.hpp"

#include <algorithm>
#include <chrono>

namespace sightline::methods {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// RayData in shaders/rays.h.
struct RayData {
  Vec3 origin;
  float max_distance;
  Vec3 inverse;
  float pad = 0;
};
static_assert(sizeof(RayData) == 32);

struct Hit {
  std::uint32_t object;
  float distance;
};

constexpr std::uint32_t kSeeThroughShader[] =
#include "shaders/see_through.comp.inc"
    ;

struct SeeThroughPush {
  vk::DeviceAddress rays, nodes, hits, slot_objects, slot_marks, marks;
  std::uint32_t ray_count, node_count, slot_count;
};

}  // namespace

DeviceRays::DeviceRays(device::Device& device, const Scene& scene)
    : device_(device),
      scene_(scene),
      targets_(scene),
      marks_(device, scene.size() * 4, device::Memory::readback, "marks"),
      see_through_(device, kSeeThroughShader) {
  if (!targets_.mixed()) return;
  object_marks_ = device::Buffer(device, scene.size() * 4, device::Memory::readback, "marks");
  slot_objects_ = upload_bytes(device, std::as_bytes(targets_.solid_ids()), "what stops rays");
  see_through_nodes_ = device::Buffer(device, targets_.see_through().size_bytes(), device::Memory::upload,
                                      "what rays go through");
  send_see_through();
}

void DeviceRays::send_see_through() {
  if (targets_.mixed()) std::ranges::copy(targets_.see_through(), see_through_nodes_.mapped<rays::BvhNode>());
}

void DeviceRays::update() {
  targets_.update();
  send_see_through();
  send();
}

void DeviceRays::grow(device::Buffer& buffer, std::size_t bytes, device::Memory memory,
                      std::string_view what) {
  if (buffer.size() < bytes) buffer = device::Buffer(device_, bytes, memory, what);
}

void DeviceRays::prepare(const rays::RayGrid& grid) {
  cpu_ms_ = 0;
  rays_ = grid.size();
  grow(ray_buffer_, rays_ * sizeof(RayData), device::Memory::upload, "rays");
  grow(hits_, rays_ * sizeof(Hit), device::Memory::readback, "hits");
  const auto start = Clock::now();
  auto* out = ray_buffer_.mapped<RayData>();
  for (std::size_t r = 0; r < rays_; ++r) {
    const PreparedRay& ray = grid.prepared[r];
    out[r] = {ray.origin, ray.max_distance, ray.inverse};
  }
  upload_ms_ = ms_since(start);
  prepare_more(grid);
}

void DeviceRays::record(const vk::raii::CommandBuffer& commands) {
  commands.fillBuffer(marks_.handle(), 0, scene_.size() * 4, 0);
  if (targets_.mixed()) commands.fillBuffer(object_marks_.handle(), 0, scene_.size() * 4, 0);
  device::full_barrier(commands);
  if (rays_ == 0) return;
  if (targets_.solid().size() == 0) {
    commands.fillBuffer(hits_.handle(), 0, rays_ * sizeof(Hit), kNoObject);
    device::full_barrier(commands);
  } else {
    record_passes(commands);
  }
  if (!targets_.mixed()) return;
  const auto count = static_cast<std::uint32_t>(rays_);
  dispatch(commands, see_through_,
           SeeThroughPush{ray_buffer_.address(), see_through_nodes_.address(), hits_.address(),
                          slot_objects_.address(), marks_.address(), object_marks_.address(), count,
                          static_cast<std::uint32_t>(targets_.see_through().size()),
                          static_cast<std::uint32_t>(targets_.solid_ids().size())},
           (count + 255) / 256);
}

void DeviceRays::cast(const rays::RayGrid& grid, rays::RayHits& hits, DeviceRayTimes* times) {
  prepare(grid);
  const auto compute = Clock::now();
  device_.run([&](const vk::raii::CommandBuffer& commands) { record(commands); });
  const double compute_ms = ms_since(compute);
  const auto read_back = Clock::now();
  hits.reset(rays_);
  const Hit* in = hits_.mapped<Hit>();
  for (std::size_t r = 0; r < rays_; ++r) {
    hits.object[r] = in[r].object;
    hits.distance[r] = in[r].object == kNoObject ? -1 : in[r].distance;
    hits.stats.hits += in[r].object != kNoObject;
  }
  if (times) *times = {cpu_ms_, upload_ms_, compute_ms, ms_since(read_back)};
}

}  // namespace sightline::methods
