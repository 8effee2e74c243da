// What a cull did and why, for whoever tunes or debugs it: numbers a view, and shapes to be drawn. Who does
// not ask pays nothing, for nothing is counted in culls themselves: an inspection looks again.
//
//   sightline::CullInspector inspector;
//   const auto looked = inspector.inspect(world, {&view, 1});
//   if (looked)
//     for (const sightline::DebugBox& box : looked->boxes) draw_lines(box.box, colour_of(box));
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/occlusion.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>
#include <sightline/world.hpp>

namespace sightline {

/// What one view of a cull looked at. Chunks are groups of fewer than a hundred neighbours; each chunk and
/// each object of the groups in view counts once, under the first that drops it, in the order given here.
struct ViewStats {
  std::uint64_t sectors = 0;          ///< of the world, that hold an object
  std::uint64_t sectors_in_view = 0;  ///< of these
  std::uint64_t groups = 0;           ///< of up to 32 chunks, that the view does not miss

  std::uint64_t chunks = 0;          ///< of these groups: the sum of the next five
  std::uint64_t chunks_outside = 0;  ///< of the frustum
  std::uint64_t chunks_dropped = 0;  ///< as a whole, by layers, distances or casters
  std::uint64_t chunks_hidden = 0;   ///< as a whole, by occlusion
  std::uint64_t chunks_whole = 0;    ///< that the view sees without a look at their objects
  std::uint64_t chunks_opened = 0;   ///< of which objects were tested one by one
  std::uint64_t objects_tested = 0;  ///< in the chunks that were opened, holes among them

  std::uint64_t objects = 0;       ///< of these groups: the sum of the next seven
  std::uint64_t outside = 0;       ///< of the frustum
  std::uint64_t by_layers = 0;     ///< dropped by layers
  std::uint64_t by_distances = 0;  ///< dropped by distances
  std::uint64_t by_casters = 0;    ///< dropped, for their shadows cannot be seen
  std::uint64_t by_area = 0;       ///< dropped by `min_area`
  std::uint64_t hidden = 0;        ///< that only occlusion drops
  std::uint64_t visible = 0;       ///< that the cull wrote with this view's bit
  bool operator==(const ViewStats&) const = default;
};

/// What a box to be drawn is.
enum class DebugBoxKind : std::uint8_t {
  sector,    ///< what a sector's objects lie in
  chunk,     ///< what a chunk's objects lie in, of the groups that some view does not miss
  occluder,  ///< an object whose occluder automatic occlusion has drawn
};

/// A box to be drawn.
struct DebugBox {
  WorldBox box;                              ///< metres
  DebugBoxKind kind = DebugBoxKind::sector;  ///< what it is
  std::uint8_t seen = 0;                     ///< bit v: view v may see some of it; of occluders, drew it
  std::uint8_t whole = 0;                    ///< bit v: of chunks, view v sees all of it, untested
  std::uint32_t objects = 0;                 ///< how many it holds; of occluders, the object's id
};

/// What an inspection found. The spans lie in the inspector until its next one.
struct Inspection {
  std::span<const ViewStats> views;  ///< one a view
  std::span<const DebugBox> boxes;   ///< sectors, then chunks, then occluders
};

/// Looks into culls.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: one at a time. Allocates: nothing.
class CullInspector {
public:
  /// Allocates: its first tables.
  CullInspector();
  ~CullInspector();
  CullInspector(CullInspector&&) noexcept;
  CullInspector& operator=(CullInspector&&) noexcept;

  /// What Culler::cull() does for these views, in the same order whenever it is called. With a `culler` that
  /// has culled these views with automatic occlusion, what its last such cull drew for them hides, too: all
  /// that it hides counts as hidden, though a cull asks no more than it can afford; objects' own triangles
  /// are not asked. Errors: as of cull(): bad_argument, bad_view, stale_buffer; index() is the view's. Cost:
  /// some times a cull's. Threads: only reads the world, the buffers and the culler, which must not cull
  /// meanwhile. Allocates: nothing once it has seen its largest view.
  Result<Inspection> inspect(const World& world, std::span<const CullView> views,
                             const Culler* culler = nullptr);

private:
  struct State;
  State* state_;
};

/// The corners of what a view sees, in metres: those of the near plane (bottom left, bottom right, top left,
/// top right, as on the image), then those of the far plane, or of `farthest` metres along the view where
/// that is nearer; infinity: those of the far plane.
/// Errors: bad_view; bad_argument where `farthest` is not beyond the near plane, or infinite where the view
/// has no far plane. Cost: constant. Threads: any. Allocates: nothing.
Result<std::array<WorldPoint, 8>> view_corners(const WorldView& view, double farthest) noexcept;

/// Writes a buffer's depth as a picture, row by row from the top, a byte a pixel of the view: from 255 for
/// the nearest occluder to 55 for the farthest, by the logarithm of their distance in a perspective view; 0
/// where there is none. Errors: stale_buffer before begin(); buffer_too_small. Cost: linear in the pixels.
/// Threads: only reads the buffer. Allocates: 4 bytes a pixel.
Status depth_image(const OcclusionBuffer& buffer, std::span<std::uint8_t> pixels);
/// The same of what the last cull with automatic occlusion drew for the view at this place of its call.
/// Errors: the same; stale_buffer, too, where it drew nothing. Cost, Threads, Allocates: the same.
Status depth_image(const Culler& culler, std::size_t place, std::span<std::uint8_t> pixels);

}  // namespace sightline
