// Who is near whom, for moving objects: chunks of fewer than 100 boxes by ground region (Lee & Shin 2023,
// section 3.3), kept right while objects come, move and go, at a cost that does not depend on how many stand.
//
// The ground rectangle (x-z) is split like a quadtree down to `depth`. An object is homed by the set of leaf
// regions its box touches: one region makes its chunk an own chunk, several make it a chunk shared by exactly
// those. As boxes lie along the axes the set is always a rectangle of leaf regions, so four numbers are its
// key. Within a key, chunks split by a k-d tree over the box centres when they are full. Above the chunks
// stand groups of up to 32 chunks, and above these the quadtree's nodes; bounds are tight unions at every
// chunk and group, and never too small at a node.
//
// Where `movers` is asked for, move_loosely() lets what moves cost little: a chunk's bounds may be wider than
// its boxes, an object that leaves them or moves frame after frame stands in chunks of movers, filed by when
// it came and not by where it is, and rest() files those that no longer move. Once a sixth of all ids move
// in no order, movers stand in pages: chunks in which each id has its place.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/status.hpp>

#include "library/geometry/aligned_vector.hpp"
#include "library/geometry/box_reader.hpp"
#include "library/world/chunk_map_types.hpp"
#include "library/world/columns.hpp"

namespace sightline::world {

class ChunkMap {
public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kCapacity = 96;       ///< objects a chunk; a multiple of every SIMD width
  static constexpr std::uint32_t kSmallCapacity = 16;  ///< of a chunk that has never held more
  static constexpr std::uint32_t kLanes = 16;          ///< capacities are multiples of it
  static constexpr std::uint32_t kGroupCapacity = 32;  ///< chunks a group
  static constexpr std::uint32_t kMaxDepth = 6;
  /// Whether movers may stand in pages, lie in long rows and leave their chunks some at a time; not where
  /// each byte of code is loaded by whoever opens a web page.
#ifdef __wasm__
  static constexpr bool kHasPages = false;
#else
  static constexpr bool kHasPages = true;
#endif

  /// Where an object stands, and what else is kept of it, so that all of it comes with one line of memory.
  struct alignas(16) Location {
    std::uint32_t chunk = kNone;
    /// The slot in 7 bits, and kMoves where the chunk is one of movers; then 8 of history, bit k being
    /// whether it moved k frames before the frame that the highest 16 count. One number, for a load that
    /// needs parts of what several stores just wrote must wait until they, and all stores before them, have
    /// reached the cache.
    std::uint32_t slot_and_history = 0;
    std::uint32_t sector = kNone, generation = 0;  ///< the World's

    static constexpr std::uint32_t kMoves = 0x80;
    [[nodiscard]] std::uint32_t slot() const noexcept { return slot_and_history & (kMoves - 1); }
    [[nodiscard]] bool moves() const noexcept { return slot_and_history & kMoves; }
  };
  /// The chunk of an object whose sector is not in memory.
  static constexpr std::uint32_t kOut = kNone - 1;
  /// One a possible object id; maps that share no object may share the table.
  using Locations = geometry::LargeVector<Location>;

  using ChunkView = world::ChunkView;

  /// Bounds of up to 32 chunks, one array a side in the order of ChunkView.
  struct alignas(64) Group {
    std::array<std::array<float, kGroupCapacity>, 6> bounds{};
    std::array<std::uint32_t, kGroupCapacity> chunks{};
    /// Of each chunk, what ChunkMap::chunk() would look up elsewhere: where its lanes begin, and how many
    /// objects it holds, with its capacity in the bits from kSize on, kLoose set where it is loose, and
    /// kInOrder where it has no holes and each id is one more than the last.
    std::array<std::uint32_t, kGroupCapacity> first_lane{}, count_and_size{};
    static constexpr std::uint32_t kCount = 0xff, kSize = 8, kLoose = 0x40000000u, kInOrder = 0x20000000u;
    Box box;                  ///< of all of them
    std::uint32_t count = 0;  ///< 0: the group is free
    std::uint32_t node = 0, index_in_node = 0;
    std::uint32_t objects = 0;
    std::uint32_t pool = 0;  ///< whose lanes its chunks have
  };

  /// Boxes in structure of arrays, padded to a multiple of 16.
  struct BoxRows {
    std::array<geometry::AlignedVector<float>, 6> sides;  ///< in the order of ChunkView
    void set(std::size_t i, const Box& box) noexcept;
    void resize(std::size_t count);
  };

  /// A region of any level; node 0 is the whole ground.
  struct Node {
    Box bounds;  ///< holds all objects below; min > max where there are none
    std::uint32_t parent = kNone;
    std::uint32_t first_child = kNone;  ///< the four children lie at first_child … +3
    std::uint32_t objects = 0;          ///< in all groups here and below
    std::vector<std::uint32_t> groups;  ///< of the keys whose smallest common region this is
    BoxRows group_boxes;                ///< of these
  };

  /// The location table is the map's own unless the caller brings one, which must outlive the map and hold an
  /// entry for each id before it is inserted; so must columns, if there are any.
  explicit ChunkMap(const ChunkMapOptions& options, Locations* shared_locations = nullptr,
                    const Columns* columns = nullptr);
  ChunkMap(const ChunkMap&) = delete;
  ChunkMap& operator=(const ChunkMap&) = delete;

  /// Boxes must be valid (finite, min <= max); ids inserted must be absent, ids moved or removed present.
  void insert(ObjectId object, const Box& box);
  void move(ObjectId object, const Box& box);
  void remove(ObjectId object);
  /// Objects 0 … size-1 of an empty map at once; the same as inserting them one by one.
  void insert_all(const Boxes& boxes);

  /// The same as move(), but for where the object then stands and how tight bounds are. Bounds and counts of
  /// groups are behind until flush().
  void move_loosely(ObjectId object, const Box& box, Moving& moving);
  /// Puts a new object among the movers, where there are enough objects for that; else as insert(). flush()
  /// is due, too.
  void insert_moving(ObjectId object, const Box& box);
  /// Moves `count` objects while they are found at `slot` of the mover chunk `chunk` or not far behind, in
  /// the order listed, and nothing but their own boxes changes. Returns how many did; chunk and slot are then
  /// where the next may stand. `past_cache`: there are so many that the cache cannot hold them anyway.
  std::uint32_t move_run(std::uint32_t& chunk, std::uint32_t& slot, const ObjectId* objects,
                         const geometry::BoxBlock& boxes, std::size_t first, std::uint32_t count,
                         bool past_cache) noexcept;
  /// Of objects of which many begin to move at once: makes movers of them while each has been still and is of
  /// the `sector`, as World numbers them. Returns how many did.
  std::uint32_t join_movers(const ObjectId* objects, std::uint32_t sector, const geometry::BoxBlock& boxes,
                            std::size_t first, std::uint32_t count);
  /// To be called before objects are moved, many of all or not, of which so many stand still: says whether
  /// movers are to have pages from now on.
  void expect_moves(bool many, std::size_t newcomers) noexcept;
  [[nodiscard]] bool keeps_pages() const noexcept {
    return kHasPages && by_id_;
  }
  /// Moves objects in pages while each is of the `sector`, as World numbers them, lies `within` and is a
  /// mover or, where many begin to move, becomes one. Returns how many did; those that came to their pages
  /// now are counted in `came`.
  std::uint32_t move_in_pages(std::span<const ObjectId> objects, const Box* boxes, const Box& within,
                              std::uint32_t sector, bool many, std::uint32_t& came);
  /// Asks for the memory that moving these will need, where they lie far apart.
  void prefetch_pages(std::span<const ObjectId> objects) const noexcept;
  /// Asks for the memory that moving an object will need; of an object that may have left, it asks in vain.
  void prefetch_chunk(ObjectId object) const noexcept;
  void prefetch_lanes(ObjectId object) const noexcept;
  /// Brings the groups up to date.
  void flush();
  /// Files some of the movers that rested for two rounds or more, and tightens the bounds of some chunks that
  /// rest. To be called once a frame; a round is kRound calls.
  void rest();
  static constexpr std::uint32_t kRound = 128;
  /// Whether rest() has anything to do.
  [[nodiscard]] bool restless() const noexcept {
    return !grown_.empty() || movers() > 0;
  }
  /// How many objects are movers.
  [[nodiscard]] std::size_t movers() const noexcept {
    return mover_node_ == kNone ? 0 : nodes_[mover_node_].objects;
  }
  /// The region that holds the movers' groups, a child of node 0 that first_child does not list; or kNone.
  [[nodiscard]] std::uint32_t mover_node() const noexcept {
    return mover_node_;
  }
  [[nodiscard]] bool is_mover(ObjectId object) const noexcept {
    return (*locations_)[object].moves();
  }
  [[nodiscard]] bool holds_movers(std::uint32_t chunk) const noexcept {
    return chunks_[chunk].pool == kMovers;
  }

  /// To be called when a column has come to be: chunks learn of it.
  void begin_column();
  /// To be called when an object's columns have changed.
  void note_columns(ObjectId object);
  /// Brings what groups know of columns up to date; before, they know nothing. To be called after changes.
  void settle_columns() noexcept;
  /// What a group knows of its chunks' columns, in rows as LayerRows and DistanceRows say, aligned to 64
  /// bytes; null where there is no such column.
  [[nodiscard]] const std::uint32_t* layer_rows(std::uint32_t group) const noexcept {
    return layer_rows_.empty() ? nullptr : &layer_rows_[LayerRows::kSize * group];
  }
  [[nodiscard]] const float* distance_rows(std::uint32_t group) const noexcept {
    return distance_rows_.empty() ? nullptr : &distance_rows_[DistanceRows::kSize * group];
  }
  /// The columns of a chunk's objects, as ChunkView has its arrays; of distances the least, and as far behind
  /// as `step` says the greatest.
  [[nodiscard]] const std::uint32_t* layers_of(const Group& group, const ChunkView& chunk) const noexcept {
    const Pool& pool = pools_[group.pool];
    return pool.layers.data() + (chunk.objects - pool.ids.data());
  }
  [[nodiscard]] const float* distances_of(const Group& group, const ChunkView& chunk,
                                          std::size_t& step) const noexcept {
    const Pool& pool = pools_[group.pool];
    step = pool.row > 0 ? kCapacity : chunk.step;
    return pool.distances.data() + 2 * (chunk.objects - pool.ids.data());
  }

  /// Where chunks' objects lie, a lane each: in one of two pools, of which a chunk's `objects` are a part.
  static constexpr std::size_t kPools = 2;
  [[nodiscard]] std::span<const ObjectId> pool_ids(std::size_t pool) const noexcept {
    return pools_[pool].ids;
  }
  /// The same only where no object has come to a pool, gone, moved or been put elsewhere since.
  struct LaneVersion {
    std::uint64_t map = 0, change = 0;  ///< maps' numbers begin at 1
    bool operator==(const LaneVersion&) const = default;
  };
  [[nodiscard]] LaneVersion lane_version(std::size_t pool) const noexcept {
    return {number_, changes_[pool]};
  }

  [[nodiscard]] bool contains(ObjectId object) const noexcept;
  [[nodiscard]] Box box(ObjectId object) const noexcept;
  [[nodiscard]] std::size_t size() const noexcept {
    return size_;
  }
  [[nodiscard]] const ChunkMapOptions& options() const noexcept {
    return options_;
  }
  [[nodiscard]] const Location& location(ObjectId object) const noexcept {
    return (*locations_)[object];
  }

  /// Chunk numbers lie below this; free ones have a count of 0. A number may be reused.
  [[nodiscard]] std::uint32_t chunk_limit() const noexcept {
    return static_cast<std::uint32_t>(chunks_.size());
  }
  [[nodiscard]] ChunkView chunk(std::uint32_t chunk) const noexcept {
    const Chunk& c = chunks_[chunk];
    return {lanes(c, 0), ids(c), static_cast<std::uint32_t>(pools_[c.pool].step(c.capacity)), c.count,
            c.count != c.live || c.pool != kStill};
  }
  /// The chunk at place i of a group.
  [[nodiscard]] ChunkView chunk(const Group& group, std::uint32_t i) const noexcept {
    const std::uint32_t first = group.first_lane[i], size = group.count_and_size[i];
    const Pool& pool = pools_[group.pool];
    // Asked of the group, which is at hand: what stands still is found without a look at its pool's rows.
    const bool still = !kHasPages || group.pool == kStill;
    const std::uint32_t step =
        still ? size >> Group::kSize & Group::kCount : static_cast<std::uint32_t>(pool.row);
    const float* at = pool.lanes.data() + (still ? 6 * std::size_t{first} : pool.begin(first));
    return {at, pool.ids.data() + first, step, size & Group::kCount, (size & Group::kLoose) != 0};
  }
  /// Tight union of the chunk's boxes; after move_loosely() it may be wider.
  [[nodiscard]] Box chunk_bounds(std::uint32_t chunk) const noexcept;
  [[nodiscard]] RegionSet chunk_regions(std::uint32_t chunk) const noexcept;
  /// Which leaf regions a box touches.
  [[nodiscard]] RegionSet regions(const Box& box) const noexcept;
  /// Writes the chunk's vertices; room for its count is needed. Returns how many.
  std::uint32_t write_vertices(std::uint32_t chunk, std::span<ChunkVertex> out) const noexcept;

  [[nodiscard]] std::span<const Node> nodes() const noexcept {
    return nodes_;
  }
  [[nodiscard]] std::span<const Group> groups() const noexcept {
    return groups_;
  }

  /// Chunks whose objects or boxes changed since the last acknowledge_changes(), freed ones included.
  [[nodiscard]] std::span<const std::uint32_t> changed_chunks() const noexcept {
    return changed_;
  }
  void acknowledge_changes() noexcept;

  /// Shrinks the bounds of quadtree nodes that moves and removals left too large; and once most chunks stand
  /// where there happened to be room, puts neighbours' lanes side by side: who reads a group then reads few
  /// pages of memory, and looking a page up costs more than reading a line of it. Where an eighth of all
  /// objects came since the last call, chunks also get no more room than they need. Spread over the
  /// insertions between, both copy each object a few times. ChunkViews are void afterwards.
  void tighten();
  /// Only the former.
  void tighten_nodes() noexcept;

  /// Whether every invariant above holds; for tests, it looks at everything.
  [[nodiscard]] Status check() const;

private:
  friend struct ChunkMapParts;  // the way of snapshots

  // What a small move reads comes first, in a line of memory.
  struct alignas(64) Chunk {
    Box bounds;  // what the group says, or will say once flush() has been called
    std::uint32_t first_lane = 0, capacity = 0, count = 0;
    std::uint32_t live = 0;              // objects: count less the holes
    std::array<std::uint64_t, 2> moved;  // a bit a slot of movers, else a word, since rest() was last here
    std::uint8_t pool = 0;
    bool dirty = false;         // waits for flush()
    bool grown = false;         // stands in grown_
    bool wide = false;          // of a chunk of still objects: its bounds have grown by all that they may
    std::uint32_t counted = 0;  // `live` as the group knows it

    Box cell;  // of the centres that the k-d tree sends here
    std::uint32_t key = kNone, parent = kNone;
    // Chunks that could not be split: all centres equal. Of movers: the one begun after this, or what it
    // became; and the page, or none.
    std::uint32_t next = kNone, previous = kNone;
    std::uint32_t group = kNone, index_in_group = 0;
    bool changed = false;
    bool stale = false;  // stands in stale_
  };
  static constexpr std::uint8_t kStill = 0, kMovers = 1;
  // Movers have lanes of their own, so that those who come all at once make nobody copy the others': in six
  // rows, which processors foresee; and others behind so many lanes, as large pages come slowly.
  static constexpr std::uint32_t kRowLanes = 1u << 16;
  struct Pool {
    geometry::UnwrittenVector<float> lanes;
    geometry::UnwrittenVector<ObjectId> ids;  // and kCapacity more
    std::uint32_t used = 0;                   // lanes
    std::size_t row = 0;                      // from one side of a box to the next; 0: its chunk's capacity
    // Where there are such columns: one a lane, and two, a chunk's least before its greatest.
    geometry::LargeVector<std::uint32_t> layers;
    geometry::LargeVector<float> distances;
    std::array<std::vector<std::uint32_t>, kCapacity / kLanes> free;  // by capacity

    [[nodiscard]] std::size_t step(std::size_t capacity) const noexcept {
      return kHasPages && row > 0 ? row : capacity;
    }
    [[nodiscard]] std::size_t begin(std::size_t lane) const noexcept {
      return kHasPages && row > 0 ? lane / kRowLanes * 6 * row + lane % kRowLanes : 6 * lane;
    }
  };
  struct Key {
    RegionSet regions;
    std::uint32_t node = 0;      // of the quadtree
    std::uint32_t root = kNone;  // k-d reference
  };
  // A k-d reference is a split, or a chunk with the highest bit set.
  static constexpr std::uint32_t kChunkBit = 0x80000000u;
  static constexpr bool is_chunk(std::uint32_t reference) {
    return reference & kChunkBit;
  }

  struct Split {
    float at = 0;
    std::uint32_t axis = 0, parent = kNone;
    std::array<std::uint32_t, 2> child{};  // k-d references: centre < at, centre >= at
  };

  float* lanes(const Chunk& chunk, std::uint32_t side) noexcept {
    Pool& pool = pools_[chunk.pool];
    return pool.lanes.data() + pool.begin(chunk.first_lane) + side * pool.step(chunk.capacity);
  }
  const float* lanes(const Chunk& chunk, std::uint32_t side) const noexcept {
    const Pool& pool = pools_[chunk.pool];
    return pool.lanes.data() + pool.begin(chunk.first_lane) + side * pool.step(chunk.capacity);
  }
  [[nodiscard]] std::size_t step(const Chunk& chunk) const noexcept {
    return pools_[chunk.pool].step(chunk.capacity);
  }
  ObjectId* ids(const Chunk& chunk) noexcept {
    return pools_[chunk.pool].ids.data() + chunk.first_lane;
  }
  const ObjectId* ids(const Chunk& chunk) const noexcept {
    return pools_[chunk.pool].ids.data() + chunk.first_lane;
  }
  Box box_at(const Chunk& chunk, std::uint32_t slot) const noexcept;
  void write(std::uint32_t chunk, std::uint32_t slot, ObjectId object, const Box& box) noexcept;
  void write_box(const Chunk& chunk, std::uint32_t slot, const Box& box) noexcept;
  std::uint32_t take_slot(Chunk& chunk) noexcept;

  void build_nodes();
  std::uint32_t find_key(RegionSet regions);
  std::uint32_t find_chunk(const Key& key, const Vec3& centre) const noexcept;
  std::uint32_t add_chunk(std::uint32_t key, std::uint32_t capacity, Box cell, std::uint8_t pool = kStill,
                          std::uint32_t first_lane = kNone);
  void free_chunk(std::uint32_t chunk);
  std::uint32_t make_room(std::uint32_t chunk, const Vec3& centre);
  bool split(std::uint32_t chunk);
  void grow(std::uint32_t chunk);
  void unlink(std::uint32_t chunk);
  void try_merge(std::uint32_t chunk);
  void replace_reference(std::uint32_t key, std::uint32_t parent, std::uint32_t from,
                         std::uint32_t to) noexcept;
  std::uint32_t take_lanes(Pool& pool, std::uint32_t capacity);
  std::uint32_t add_lanes(Pool& pool, std::uint32_t count);
  static std::uint32_t free_capacity(const Pool& pool, std::uint32_t objects) noexcept;
  static void give_lanes(Pool& pool, std::uint32_t first, std::uint32_t capacity);
  void file(ObjectId object, const Box& box);
  void append(std::uint32_t chunk, ObjectId object, const Box& box);
  void erase_slot(std::uint32_t chunk, std::uint32_t slot) noexcept;
  void note_change(std::uint32_t chunk);
  void note_shape(std::uint32_t chunk) noexcept;
  void arrange(bool tightly);
  static std::uint32_t tight_capacity(const Chunk& chunk) noexcept;
  [[nodiscard]] bool has_columns() const noexcept {
    return columns_ && columns_->any();
  }
  void resize_columns(Pool& pool) const;
  void load_columns(const Chunk& chunk, std::uint32_t slot) noexcept;
  void load_columns(const Chunk& chunk) noexcept;
  void note_stale(std::uint32_t chunk);
  // What a chunk's objects have in common; of none, what leaves it out.
  struct ChunkColumns {
    std::uint32_t some = 0, every = kAllLayers;
    float first_min = std::numeric_limits<float>::infinity(), last_min = 0;
    float first_max = std::numeric_limits<float>::infinity(), last_max = 0;
  };
  ChunkColumns columns_of(const Chunk& chunk) const noexcept;
  Status check_columns(std::uint32_t chunk) const;

  void prefetch_group(const Chunk& chunk) const noexcept;
  void make_dirty(std::uint32_t chunk);
  void note_grown(std::uint32_t chunk);
  void add_mover(ObjectId object, const Box& box);
  std::uint32_t add_mover_chunk(std::uint32_t first_lane = kNone);
  static std::uint32_t lane_after(std::uint32_t lane, std::uint32_t chunks) noexcept;
  static void make_rows(Pool& pool, std::size_t lanes);
  std::uint32_t open_mover_chunk();
  std::uint32_t open_page(ObjectId object);
  void come_to_page(ObjectId object);
  void file_new_pages();
  std::uint32_t write_in_page_of(std::uint32_t page, std::span<const ObjectId> objects, const Box* boxes,
                                 const Box& within) noexcept;
  void free_mover_chunk(std::uint32_t chunk);
  [[nodiscard]] static bool is_page(const Chunk& chunk) noexcept {
    return chunk.previous != kNone;
  }
  [[nodiscard]] bool is_kept_page(const Chunk& chunk) const noexcept;
  void leave(std::uint32_t chunk, std::uint32_t slot);
  void leave_soon(ObjectId object);
  void leave_now();
  void leave_all(std::uint8_t pool);
  void move_mover(std::uint32_t chunk, std::uint32_t slot, const Box& box);
  void tighten_grown(std::uint32_t chunk);
  bool rest_movers(std::uint32_t chunk, std::uint32_t& budget);
  bool file_rested(std::uint32_t chunk, std::uint32_t& budget);
  void rest_grown();
  [[nodiscard]] bool keeps_movers() const noexcept;

  std::uint32_t add_group(std::uint32_t node);
  void put_in_group(std::uint32_t chunk, std::uint32_t group, const Box& bounds);
  void take_from_group(std::uint32_t chunk);
  std::uint32_t split_group(std::uint32_t group, const Box& newcomer);
  void add_objects(std::uint32_t group, std::int32_t change) noexcept;
  void set_bounds(std::uint32_t chunk, const Box& box) noexcept;
  void extend(std::uint32_t chunk, const Box& box) noexcept;
  void set_box(std::uint32_t group, const Box& box) noexcept;
  void extend_group(std::uint32_t group, const Box& box) noexcept;
  void shrink(std::uint32_t chunk, const Box& gone) noexcept;
  void shrink_group(std::uint32_t group, const Box& gone) noexcept;
  Status check_chunk(std::uint32_t chunk) const;
  Status check_group(std::uint32_t group) const;
  Status check_node(std::uint32_t node) const;
  static Box widened(const Box& box) noexcept;
  Box tight(const Chunk& chunk) const noexcept;
  Box tight(const Group& group) const noexcept;
  void loosen(std::uint32_t node, const Box& gone) noexcept;

  ChunkMapOptions options_;
  float columns_per_metre_ = 0, rows_per_metre_ = 0;
  std::uint32_t last_region_ = 0;  // of a row or column

  std::array<Pool, kPools> pools_;  // kStill, kMovers
  const std::uint64_t number_;      // unlike any other map's
  std::array<std::uint64_t, kPools> changes_{};
  geometry::LargeVector<Chunk> chunks_;
  std::vector<Split> splits_;
  std::vector<Key> keys_;
  std::unordered_map<std::uint32_t, std::uint32_t> key_of_regions_;
  geometry::LargeVector<Group> groups_;
  geometry::LargeVector<std::uint32_t> layer_rows_;  // of all groups, or none
  geometry::LargeVector<float> distance_rows_;       // the same
  std::vector<Node> nodes_;
  std::vector<std::uint8_t> loose_;  // one a node: its bounds may be too large
  bool any_loose_ = false;
  bool loosely_ = false;  // move_loosely() was called: bounds may be wide, splits may not lead to an object
  std::size_t misplaced_ = 0;  // how many chunks were given lanes anywhere since arrange()
  std::size_t inserted_ = 0;   // objects since tighten()

  std::vector<std::uint32_t> free_chunks_, free_splits_, free_groups_;
  std::vector<std::uint32_t> changed_;
  std::vector<std::uint32_t> dirty_;  // chunks that wait for flush()
  std::vector<Leaving> leaving_;      // slots that are holes once leave_now() is called
  std::array<std::vector<std::uint32_t>, kPools> leaving_bits_;  // or, of many, a bit an id
  std::vector<std::uint32_t> grown_;                             // still chunks with wide bounds or holes
  std::vector<std::uint32_t> mover_chunks_;                      // each chunk's `parent` is its place here
  std::uint32_t open_ = kNone;                                   // of these the one that takes the next mover
  std::size_t newcomers_ = 0;                                    // as expect_moves() was told
  std::size_t scattered_ = 0, in_runs_ = 0, joined_ = 0;         // since then: one by one; who became one
  std::size_t woken_ = 0;             // since rest(): who became a mover, or had not moved since it was there
  bool by_id_ = false;                // which stands in its page instead
  std::vector<std::uint32_t> pages_;  // the chunk of ids i * kCapacity … of each page i, or none
  // Where the lanes of the first page begin; the others' follow in order, and all are kept for them.
  std::uint32_t page_lane_ = kNone, kept_pages_ = 0;
  std::vector<std::uint32_t> new_pages_;  // which wait for flush()
  std::vector<std::uint32_t> stale_;      // chunks whose summaries wait for settle_columns()
  std::uint32_t mover_node_ = kNone, mover_group_ = kNone;
  std::size_t grown_hand_ = 0, mover_hand_ = 0;  // where rest() goes on
  Locations own_locations_;
  Locations* locations_;
  const Columns* columns_;
  std::size_t size_ = 0;
};

}  // namespace sightline::world
