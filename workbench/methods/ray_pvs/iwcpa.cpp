// IWCPA, Ye et al. 2023: every ray against every box on the GPU, workgroups of 16 × 16; as it is printed, and
// tuned.
#include <algorithm>
#include <array>

#include "workbench/methods/ray_pvs/ray_device_method.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kPairs[] =
#include "shaders/iwcpa_pairs.comp.inc"
    ;
constexpr std::uint32_t kIwcpaNearest[] =
#include "shaders/iwcpa_nearest.comp.inc"
    ;
constexpr std::uint32_t kIwcpaDistances[] =
#include "shaders/iwcpa_distances.comp.inc"
    ;
constexpr std::uint32_t kIwcpaColumns[] =
#include "shaders/iwcpa_columns.comp.inc"
    ;

struct PairsPush {
  vk::DeviceAddress rays, boxes, nearest;
  std::uint32_t ray_count, first_box, box_end, strip;
};
struct IwcpaNearestPush {
  vk::DeviceAddress nearest, hits, marks;
  std::uint32_t ray_count, rows, is_first, is_last;
};
struct IwcpaDistancesPush {
  vk::DeviceAddress rays, boxes, distances;
  std::uint32_t ray_count, first_ray, first_box, box_end;
};
struct IwcpaColumnsPush {
  vk::DeviceAddress distances, hits, marks;
  std::uint32_t ray_count, first_box, box_end, is_last;
};

constexpr std::uint32_t kGroup = 16;
constexpr std::uint32_t kRaysALane = 8;        // iwcpa_pairs.comp
constexpr std::uint32_t kStrip = 64 * kGroup;  // boxes to a workgroup
constexpr std::size_t kHitBytes = 8;
// Of a round, so that many boxes need no more memory than this.
constexpr std::size_t kRoundBytes = std::size_t{16} << 20;

// What both mappings send.
class IwcpaBoxes : public DeviceRays {
protected:
  IwcpaBoxes(device::Device& device, const Scene& scene)
      : DeviceRays(device, scene),
        boxes_(device, scene.size() * sizeof(Box), device::Memory::upload, "boxes") {
    IwcpaBoxes::send();
  }

  void send() final {
    const Boxes& boxes = targets_.solid();
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes_.mapped<Box>()[i] = boxes[i];
  }

  device::Buffer boxes_;
};

// A lane takes eight rays and many boxes, and keeps the nearest to itself.
class TunedIwcpa final : public IwcpaBoxes {
public:
  TunedIwcpa(device::Device& device, const Scene& scene)
      : IwcpaBoxes(device, scene), pairs_(device, kPairs), nearest_(device, kIwcpaNearest) {}

private:
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
  device::Buffer partial_;
};

// A lane takes one pair and leaves its distance in memory.
class PrintedIwcpa final : public IwcpaBoxes {
public:
  PrintedIwcpa(device::Device& device, const Scene& scene)
      : IwcpaBoxes(device, scene), distances_(device, kIwcpaDistances), columns_(device, kIwcpaColumns) {}

private:
  [[nodiscard]] std::uint32_t boxes_a_round() const {
    const std::size_t fit =
        std::max<std::size_t>(1, kRoundBytes / (sizeof(float) * std::max<std::size_t>(rays_, 1)));
    return static_cast<std::uint32_t>(std::min(fit, targets_.solid().size()));
  }
  void prepare_more(const rays::RayGrid&) override {
    grow(found_, std::size_t{boxes_a_round()} * rays_ * sizeof(float), device::Memory::device, "distances");
  }

  void record_passes(const vk::raii::CommandBuffer& commands) override {
    const auto rays = static_cast<std::uint32_t>(rays_),
               boxes = static_cast<std::uint32_t>(targets_.solid().size());
    const std::uint32_t step = boxes_a_round();
    // As many rays as stand side by side: fewer than all only where a device takes no more workgroups.
    const std::uint32_t widest = kGroup * std::min((rays + kGroup - 1) / kGroup, device_.widest_dispatch());
    for (std::uint32_t first = 0; first < boxes; first += step) {
      const std::uint32_t end = std::min(boxes, first + step);
      for (std::uint32_t ray = 0; ray < rays; ray += widest) {
        dispatch(commands, distances_,
                 IwcpaDistancesPush{ray_buffer_.address(), boxes_.address(), found_.address(), rays, ray,
                                    first, end},
                 widest / kGroup, (end - first + kGroup - 1) / kGroup);
      }
      dispatch(commands, columns_,
               IwcpaColumnsPush{found_.address(), hits_.address(), marks_.address(), rays, first, end,
                                end == boxes},
               (rays + 255) / 256);
    }
  }

  device::ComputePipeline distances_, columns_;
  device::Buffer found_;
};

constexpr std::array kIwcpaParameters{kRaysParameter};

template <std::unique_ptr<DeviceRays> (*kMake)(device::Device&, const Scene&)>
std::unique_ptr<Method> make_iwcpa_method(const MethodSite& site, const Parameters& parameters) {
  return make_ray_device_method(*site.renderer, parameters, kMake(site.renderer->device(), site.scene));
}

}  // namespace

std::unique_ptr<DeviceRays> make_iwcpa(device::Device& device, const Scene& scene) {
  return std::make_unique<PrintedIwcpa>(device, scene);
}
std::unique_ptr<DeviceRays> make_tuned_iwcpa(device::Device& device, const Scene& scene) {
  return std::make_unique<TunedIwcpa>(device, scene);
}

extern const MethodInfo kIwcpa{
    .name = "iwcpa",
    .paper = kRayPaper,
    .summary = "100 x 100 rays, every ray and box at once on the GPU",
    .device = {Guarantee::approximate, kIwcpaParameters, make_iwcpa_method<make_iwcpa>}};
extern const MethodInfo kTunedIwcpa{
    .name = "tuned-iwcpa",
    .paper = "",
    .summary = "the set of iwcpa, where a lane keeps the nearest of many boxes to itself",
    .device = {Guarantee::approximate, kIwcpaParameters, make_iwcpa_method<make_tuned_iwcpa>}};

}  // namespace sightline::methods
