// The oracle of the rasteriser: what a device draws when it is told to draw everything.
#include <map>
#include <optional>
#include <utility>

#include "workbench/device/view_data.hpp"
#include "workbench/oracle/all_triangles.hpp"
#include "workbench/oracle/oracle.hpp"
#include "workbench/oracle/raster_item_buffer.hpp"

namespace sightline::oracle {

namespace {

// A picture with its depths, and the other picture that it may as well be: all triangles in one order and in
// the other.
struct Reference {
  device::Picture picture, other;
  std::vector<float> depth;
};

// Where opaque surfaces lie at one depth the two orders differ, and any of those surfaces may show.
std::uint64_t count_different(const device::Picture& picture, const std::vector<float>& depth,
                              const Reference& reference) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const bool equal_depth =
        reference.picture.pixels[i] != reference.other.pixels[i] && depth[i] == reference.depth[i];
    count += picture.pixels[i] != reference.picture.pixels[i] && !equal_depth;
  }
  return count;
}

class RasterOracle final : public Oracle {
public:
  explicit RasterOracle(device::Renderer& renderer)
      : renderer_(renderer),
        objects_(renderer),
        flags_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "flags"),
        everything_(renderer.draws().make_buffers(renderer.device())) {}

  const ItemBuffer& look(const View& view) override {
    if (seen_ != view) {
      truth_ = objects_.render(view);
      seen_ = view;
    }
    return truth_;
  }

  Judgement judge(const View& view, const Answer& answer) override {
    Judgement out;
    if (answer.geometry) {
      AllTriangles& all = triangles_of(*answer.geometry);
      out = hold(all.look(view), view, answer, [&](const View& again) { return all.look(again); });
    } else {
      out = hold(look(view), view, answer, [&](const View& again) { return objects_.render(again); });
    }
    if (answer.picture)
      out.different_pixels =
          count_different(*answer.picture, *answer.depth, reference(view, answer.geometry));
    return out;
  }

  void update(std::span<const ObjectId> objects) override {
    if (objects.empty()) return;
    triangles_.clear();
    seen_.reset();
    drawn_.reset();
  }

private:
  // What is lost is looked at again with a depth that tells surfaces apart: where the view's own rounds what
  // stands behind a wall and the wall to one, the rasteriser may show either.
  template <class Look>
  static Judgement hold(const ItemBuffer& truth, const View& view, const Answer& answer,
                        const Look& look_at) {
    Loss loss = compare_to_truth(truth, answer.frame.visible);
    if (const auto denser = loss.lost.empty() ? std::nullopt : device::with_denser_depth(view))
      loss = confirmed_loss(truth, look_at(*denser), answer.frame.visible);
    return {std::move(loss), truth.visible_count()};
  }

  AllTriangles& triangles_of(const TriangleGeometry& geometry) {
    return triangles_.try_emplace(&geometry, renderer_, geometry).first->second;
  }

  const Reference& reference(const View& view, const TriangleGeometry* geometry) {
    if (geometry) {
      AllTriangles& all = triangles_of(*geometry);
      own_.other = all.picture(view, AllTriangles::Order::falling);
      own_.picture = all.picture(view, AllTriangles::Order::rising);
      own_.depth = renderer_.depth();
      return own_;
    }
    if (drawn_ != view) {
      draw_everything(view);
      scene_.picture = scene_.other = renderer_.picture();
      scene_.depth = renderer_.depth();
      drawn_ = view;
    }
    return scene_;
  }

  void draw_everything(const View& view) {
    renderer_.frame(view, [&](device::Recorder& frame) {
      renderer_.draws().build(frame, flags_.address(), device::VisibleDraws::kAll,
                              renderer_.transparent_order(), everything_);
      renderer_.draw_solid(frame, everything_, device::Renderer::Style::lit, device::Renderer::Clear::both);
      renderer_.draw_rest(frame, everything_);
    });
  }

  device::Renderer& renderer_;
  RasterItemBuffer objects_;
  device::Buffer flags_;
  device::DrawBuffers everything_;
  std::map<const TriangleGeometry*, AllTriangles> triangles_;  ///< of each method that draws its own
  std::optional<View> seen_, drawn_;                           ///< what `truth_` and `scene_` are of
  ItemBuffer truth_;
  Reference scene_, own_;
};

}  // namespace

std::unique_ptr<Oracle> make_raster_oracle(device::Renderer& renderer) {
  return std::make_unique<RasterOracle>(renderer);
}

}  // namespace sightline::oracle
