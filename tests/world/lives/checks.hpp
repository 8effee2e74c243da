// Culls held against the model, and against each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "world/lives/model.hpp"
#include "world/lives/view_truth.hpp"

namespace sightline::lives {

/// Which columns a cull is asked for beside the ids.
struct Asked {
  bool masks = true, levels = false, fades = false;
};

/// What a cull wrote.
struct Answer {
  CullResult result;
  std::vector<std::uint32_t> ids;
  std::vector<std::uint8_t> masks, levels, fades;
};

/// Fails the test where the call is refused, or writes beyond its room.
Answer ask(Culler& culler, const World& world, std::span<const CullView> views, const CullOptions& options,
           const Asked& asked);
void expect_same(const Answer& expected, const Answer& found);

/// Masks by id, of ids that stand in the world and that are there once; all bits where no masks were asked
/// for.
std::vector<std::uint8_t> masks_by_id(const Model& model, std::span<const std::uint32_t> ids,
                                      std::span<const std::uint8_t> masks);

/// What is looked at, and by whom: a world, or an instance of one.
struct Sight {
  explicit Sight(std::span<const CullView> all);
  Sight(std::span<const CullView> all, const InstancePlacement& placement, std::uint32_t of_the_instance);

  std::span<const CullView> views;
  std::vector<ViewTruth> truths;
  std::uint32_t layers = kAllLayers;  // of the instance
};

/// Holds masks by id against brute force; where `masked` is false they only tell who is seen at all.
void expect_right(const Model& model, const Sight& sight, std::span<const std::uint8_t> masks, bool masked);
void expect_right(const Model& model, std::span<const CullView> views, const Answer& answer);

/// The levels that a key of a culler showed, which its next ones depend on.
class LevelMemory {
public:
  void expect_right(const Model& model, std::span<const CullView> views, const LevelOptions& options,
                    const Answer& answer);

private:
  struct Shown {
    std::uint32_t level = 0;
    std::uint64_t cull = 0;
  };
  std::vector<Shown> shown_;  // by id
  std::uint64_t culls_ = 1;
};

/// Holds a level that nothing but its size decides against brute force.
void expect_level(const Model& model, ObjectId id, const ViewTruth& truth, std::uint8_t level);

/// What a world says of some of its objects, and of handles that are stale.
void expect_objects(const World& world, const Model& model, std::span<const ObjectId> ids);

}  // namespace sightline::lives
