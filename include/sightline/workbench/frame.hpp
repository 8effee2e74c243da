// What a culling method hands over once a frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline {

/// Laid out as VkDrawIndexedIndirectCommand.
struct DrawCommand {
  std::uint32_t index_count = 0, instance_count = 0, first_index = 0;
  std::int32_t vertex_offset = 0;
  /// Position in Frame::visible of the first instance's object. Where the method draws a geometry of its own
  /// (Method::geometry), the first triangle of the range instead, of which there is one instance.
  std::uint32_t first_instance = 0;
  bool operator==(const DrawCommand&) const = default;
};

/// The work of one cull, in counts. Fields that make no sense for a method stay 0.
struct CullStats {
  std::uint64_t objects = 0;        ///< in
  std::uint64_t tested = 0;         ///< objects tested one by one
  std::uint64_t nodes_visited = 0;  ///< cells, chunks or tree nodes looked at
  std::uint64_t cull_vertices = 0;  ///< vertices fed to the culling pass
  std::uint64_t rays = 0;           ///< cast
  std::uint64_t culled_frustum = 0;
  std::uint64_t culled_contribution = 0;
  std::uint64_t culled_facing = 0;  ///< no triangle of theirs can face the eye
  std::uint64_t culled_occlusion = 0;
  std::uint64_t draw_calls = 0;
  std::uint64_t triangles = 0;  ///< submitted
};

/// Filled by Method::record, reused frame after frame so that nothing is allocated once it has grown.
struct Frame {
  std::vector<ObjectId> visible;  ///< grouped by mesh as `draws` wants it; each object at most once
  std::vector<DrawCommand> draws;
  bool one_by_one = false;  ///< each draw is a call of its own; else those of one state are one multi-draw
  CullStats stats;

  void clear() noexcept {
    visible.clear();
    draws.clear();
    one_by_one = false;
    stats = {};
  }
};

}  // namespace sightline
