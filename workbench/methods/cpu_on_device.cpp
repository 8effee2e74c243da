// Any CPU method, drawn by the renderer.
#include <algorithm>
#include <ranges>

#include "workbench/device/triangle_draws.hpp"
#include "workbench/methods/device_method.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

class CpuOnDevice final : public DeviceMethod {
public:
  CpuOnDevice(std::unique_ptr<Method> method, device::Renderer& renderer)
      : renderer_(renderer), method_(std::move(method)) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return method_->guarantee(); }
  void update(std::span<const ObjectId> objects) override { method_->update(objects); }
  void took(double milliseconds) noexcept override { method_->took(milliseconds); }

  void record(device::Recorder& frame) override {
    method_->cull(frame.view, frame_);
    const auto pass = frame.pass("draw", device::PassKind::draw);
    renderer_.draw(frame, frame_.visible, frame_.draws);
  }

  void read_back(Frame& frame) override {
    frame = frame_;
    std::ranges::sort(frame.visible);
    frame.draws.clear();
  }

private:
  device::Renderer& renderer_;
  std::unique_ptr<Method> method_;
  Frame frame_;
};

/// Draws ranges of the method's own triangles.
class TrianglesOnDevice final : public DeviceMethod {
public:
  TrianglesOnDevice(std::unique_ptr<Method> method, device::Renderer& renderer)
      : renderer_(renderer), method_(std::move(method)), draw_list_(renderer.scene()) {
    take_over();
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return method_->guarantee(); }
  void update(std::span<const ObjectId> objects) override {
    if (objects.empty()) return;
    method_->update(objects);
    take_over();
  }
  void took(double milliseconds) noexcept override { method_->took(milliseconds); }

  void record(device::Recorder& frame) override {
    method_->cull(frame.view, frame_);
    const auto pass = frame.pass("draw", device::PassKind::draw);
    triangles_->draw(frame, frame_.draws, method_->geometry()->submission);
  }

  void read_back(Frame& frame) override {
    frame = frame_;
    std::ranges::sort(frame.visible);
    frame.draws.clear();
  }

  bool record_everything(device::Recorder& frame, Order order) override {
    const auto pass = frame.pass("draw", device::PassKind::draw);
    triangles_->draw(frame, everything(frame.view, order), Submission::calls);
    return true;
  }

  std::optional<std::vector<ObjectId>> everything_seen(const View& view) override {
    return triangles_->item_buffer(view, everything(view, Order::rising), Submission::calls);
  }

private:
  /// Copies the geometry to the device, and finds each object's triangles in it.
  void take_over() {
    const TriangleGeometry& geometry = *method_->geometry();
    triangles_.reset();
    triangles_.emplace(renderer_, geometry);
    const Scene& scene = renderer_.scene();
    std::vector<std::uint32_t> at(triangle_count(scene), kNowhere);  // of each triangle the first copy
    for (std::uint32_t t = static_cast<std::uint32_t>(geometry.sources.size()); t-- > 0;)
      at[geometry.sources[t]] = t;
    ranges_.assign(scene.size(), {});
    std::uint32_t source = 0;
    for (ObjectId object = 0; object < scene.size(); ++object) {
      std::vector<DrawCommand>& ranges = ranges_[object];
      for (std::size_t i = 0; i < scene.triangles(object); ++i, ++source) {
        const std::uint32_t t = at[source];
        if (t == kNowhere) continue;
        if (!ranges.empty() && ranges.back().first_instance + ranges.back().index_count / 3 == t) {
          ranges.back().index_count += 3;
        } else {
          ranges.push_back({3, 1, 3 * t, 0, t});
        }
      }
    }
  }

  /// The same triangles, each in a draw of its own, the last first.
  static std::vector<DrawCommand> turned_round(std::span<const DrawCommand> draws) {
    std::vector<DrawCommand> out;
    for (const DrawCommand& draw : std::views::reverse(draws)) {
      for (std::uint32_t t = draw.index_count / 3; t-- > 0;)
        out.push_back({3, 1, draw.first_index + 3 * t, draw.vertex_offset, draw.first_instance + t});
    }
    return out;
  }

  /// Every triangle once: opaque ones in that order, then transparent ones far to near.
  std::vector<DrawCommand> everything(const View& view, Order order) {
    const Scene& scene = renderer_.scene();
    const auto blended = [&](ObjectId object) { return scene.surface[object] == Surface::transparent; };
    Frame all;
    for (ObjectId object = 0; object < scene.size(); ++object) {
      if (blended(object)) all.visible.push_back(object);
    }
    draw_list_.build(scene, view, all);
    std::vector<DrawCommand> draws;
    const auto draw = [&](ObjectId object) {
      draws.insert(draws.end(), ranges_[object].begin(), ranges_[object].end());
    };
    for (ObjectId object = 0; object < scene.size(); ++object) {
      if (!blended(object)) draw(object);
    }
    if (order == Order::falling) draws = turned_round(draws);
    std::ranges::for_each(all.visible, draw);
    return draws;
  }

  static constexpr std::uint32_t kNowhere = 0xffffffff;

  device::Renderer& renderer_;
  std::unique_ptr<Method> method_;
  std::optional<device::TriangleDraws> triangles_;
  submission::DrawList draw_list_;
  std::vector<std::vector<DrawCommand>> ranges_;  ///< by object
  Frame frame_;
};

}  // namespace

std::unique_ptr<DeviceMethod> draw_by_device(std::unique_ptr<Method> method, device::Renderer& renderer) {
  if (method->geometry()) return std::make_unique<TrianglesOnDevice>(std::move(method), renderer);
  return std::make_unique<CpuOnDevice>(std::move(method), renderer);
}

}  // namespace sightline::methods
