// A world of boxes that come, move and go, at any scale, and the culling of it: here are my boxes, here is my
// camera, give me what to draw. No GPU is needed.
//
//   sightline::World world;
//   world.insert(boxes, handles);                              // a BoxView over your own structs
//   sightline::Culler culler;
//   std::vector<std::uint32_t> ids(sightline::cull_capacity(world));
//   const auto drawn = culler.cull(world, {.view = camera}, ids);
//   if (drawn) draw(std::span(ids).first(drawn->count));
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <sightline/box_view.hpp>
#include <sightline/jobs.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/shadows.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

/// Names an object for as long as it stands in its world. A handle whose object was removed is found out, not
/// followed: the generation of a reused index differs. It does not know its world: another may take it for
/// one of its own.
struct Handle {
  ObjectId index = kNoObject;    ///< the id that cull() writes; below World::id_limit()
  std::uint32_t generation = 0;  ///< tells objects apart that had the same index
  bool operator==(const Handle&) const = default;
};

/// In all layers.
inline constexpr std::uint32_t kAllLayers = 0xffffffffu;

/// From how far away an object is seen: from `min` metres on, and nearer than `max`. Where one range ends and
/// another begins at one number, exactly one of two objects in one place is seen.
struct DistanceRange {
  float min = 0;                                       ///< metres, not negative
  float max = std::numeric_limits<float>::infinity();  ///< metres, no less than `min`
  bool operator==(const DistanceRange&) const = default;
};

/// What objects are given besides their boxes; each column has an element an object, or none at all.
struct ObjectColumns {
  /// A bit a layer. A view sees an object iff their layers share a bit. Without: kAllLayers.
  Strided<const std::uint32_t> layers = {};
  /// Numbers of the caller's own, that cull() writes instead of ids where it is asked to. Without: the id.
  Strided<const std::uint32_t> values = {};
  /// A view sees an object iff the distance from its eye to the centre of the object's box, as kept, is in
  /// the range, times the view's distance_scale. Found in single precision about the object's sector: right
  /// to a millimetre and a millionth. Without: at any distance.
  Strided<const DistanceRange> distances = {};
};

/// Names a table of levels of detail that a world keeps.
using LevelTableId = std::uint32_t;
/// The table of objects that have no level but 0.
inline constexpr LevelTableId kNoLevels = 0;
/// The most levels of an object.
inline constexpr std::size_t kMaxLevels = 8;

/// Names an occluder that a world keeps for its objects to carry.
using OccluderId = std::uint32_t;
/// The name of none.
inline constexpr OccluderId kNoOccluder = 0xffffffffu;

/// Which occluder an object carries, and where it is.
struct OccluderPlacement {
  OccluderId occluder = kNoOccluder;  ///< kNoOccluder takes away what the object carried
  Mat4 transform = {};                ///< affine, from the occluder's space to metres about `origin`
  WorldPoint origin = {};             ///< metres
};

/// Boxes in sectors of 3,200 m, each with a double-precision origin, so that a box keeps its place to half a
/// millimetre anywhere, rounded outwards: what is stored holds what was given. Inside a sector, a chunk map
/// (ours; after the vertex chunks of Lee & Shin 2023). A sector is worth its 5 KB and more where many objects
/// stand in it: of few far apart, each takes one, and 30 µs whenever it moves to another.
///
/// A refused call changes nothing. Running out of memory ends the program, as everywhere without exceptions.
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: many may read and cull (each with a Culler of its own) while nobody changes it;
/// changing is for one. Allocates: nothing.
class World {
public:
  /// An empty world. Allocates: its first tables.
  World();
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Puts boxes.size() objects in and writes their handles. All have one length: a handle, and an element of
  /// each column given, a box. Handles, too, may be members of the caller's structs. Errors: bad_argument
  /// (lengths, strides, pointers), bad_box (not min <= max within ±kWorldReach), too_many (beyond 2³¹
  /// objects). Cost: linear, some 400 to 600 ns an object. Allocates: about 53 bytes an object where a
  /// sector's come in bulk, up to 70 where they come few at a time; less for ids used again.
  Status insert(const BoxView& boxes, Strided<Handle> handles, const ObjectColumns& columns);
  /// The same of objects that have no columns. Errors, Cost, Allocates: the same.
  Status insert(const BoxView& boxes, Strided<Handle> handles);
  /// Gives each object a new box; one that is listed twice keeps the last. Call it once a frame, with all
  /// that moved, or with nothing: what has come to rest is filed again a part a frame, by the first call
  /// after a cull. Listing objects in the same order each frame is fastest. Errors: bad_argument, bad_box,
  /// stale_handle. Cost: linear, some 10 ns an object that moves every frame, twice that where it is given
  /// in double precision, some 200 ns one that seldom does. Allocates: where objects gather, or move, as
  /// never before; some 28 bytes for each object that moves every frame, and 4 an object of the world where a
  /// sixteenth of it is listed in no order.
  Status move(Strided<const Handle> handles, const BoxView& boxes);
  /// Takes the objects out.
  /// Errors: bad_argument; stale_handle, also for one that is listed twice. Cost: linear. Allocates: a
  /// list of free ids.
  Status remove(Strided<const Handle> handles);
  /// Gives each object new layers; see ObjectColumns.
  /// Errors: bad_argument, stale_handle. Cost: linear. Allocates: 4 bytes an id, some 6 an object, the first
  /// time.
  Status set_layers(Strided<const Handle> handles, Strided<const std::uint32_t> layers);
  /// Gives each object a new value; see ObjectColumns.
  /// Errors: bad_argument, stale_handle. Cost: linear. Allocates: 4 bytes an id, the first time.
  Status set_values(Strided<const Handle> handles, Strided<const std::uint32_t> values);
  /// Gives each object new distances; see ObjectColumns. Errors: bad_argument, also for what is no range;
  /// stale_handle. Cost: as set_layers. Allocates: 8 bytes an id, some 12 an object, the first time.
  Status set_distances(Strided<const Handle> handles, Strided<const DistanceRange> distances);

  /// Keeps a table of levels of detail for objects to share: sizes in pixels, descending, level 0 being the
  /// finest. An object has level i as long as it is sizes[i] or larger, and less than sizes[i - 1]; smaller
  /// than all of them it has level sizes.size(). It is as large as the diameter of the ball around its box,
  /// as kept. Errors: bad_argument (no sizes or more than 7, and where they do not descend to above 0),
  /// too_many beyond 65535 tables. Allocates: 32 bytes.
  Result<LevelTableId> add_levels(std::span<const float> sizes);
  /// Gives each object a table, or kNoLevels. Errors: bad_argument, stale_handle. Cost: linear. Allocates: 2
  /// bytes an id, the first time.
  Status set_levels(Strided<const Handle> handles, Strided<const LevelTableId> tables);

  /// Keeps an occluder for objects to carry, as many as like: what make_occluder made, or triangles and boxes
  /// put there by hand, and solid spheres. Its boxes are drawn where it has no triangles. All but triangles
  /// behind the first `solid_triangles` must lie inside what the objects show; those others are part of it.
  /// More than 512 triangles are drawn in parts, near ones first, as far as that pays: all walls of a level
  /// may be one occluder.
  /// Errors: as OccluderMesh::make; bad_box; bad_argument for more solid triangles than triangles. Cost: as
  /// OccluderMesh::make. Allocates: a copy.
  Result<OccluderId> add_occluder(const Occluder& occluder, std::span<const Sphere> spheres = {});
  /// Forgets an occluder; its name may be used again. Errors: bad_argument where there is none of the name,
  /// or an object carries it.
  Status remove_occluder(OccluderId occluder);
  /// Gives each object an occluder, switched on, which hides from culls with Occlusion::automatic what lies
  /// behind it. Call it again when the object has moved, behind move(), or has turned: of an object whose box
  /// is another one than it was then, nothing is drawn; nor is an occluder that reaches out of that box, or a
  /// mesh that the transform flattens or skews much. It is drawn exactly where the transform says, whatever
  /// the view's origin. Errors: bad_argument (lengths, strides, pointers, an unknown occluder, a transform
  /// that is not finite or not affine, an origin beyond kWorldReach), stale_handle. Cost: linear. Allocates:
  /// some 250 bytes an object that carries one, 4 an id.
  Status set_occluders(Strided<const Handle> handles, Strided<const OccluderPlacement> placements);
  /// Switches what the objects carry on (1) or off (0), as doors do; those that carry nothing stay so.
  /// Errors: bad_argument, stale_handle. Cost: linear.
  Status set_occluding(Strided<const Handle> handles, Strided<const std::uint8_t> on);
  /// Gives an object its triangles, three points each in metres about `origin`: all that it shows. Culls with
  /// Occlusion::automatic whose view has the same origin ask for them where the box may be seen; those of
  /// Sides::front from that side alone, where corners turn counter-clockwise: where no view, a shadow
  /// map's included, draws their backs. Call it again when the object has moved, behind move(), or has
  /// turned: while its box is another one, and where they reach out of it, they are not asked. None takes
  /// them away. Errors: bad_mesh where the points are no multiple of three; too_many beyond 2³⁰ triangles;
  /// bad_argument for sides that are none; stale_handle. Cost: a copy. Allocates: 144 bytes for every four
  /// triangles begun, 4 an id.
  Status set_triangles(Handle handle, std::span<const Vec3> corners, const WorldPoint& origin = {},
                       Sides sides = Sides::both);

  /// Whether the handle names an object of this world.
  [[nodiscard]] bool contains(Handle handle) const noexcept;
  /// The box as stored, in metres; {} for a stale handle.
  [[nodiscard]] WorldBox box(Handle handle) const noexcept;
  /// The object's layers; 0 for a stale handle.
  [[nodiscard]] std::uint32_t layers(Handle handle) const noexcept;
  /// The object's value; kNoObject for a stale handle.
  [[nodiscard]] std::uint32_t value(Handle handle) const noexcept;
  /// The object's distances; {0, 0} for a stale handle.
  [[nodiscard]] DistanceRange distances(Handle handle) const noexcept;
  /// The object's table of levels; kNoLevels for a stale handle.
  [[nodiscard]] LevelTableId levels(Handle handle) const noexcept;
  /// The handle of the object that has this id now; a handle that no world contains where none has.
  [[nodiscard]] Handle handle(ObjectId id) const noexcept;
  /// How many objects there are.
  [[nodiscard]] std::size_t size() const noexcept;
  /// All ids lie below this: the length of a caller's array by id. Ids of removed objects are reused.
  [[nodiscard]] std::size_t id_limit() const noexcept;

private:
  friend struct WorldAccess;
  struct State;
  State* state_;
};

/// The most views that one call culls together.
inline constexpr std::size_t kMaxViews = 8;
/// Of CullView::distance_view: the view itself.
inline constexpr std::uint32_t kOwnView = 0xffffffffu;

/// A camera, an eye, a shadow cascade: whatever sees the world.
struct CullView {
  WorldView view;  ///< what it sees, and the size of its image
  /// Occluders that were drawn into a buffer begun with this same view; null: occlusion culls nothing.
  /// Another view's buffer, or last frame's, is refused, for it would cull what is seen.
  const OcclusionBuffer* occlusion = nullptr;
  std::uint32_t layers = kAllLayers;  ///< sees objects whose layers share a bit with these
  /// px²: drops what covers less by its bounding sphere (Lee & Shin 2023, equation 1, mended): approximate. 0
  /// drops nothing.
  float min_area = 0;
  float distance_scale = 1;  ///< times the objects' distances: 2 shows them from twice as far; above 0
  /// The place in `views` of the one from whose eye distances are measured, so that a shadow cascade shows
  /// what its camera does; kOwnView: this one's.
  std::uint32_t distance_view = kOwnView;
  /// Begun with this same view, a shadow map's: leaves only what can throw a shadow on what a camera sees;
  /// null: leaves all. Another view's are refused.
  const ShadowCasters* casters = nullptr;
};

/// Whether a cull draws occluders by itself.
enum class Occlusion : std::uint8_t {
  none,       ///< it does not; a view may still bring a buffer
  automatic,  ///< it draws those that the objects carry, as far as that pays
};

/// What counted work costs, in any one unit: the defaults are nanoseconds on a processor of 2023. Automatic
/// occlusion weighs by them what it does against what it saves.
struct CullCosts {
  float object = 0;     ///< an object that is left, for who draws it; 0: what report_frame_time() taught
  float node = 10;      ///< a region, group or chunk looked at
  float test = 1;       ///< an object tested against planes
  float candidate = 8;  ///< an object looked at for what it carries
  float tile = 2;       ///< 8 × 8 pixels emptied or drawn
  float shape = 30;     ///< a box or a sphere drawn
  float triangle = 15;  ///< a triangle drawn
  float query = 12;     ///< a box asked
  float occludee = 10;  ///< a triangle asked
};
/// An object's cost as long as nobody has said or taught another.
inline constexpr float kObjectCost = 1000;

/// A profiler that has zones, as Tracy, Optick and Perfetto do: both functions are called by whichever thread
/// does the work, the caller's or a job's, first `begin` and then `end`, one zone within another.
struct CullZones {
  void (*begin)(void* user, const char* name) = nullptr;  ///< a name that lives as long as the program
  void (*end)(void* user) = nullptr;                      ///< of the zone that this thread began last
  void* user = nullptr;                                   ///< handed to both
};

/// How levels of detail are chosen: once a call, for all its views. Read where levels are asked for and the
/// world has tables. For each key a culler keeps 16 bytes a place in the chunks of the sectors that it has
/// had in view, some 24 an object, and 4 an id once objects that were in view stand in other chunks; and 2 an
/// object for all keys. A visible object costs least while the camera is the same but for where it stands,
/// and the objects around it stand; some 20 ns where it is new in view or more than one in 32 of all tables
/// have changed.
struct LevelOptions {
  /// The place in `views` of the one by whose image objects have their sizes, so that shadow cascades draw
  /// what their camera draws.
  std::uint32_t view = 0;
  /// Whose memory: below kMaxViews. A culler that sees several cameras or worlds in turns gives each its own.
  std::uint32_t key = 0;
  /// How far beyond a limit a size must be, as a share of it, for an object to change its level: 0 to below
  /// 1. For objects, by id, that the key's last cull had in view; those that automatic occlusion hid there
  /// may pass for such.
  float hysteresis = 0;
  /// How far above a level's lower limit, as a share of it, it begins to fade into the next.
  float fade = 0;
  float scale = 1;   ///< times the sizes: 2 has levels change at half of them; above 0
  bool cut = false;  ///< the camera was cut: nothing is remembered from before
};

/// How a call culls; the same for all its views.
struct CullOptions {
  JobSystem jobs = {};                    ///< the caller's threads; without them, the calling one
  bool values_for_ids = false;            ///< writes the objects' values instead of their ids
  Occlusion occlusion = Occlusion::none;  ///< automatic: no view brings a buffer
  CullCosts costs = {};                   ///< finite, not negative; read by automatic occlusion
  /// Which places of the images automatic occlusion answers for, and how finely: more coarsely where a buffer
  /// as fine would take most of what it may spend.
  OcclusionOptions buffer = {};
  CullZones zones = {};      ///< both functions, or none: what a cull spends its time on is told to nobody
  LevelOptions levels = {};  ///< how levels of detail are chosen
};

/// Where a cull writes; all have cull_capacity() elements, but all but `ids` may be empty. What stands behind
/// the count that comes back is undefined.
struct CullOutput {
  std::span<std::uint32_t> ids;         ///< the objects' ids, or their values
  std::span<std::uint8_t> masks = {};   ///< bit v: view v may see the object
  std::span<std::uint8_t> levels = {};  ///< of detail: 0 is the finest
  /// Of 255, the share of the next coarser level, for who blends: an object of level i and fade f is drawn as
  /// (255 - f) parts of level i and f of level i + 1. Refused without `levels`.
  std::span<std::uint8_t> fades = {};
};

/// What a cull did.
struct CullResult {
  std::size_t count = 0;            ///< objects written
  std::uint64_t tested = 0;         ///< objects tested one by one
  std::uint64_t nodes_visited = 0;  ///< regions, groups and chunks looked at
  /// Objects that occlusion dropped, summed over the views. Of a chunk that is hidden whole all objects count
  /// that layers and distances leave, those that planes or min_area would drop, too.
  std::uint64_t culled_occlusion = 0;
  /// With automatic occlusion, in the unit of CullCosts: the work of this cull and of drawing what it left,
  /// each object once for every bit of its mask; and that of a cull by frustum alone and of drawing all that
  /// it leaves.
  double cost = 0, frustum_cost = 0;
};

/// Elements that the spans of a CullOutput need: all objects, and what SIMD and jobs write beyond.
/// Errors: none. Cost: constant. Threads: as World's. Allocates: nothing.
std::size_t cull_capacity(const World& world, const CullOptions& options = {}) noexcept;

/// Culls worlds, and remembers from frame to frame what helps the next.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: one at a time; a world can have many cullers at once. Allocates: nothing.
class Culler {
public:
  /// Allocates: its first tables.
  Culler();
  ~Culler();
  Culler(Culler&&) noexcept;
  Culler& operator=(Culler&&) noexcept;

  /// Writes the ids of the objects that at least one of the 1 … kMaxViews views may see, and which views see
  /// each, in an order that depends on the calls so far alone, culls between moves among them: never on
  /// threads, SIMD width or processor. Nothing that is visible anywhere on the image is left out, but by
  /// `layers`, `distances`, `min_area` and `casters`; by occlusion for Coverage::centres, nothing that is
  /// visible at some pixel centre. Errors: bad_argument (no or too many views; an option out of range),
  /// bad_view, buffer_too_small, stale_buffer; index() is the view's. Nothing is written then. Cost: grows
  /// with what is visible and with the boundary of the views, not with the world: some 25 µs for the
  /// 100,000 of a million still boxes that a camera sees; and some 40 ns a sector. Threads: only reads the
  /// world and the buffers. Allocates: nothing once it has grown to the world's size.
  ///
  /// With Occlusion::automatic what the world's objects carry is drawn, as far as that pays, and what lies
  /// behind it is left out, too. Where that does not pay it costs little, in counted work × options.costs: no
  /// frame, culled and drawn, costs more than 1.05 × one by frustum alone, and all of this culler's frames
  /// together no more than 1.02 ×. What was seen the last time, and so is worth drawing, is kept for each
  /// place in `views`: a culler should see the same cameras at the same places. Errors, too: bad_argument for
  /// costs out of range, or where a view brings a buffer. Allocates, too: until it has drawn its largest
  /// image and mesh.
  Result<CullResult> cull(const World& world, std::span<const CullView> views, const CullOptions& options,
                          const CullOutput& output) noexcept;
  /// The same for one view, without options. Errors, Cost, Threads, Allocates: the same.
  Result<CullResult> cull(const World& world, const CullView& view, std::span<std::uint32_t> ids) noexcept {
    return cull(world, {&view, 1}, {}, {ids, {}});
  }

  /// Teaches what an object costs, where CullCosts::object is 0: how many nanoseconds the frame took to draw
  /// what the last cull left, without any wait for the display. What each further object adds is learned,
  /// once frames differ in how many they draw; nothing of frames that take the same all the same. Errors:
  /// bad_argument for a time that is not from 1000 to 1e15.
  Status report_frame_time(double nanoseconds) noexcept;

private:
  friend struct CullerAccess;
  struct State;
  State* state_;
};

}  // namespace sightline
