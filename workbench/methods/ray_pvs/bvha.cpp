// BVHA, Ye et al. 2023: the CPU walks the tree and collects candidate leaves, the GPU computes
// their distances and the nearest of each ray.
#include <chrono>

#include <algorithm>

#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/methods/ray_pvs/ray_device_method.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kDistances[] =
#include "shaders/bvha_distances.comp.inc"
    ;
constexpr std::uint32_t kBvhaNearest[] =
#include "shaders/bvha_nearest.comp.inc"
    ;

struct DistancesPush {
  vk::DeviceAddress rays, boxes, candidates, candidate_rays, distances;
  std::uint32_t count;
};
struct BvhaNearestPush {
  vk::DeviceAddress distances, first, hits, marks;
  std::uint32_t ray_count;
};

class Bvha final : public DeviceRays {
public:
  Bvha(device::Device& device, const Scene& scene)
      : DeviceRays(device, scene),
        distances_(device, kDistances),
        nearest_(device, kBvhaNearest),
        boxes_(device, scene.size() * sizeof(Box), device::Memory::upload, "boxes") {
    bvh_.build(targets_.solid());
    send();
  }

private:
  void send() override {
    const Boxes& boxes = targets_.solid();
    bvh_.refit(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes_.mapped<Box>()[i] = boxes[i];
  }

  void prepare_more(const rays::RayGrid& grid) override {
    using Clock = std::chrono::steady_clock;
    const auto ms = [](auto from, auto to) {
      return std::chrono::duration<double, std::milli>(to - from).count();
    };
    const auto start = Clock::now();
    methods::collect_candidates(bvh_, grid.prepared, candidates_);
    const auto collected = Clock::now();
    const std::size_t count = candidates_.objects.size();
    grow(objects_, count * 4, device::Memory::upload, "candidates");
    grow(owners_, count * 4, device::Memory::upload, "candidates' rays");
    grow(first_, candidates_.first.size() * 4, device::Memory::upload, "candidates' ranges");
    grow(found_, count * 8, device::Memory::device, "candidates' distances");
    std::ranges::copy(candidates_.objects, objects_.mapped<std::uint32_t>());
    std::ranges::copy(candidates_.first, first_.mapped<std::uint32_t>());
    auto* owner = owners_.mapped<std::uint32_t>();
    for (std::uint32_t r = 0; r < rays_; ++r) {
      std::fill(owner + candidates_.first[r], owner + candidates_.first[r + 1], r);
    }
    cpu_ms_ += ms(start, collected);
    upload_ms_ += ms(collected, Clock::now());
  }

  void record_passes(const vk::raii::CommandBuffer& commands) override {
    const auto rays = static_cast<std::uint32_t>(rays_);
    const auto count = static_cast<std::uint32_t>(candidates_.objects.size());
    if (count > 0) {
      const std::uint32_t groups = (count + 255) / 256, across = std::min(groups, 65535u);
      dispatch(commands, distances_,
               DistancesPush{ray_buffer_.address(), boxes_.address(), objects_.address(), owners_.address(),
                             found_.address(), count},
               across, (groups + across - 1) / across);
    }
    dispatch(commands, nearest_,
             BvhaNearestPush{found_.address(), first_.address(), hits_.address(), marks_.address(), rays},
             (rays + 255) / 256);
  }

  rays::Bvh bvh_;
  methods::Candidates candidates_;
  device::ComputePipeline distances_, nearest_;
  device::Buffer boxes_, objects_, owners_, first_, found_;
};

}  // namespace

std::unique_ptr<DeviceRays> make_bvha(device::Device& device, const Scene& scene) {
  return std::make_unique<Bvha>(device, scene);
}

extern const MethodInfo kBvha{
    .name = "bvha",
    .paper = kRayPaper,
    .summary = "100 x 100 rays, the tree on the CPU and the distances on the GPU",
    .device = {Guarantee::approximate, kRayDeviceParameters, make_rays_on_device<make_bvha>}};

}  // namespace sightline::methods
