// IWCPA, Ye et al. 2023, section 3.4: every ray against every box on the GPU, workgroups of 16 × 16.
#include <algorithm>

#include "workbench/methods/ray_pvs/ray_device_method.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kPairs[] =
#include "shaders/iwcpa_pairs.comp.inc"
    ;
constexpr std::uint32_t kIwcpaNearest[] =
#include "shaders/iwcpa_nearest.comp.inc"
    ;

struct PairsPush {
  vk::DeviceAddress rays, boxes, nearest;
  std::uint32_t ray_count, first_box, box_end, strip;
};
struct IwcpaNearestPush {
  vk::DeviceAddress nearest, hits, marks;
  std::uint32_t ray_count, rows, is_first, is_last;
};

constexpr std::uint32_t kGroup = 16;
constexpr std::uint32_t kRaysALane = 8;        // iwcpa_pairs.comp
constexpr std::uint32_t kStrip = 64 * kGroup;  // boxes to a workgroup
constexpr std::size_t kHitBytes = 8;
// Rows of lanes a round, so that many boxes need no more memory than this.
constexpr std::size_t kRoundBytes = std::size_t{16} << 20;

class Iwcpa final : public DeviceRays {
public:
  Iwcpa(device::Device& device, const Scene& scene)
      : DeviceRays(device, scene),
        pairs_(device, kPairs),
        nearest_(device, kIwcpaNearest),
        boxes_(device, scene.size() * sizeof(Box), device::Memory::upload, "boxes") {
    send();
  }

private:
  void send() override {
    const Boxes& boxes = targets_.solid();
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes_.mapped<Box>()[i] = boxes[i];
  }

  [[nodiscard]] std::uint32_t strips_a_round() const {
    const std::size_t a_strip = kGroup * kHitBytes * std::max<std::size_t>(rays_, 1);
    const std::size_t fit = std::max<std::size_t>(1, kRoundBytes / a_strip);
    const std::size_t all = (targets_.solid().size() + kStrip - 1) / kStrip;
    return static_cast<std::uint32_t>(std::min({fit, all, std::size_t{65535}}));
  }
  void prepare_more(const rays::RayGrid&) override {
    grow(partial_, strips_a_round() * kGroup * rays_ * kHitBytes, device::Memory::device, "nearest by lane");
  }

  void record_passes(const vk::raii::CommandBuffer& commands) override {
    const auto rays = static_cast<std::uint32_t>(rays_),
               boxes = static_cast<std::uint32_t>(targets_.solid().size());
    const std::uint32_t step = strips_a_round() * kStrip, across = kGroup * kRaysALane;
    for (std::uint32_t first = 0; first < boxes; first += step) {
      const std::uint32_t strips = (std::min(step, boxes - first) + kStrip - 1) / kStrip;
      dispatch(
          commands, pairs_,
          PairsPush{ray_buffer_.address(), boxes_.address(), partial_.address(), rays, first, boxes, kStrip},
          (rays + across - 1) / across, strips);
      dispatch(commands, nearest_,
               IwcpaNearestPush{partial_.address(), hits_.address(), marks_.address(), rays, strips * kGroup,
                                first == 0, boxes - first <= step},
               (rays + 255) / 256);
    }
  }

  device::ComputePipeline pairs_, nearest_;
  device::Buffer boxes_, partial_;
};

}  // namespace

std::unique_ptr<DeviceRays> make_iwcpa(device::Device& device, const Scene& scene) {
  return std::make_unique<Iwcpa>(device, scene);
}

extern const MethodInfo kIwcpa{
    .name = "iwcpa",
    .paper = kRayPaper,
    .summary = "100 x 100 rays, every ray and box at once on the GPU",
    .device = {Guarantee::approximate, kRayDeviceParameters, make_rays_on_device<make_iwcpa>}};

}  // namespace sightline::methods
