// Shadows: the views of a light's shadow maps, cascades that stand still, and which objects can throw a
// shadow on anything that a camera sees.
//
//   const sightline::Light sun{.direction = {1, -2, 0.5f}};
//   const auto map = sightline::shadow_view(sun, camera, {.far_plane = 80}, 2048);
//   sightline::ShadowCasters casters;
//   if (!casters.begin(*map, camera, {.far_plane = 80})) …
//   const std::array<sightline::CullView, 2> views{{{.view = camera}, {.view = *map, .casters = &casters}}};
//   const auto drawn = culler.cull(world, views, {}, {ids, masks});
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <sightline/occlusion.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

class World;

/// Where a light's rays come from.
enum class LightKind : std::uint8_t {
  directional,  ///< from one direction: the sun
  spot,         ///< from a point, within a cone
  point,        ///< from a point, everywhere
};

/// What throws shadows.
struct Light {
  LightKind kind = LightKind::directional;  ///< which of the members below count
  Vec3 direction{0, -1, 0};                 ///< along which it shines, any length but zero: directional, spot
  WorldPoint position{};                    ///< metres: spot, point
  float cone = 1.04719755f;                 ///< radians from side to side, 0 < cone < pi: spot
  float range = 100;                        ///< metres: how far it shines: spot, point
  float near_plane = 0.05f;                 ///< metres: nearer things throw no shadow: spot, point
  /// Metres: from how far a thing may throw a shadow on what the map is for: directional.
  float reach = 1000;
};

/// A part of what a camera sees, by the depth along its view. What the camera's own planes cut off counts in
/// neither direction.
struct DepthRange {
  float near_plane = -std::numeric_limits<float>::infinity();  ///< metres
  float far_plane = std::numeric_limits<float>::infinity();    ///< metres, beyond near_plane
  bool operator==(const DepthRange&) const = default;
};

/// How many views a point light has: the faces of a cube, towards +x, -x, +y, -y, +z, -z.
inline constexpr std::uint32_t kPointFaces = 6;

/// The view of a light's shadow map of pixels × pixels. A spot's and a point's stand about the light's
/// position, with depth from 0 at `near_plane` to 1 at `range`; `face` is the point light's. A directional
/// light's is orthographic, about the camera's origin, holds that part of what the camera sees and all within
/// `reach` of it towards the light, and stands still as cascades do: its own depth is 0 to 1, too. Errors:
/// bad_argument (a light, a range or a face out of range, and a directional light's camera that sees
/// infinitely far in an unlimited range), bad_view (the camera; pixels not 16 … 16384). Cost: a microsecond.
/// Threads: any. Allocates: nothing.
Result<WorldView> shadow_view(const Light& light, const WorldView& camera, const DepthRange& depths,
                              std::uint32_t pixels, std::uint32_t face = 0) noexcept;

/// How cascades share out what a camera sees.
struct CascadeOptions {
  DepthRange depths = {};       ///< of all cascades together
  float logarithmic = 0.7f;     ///< 0: parts of one length; 1: each grows by one factor (Zhang et al. 2006)
  std::uint32_t pixels = 2048;  ///< a side of each map
};

/// One of them.
struct Cascade {
  WorldView view;     ///< of its shadow map
  DepthRange depths;  ///< the part of what the camera sees that it is for; the next begins where it ends
};

/// The most that one call makes.
inline constexpr std::size_t kMaxCascades = 16;

/// Splits what a camera sees into cascades.size() parts by depth, near ones first, and gives each a map. A
/// map is as large and lies the same way however the camera turns and goes, and moves by whole texels: what
/// stands still keeps its texels, so shadow edges do not crawl. Errors: bad_argument (no directional light,
/// options out of range, no cascade or too many, a camera that sees infinitely far in an unlimited range),
/// bad_view. Cost: a few microseconds a cascade. Threads: any. Allocates: nothing.
Status split_cascades(const Light& light, const WorldView& camera, const CascadeOptions& options,
                      std::span<Cascade> cascades) noexcept;

/// How far from its own place a lit point may look a shadow up.
struct ShadowFilter {
  /// Texels, along x and y: 0.5 for the nearest one, 1 for a mean of four, more for wider filters.
  float texels = 1;
  /// Metres in any direction: what a renderer moves lit points by, so that they do not shadow themselves.
  float metres = 0;
};

/// Which objects can throw a shadow on what a camera sees: a CullView of a light's view that has these drops
/// all others. After begin() these are the objects that reach into what the camera sees, extruded towards the
/// light; after receive() those of which the shadow can fall on something that the camera's own cull left.
/// Light and receivers may be of any kind: an orthographic shadow view stands for parallel rays, another one
/// for rays from its eye. After the shadow caster culling of Bittner et al. 2011.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: changing is for one, culling for many at once while nobody changes it. Allocates:
/// nothing.
class ShadowCasters {
public:
  /// Allocates: a little.
  ShadowCasters();
  ~ShadowCasters();
  ShadowCasters(ShadowCasters&&) noexcept;
  ShadowCasters& operator=(ShadowCasters&&) noexcept;

  /// Takes the view of a shadow map and the camera that it is for, or a part of what this sees. Until
  /// receive() is called, shadows may fall anywhere there. No object is dropped that a ray from the light
  /// passes on its way to a point of that part, or to one as far off as the filter says, if it stands in the
  /// shadow view. Errors: bad_view (either); bad_argument (a range or a filter out of range; a camera that
  /// sees infinitely far in an unlimited range). After a refusal it is as before. Cost: some 20 µs.
  Status begin(const WorldView& shadow, const WorldView& camera, const DepthRange& depths = {},
               const ShadowFilter& filter = {});
  /// Takes what the camera sees: shadows matter on these objects alone, as far as they stand in the part, and
  /// with `depth`, a buffer begun with the camera, not behind its occluders. `visible` are ids that a cull of
  /// the world wrote, not values; some that the camera does not see do no harm. Errors: stale_buffer before
  /// begin(), and for a buffer begun with another view; bad_argument for an id that no object has. After a
  /// refusal it is as before. Cost: some 100 ns an object, and with a buffer a millisecond. Allocates: until
  /// it has seen its largest image.
  Status receive(const World& world, std::span<const ObjectId> visible,
                 const OcclusionBuffer* depth = nullptr);

  /// The shadow view that it was begun with; 1 × 1 pixels wide before.
  [[nodiscard]] const WorldView& view() const noexcept;
  /// Whether begin() has succeeded.
  [[nodiscard]] bool begun() const noexcept;
  /// Whether the box may throw a shadow there. False is certain, of a box that stands in the shadow view.
  [[nodiscard]] bool may_cast(const WorldBox& box) const noexcept;

private:
  friend struct ShadowAccess;
  struct State;
  State* state_;
};

}  // namespace sightline
