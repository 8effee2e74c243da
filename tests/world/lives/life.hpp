// A long life of a world: what stands where, who lives it beside the model, and how anything random is made.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sightline/inspect.hpp>
#include <sightline/instances.hpp>
#include <sightline/ranges.hpp>
#include <sightline/snapshot.hpp>

#include "world/lives/checks.hpp"

namespace sightline::lives {

/// An instance of the lane's own world.
struct Placed {
  Handle handle;
  InstancePlacement placement;
  std::uint32_t layers = kAllLayers;
};

/// A world that lives the life, and what reads it.
struct Lane {
  enum Kind : std::uint8_t {
    first,   ///< which the model is held against
    twin,    ///< culls in jobs, and must say the same to the bit
    loaded,  ///< came out of a snapshot of the first one
  };
  explicit Lane(Kind of_kind) : kind(of_kind) {}

  Kind kind;
  World world;
  std::array<Culler, 2> cullers;
  std::array<std::array<LevelMemory, kMaxViews>, 2> memory;  // by culler and key
  Culler plain, automatic;
  double cost = 0, frustum_cost = 0;  // of all that `automatic` culled
  ObjectOrder order;
  std::vector<ObjectId> slots;  // as reports of the order tell
  RangeCuller ranger;
  CullInspector inspector;
  Instances instances;
  PlacedWorldId placed_world = kNoPlacedWorld;
  std::vector<Placed> placed;
  InstanceCuller instance_culler;
  OccluderId occluder = kNoOccluder;
};

/// The bytes that a stream brings the first lane's world in from.
struct Streaming {
  std::vector<std::byte> bytes;
  std::optional<WorldStream> stream;
  std::size_t budget = 0;
};

/// What one life is like.
struct Plan {
  std::uint32_t objects = 0;  // that it may grow to
  std::uint32_t steps = 0;
  double radius = 0;  // metres, of each place where things happen
  double away = 0;    // metres, of the first place from 0
  double size = 0;    // metres, of most boxes at most
  bool huge = false, columns = false, occluders = false, streams = false;
};

/// Boxes in one of the forms that callers keep them in.
struct LaidOut {
  BoxView view;
  std::vector<WorldBox> given;  // what the view tells, by our own arithmetic
  std::vector<float> floats;
};

class Life {
public:
  explicit Life(Random& from);
  /// Stops at the first step that fails, and names it.
  void live();

  [[nodiscard]] Lane& first() { return *lanes.front(); }
  [[nodiscard]] World& world() { return first().world; }
  /// Fails the test where a lane refuses.
  template <class Change>
  void each(const Change& change) {
    for (const std::unique_ptr<Lane>& lane : lanes) {
      const Status done = change(*lane);
      ASSERT_TRUE(done) << done.message() << ' ' << done.index() << " in lane " << int{lane->kind};
    }
  }
  void add_lane(std::unique_ptr<Lane> lane);
  /// Sectors in which something changed stay in a stream's world.
  void note_change(const std::vector<ObjectId>& ids) {
    for (const ObjectId id : ids) model.objects[id].changed = streaming.has_value();
  }

  [[nodiscard]] WorldPoint any_point();
  /// Somewhere, or around a point.
  [[nodiscard]] WorldBox any_box(const WorldPoint* near = nullptr);
  [[nodiscard]] LaidOut lay_out(std::vector<WorldBox> boxes);
  [[nodiscard]] std::uint32_t any_layers();
  [[nodiscard]] DistanceRange any_range();
  [[nodiscard]] WorldView any_view();
  /// A few, some of them the same; `plain` ones drop nothing but what lies outside them.
  [[nodiscard]] std::vector<CullView> any_views(bool plain);
  [[nodiscard]] JobSystem any_jobs();

  Random& random;
  Plan plan;
  std::vector<WorldPoint> places;
  Model model;
  std::vector<std::unique_ptr<Lane>> lanes;
  std::optional<Streaming> streaming;  // behind the lanes, whose world must outlive it
  std::vector<ObjectId> crew;          // who moves again and again
};

}  // namespace sightline::lives
