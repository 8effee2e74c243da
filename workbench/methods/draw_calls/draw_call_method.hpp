// The frame of all methods of paper D: cells that the frustum touches, of them the batches that can face the
// eye or are not hidden, of them ranges of triangles, as draws.
#pragma once

#include <optional>
#include <vector>

#include "workbench/methods/draw_calls/blend_order.hpp"
#include "workbench/methods/draw_calls/draw_batches.hpp"
#include "workbench/methods/methods.hpp"
#include "workbench/methods/raster_occlusion/scene_occluders.hpp"

namespace sightline::methods {

/// How triangles are put in cells and cells are drawn.
struct DrawCallPlan {
  bool clusters = false;  ///< else a structure of some height
  partition::Structure structure = partition::Structure::octree;
  std::uint32_t height = 4;
  std::uint32_t cluster_size = 64;
  Strategy strategy = Strategy::drawcall_wise;
  FacingRule facing = FacingRule::none;
  Submission submission = Submission::calls;
  partition::CellRules cells = {};
  PartPlanes planes = PartPlanes::xz;  ///< of zhang's parts
  bool occlusion = false;              ///< what opaque triangles hide of visible cells is not drawn
  bool operator==(const DrawCallPlan&) const = default;
};

/// The arrays behind a TriangleGeometry.
struct TriangleLists {
  std::vector<Vec3> positions;
  std::vector<TextureCoordinate> texture_coordinates;
  std::vector<std::uint32_t> indices, sources;
  std::vector<ObjectId> objects;
};

class DrawCallMethod : public CpuMethod {
public:
  DrawCallMethod(const Scene& scene, const DrawCallPlan& plan);

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return plan_.facing == FacingRule::printed ? Guarantee::approximate : Guarantee::exact;
  }
  /// What moves is drawn whole from then on where its box is in view, at the cost of its own corners. Builds
  /// everything anew once a quarter of the objects move, or after give_lists().
  void do_update(std::span<const ObjectId> moved) override;
  void cull(const View& view, Frame& frame) noexcept override;
  [[nodiscard]] const TriangleGeometry* geometry() const noexcept override { return &geometry_; }

  [[nodiscard]] const DrawCallPlan& plan() const noexcept { return plan_; }
  /// Changes how the ranges are submitted, from the next cull on.
  void submit_by(Submission submission) noexcept { plan_.submission = geometry_.submission = submission; }
  /// Hands the triangles over, which cull() does without; geometry() is empty until the next update.
  [[nodiscard]] TriangleLists give_lists();
  /// Cells of the structure, for pictures: opaque triangles' first.
  [[nodiscard]] std::vector<Box> cells() const;

private:
  /// Opaque and transparent triangles apart: the latter are blended over the former, once each and far to
  /// near.
  struct Layer {
    partition::TrianglePartition partition;
    DrawBatches batches;
    /// Where there is occlusion, of each of the batches' objects what of it lies in the cell; of opaque ones.
    OccludeeTriangles occludees;
  };

  struct Mover {
    ObjectId object;
    TriangleRange range;  ///< all its triangles
  };

  /// How far an object came in a frame; what counts is the farthest.
  enum Reached : std::uint64_t { kNowhere, kInView, kNotHidden, kSubmitted };

  void rebuild();
  void describe();
  void place(ObjectId object);
  void add_mover(ObjectId object);
  static void build_occludees(const FlatTriangles& flat, Layer& layer);
  void reach(ObjectId object, Reached how_far, Frame& frame) noexcept;
  bool draw_occluders(const View& view, const Frustum& frustum) noexcept;
  void leave_out_hidden(const Layer& layer, Frame& frame) noexcept;
  void take_unhidden(const Layer& layer, Frame& frame) noexcept;
  void take_unhidden_of(const Layer& layer, std::uint32_t batch, Frame& frame) noexcept;
  void take_movers(const Frustum& frustum, bool transparent, Frame& frame) noexcept;
  void take(const Layer& layer, const Facing& facing, Frame& frame) noexcept;
  void merge() noexcept;
  void submit(Frame& frame) const noexcept;

  DrawCallPlan plan_;
  std::array<Layer, 2> layers_;
  BlendOrder blend_order_;
  TriangleLists lists_;
  TriangleGeometry geometry_;
  std::vector<Mover> movers_;
  std::vector<std::uint8_t> is_mover_;  ///< one an object
  /// Of each object and one past the last, once something has moved: where its corners and its triangles
  /// begin when all are counted through.
  std::vector<std::uint32_t> first_corner_, first_source_;

  std::optional<SceneOccluders> occluders_;  ///< where there is occlusion

  // of the frame
  bool hides_ = false;  ///< whether the occluders can be asked
  std::vector<ObjectId> candidates_;
  std::vector<partition::TrianglePartition::Run> runs_, seen_runs_;
  std::vector<TriangleRange> ranges_;
  std::vector<std::uint64_t> seen_;  ///< one an object: 4 · frame + Reached
  std::uint64_t frame_ = 0;
  std::uint64_t in_view_ = 0, not_hidden_ = 0;  ///< objects that came so far
};

}  // namespace sightline::methods
