// Which of a world's occluders a view draws: those that are large on the image, cheap, and belong to objects
// that were seen the last time; and the buffer they are drawn into.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/occlusion.hpp>
#include <sightline/world.hpp>

#include "library/world/account.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

class OccluderPicks {
public:
  enum class Drawn : std::uint8_t {
    some,
    nothing,   ///< there is nothing to draw
    too_dear,  ///< to look for any, or all that there are
  };
  /// Draws what pays of the occluders in view, for no more than `most` out of the purse. Distances are
  /// measured from `distance_eye`. `in_view` are the objects that the view sees by frustum and columns.
  Drawn draw(const WorldState& world, const CullView& view, const WorldPoint& distance_eye,
             std::span<const ObjectId> in_view, const OcclusionOptions& options, const CullCosts& costs,
             double most, Purse& purse);
  /// Whether meshes were drawn in parts and not to the end, in a buffer as fine as was asked for: coarse ones
  /// take more of the time than they hide.
  [[nodiscard]] bool worth_more() const noexcept;
  /// Draws on those, for no more than `most` out of the purse; the view is the same.
  void draw_on(const WorldState& world, const CullView& view, const WorldPoint& distance_eye,
               const CullCosts& costs, double most, Purse& purse);
  /// The caller's options, or coarser ones where to begin a buffer of theirs would take much of what is left.
  /// Coarse ones hide less, but most of what fine ones do.
  static OcclusionOptions affordable(const CullView& view, const OcclusionOptions& options,
                                     const CullCosts& costs, double left) noexcept;
  /// What beginning a view's buffer costs.
  static double begin_cost(const CullView& view, const OcclusionOptions& options,
                           const CullCosts& costs) noexcept;
  [[nodiscard]] const OcclusionBuffer& buffer() const noexcept { return buffer_; }
  /// The objects whose occluders are drawn there.
  [[nodiscard]] std::span<const ObjectId> drawn() const noexcept { return drawn_; }

  /// Told of what was seen in the end: begin, then each object that carries an occluder.
  void begin_seen() noexcept { seen_.clear(); }
  void saw(std::uint32_t carrier) { seen_.push_back(carrier); }

private:
  struct Pick {
    float score, distance;
    std::uint32_t carrier;
    bool parts;    // its mesh is drawn in parts
    bool cut;      // not to the end
    double whole;  // what all else of it costs
    double claim;  // what is put by for it; of parts first the least that is of use
    double most;   // that drawing all of it costs
  };
  struct Sight;

  void find(const Sight& sight, std::span<const ObjectId> in_view, Purse& purse);
  bool look_at(const Sight& sight, std::uint32_t carrier);
  double choose(double budget);
  double draw_one(const Sight& sight, Pick& pick, double spare);
  void draw_mesh(const OccluderMesh& mesh, const geometry::ExactAffine& placement);
  double draw_parts(const Sight& sight, Pick& pick, double left);
  void draw_boxes(const OccluderShape& shape, const OccluderPlacement& placement);
  void draw_spheres(const OccluderShape& shape, const geometry::ExactAffine& placement);

  OcclusionBuffer buffer_;
  OcclusionOptions options_;  // that it was begun with
  bool coarse_ = false;
  std::vector<std::uint32_t> seen_;  // carriers that were seen the last time
  std::vector<Pick> picks_;
  std::vector<ObjectId> drawn_;
  std::vector<WorldBox> boxes_;  // of the occluder at hand
  std::vector<Sphere> spheres_;
};

}  // namespace sightline::world
