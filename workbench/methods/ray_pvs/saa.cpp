// SAA, Ye et al. 2023, section 3.4.3: the tree laid flat with skip counts, one ray a lane, 256 lanes a
// workgroup.
#include <algorithm>

#include "library/rays/bvh.hpp"
#include "workbench/methods/ray_pvs/ray_device_method.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kSaaShader[] =
#include "shaders/saa.comp.inc"
    ;

struct SaaPush {
  vk::DeviceAddress rays, nodes, hits, marks;
  std::uint32_t ray_count, node_count;
};

class Saa final : public DeviceRays {
public:
  Saa(device::Device& device, const Scene& scene) : DeviceRays(device, scene), pipeline_(device, kSaaShader) {
    bvh_.build(targets_.solid());
    nodes_ = device::Buffer(device, bvh_.nodes().size_bytes(), device::Memory::upload, "the flattened tree");
    send();
  }

private:
  void send() override {
    bvh_.refit(targets_.solid());
    std::ranges::copy(bvh_.nodes(), nodes_.mapped<rays::BvhNode>());
  }

  void record_passes(const vk::raii::CommandBuffer& commands) override {
    const auto rays = static_cast<std::uint32_t>(rays_);
    dispatch(commands, pipeline_,
             SaaPush{ray_buffer_.address(), nodes_.address(), hits_.address(), marks_.address(), rays,
                     static_cast<std::uint32_t>(bvh_.nodes().size())},
             (rays + 255) / 256);
  }

  rays::Bvh bvh_;
  device::ComputePipeline pipeline_;
  device::Buffer nodes_;
};

}  // namespace

std::unique_ptr<DeviceRays> make_saa(device::Device& device, const Scene& scene) {
  return std::make_unique<Saa>(device, scene);
}

extern const MethodInfo kSaa{
    .name = "saa",
    .paper = kRayPaper,
    .summary = "100 x 100 rays, one a lane, down a tree laid flat with skip counts",
    .device = {Guarantee::approximate, kRayDeviceParameters, make_rays_on_device<make_saa>}};

}  // namespace sightline::methods
