// Who is near whom, for moving objects: chunks of fewer than 100 boxes by ground region (Lee & Shin 2023,
// section 3.1), kept right while objects come, move and go, at a cost that does not depend on how many stand.
//
// The ground rectangle (x-z) is split like a quadtree down to `depth`. An object is homed by the set of leaf
// regions its box touches: one region makes its chunk an own chunk, several make it a chunk shared by exactly
// those. As boxes lie along the axes the set is always a rectangle of leaf regions, so four numbers are its
// key. Within a key, chunks split by a k-d tree over the box centres when they are full. Above the chunks
// stand groups of up to 32 chunks, and above these the quadtree's nodes; bounds are tight unions at every
// chunk and group, and never too small at a node.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/status.hpp>

#include "library/geometry/aligned_vector.hpp"

namespace sightline::world {

/// Rows and columns of leaf regions, last ones included, that a box touches.
struct RegionSet {
  std::uint8_t first_x = 0, first_z = 0, last_x = 0, last_z = 0;
  bool operator==(const RegionSet&) const = default;
  /// Whether more than one region is touched.
  [[nodiscard]] bool shared() const noexcept { return first_x != last_x || first_z != last_z; }
};

/// The one vertex that stands for an object in the culling pass. The half extent is rounded up, so that
/// centre ± half_extent surely holds the box. Laid out as two vec4.
struct ChunkVertex {
  Vec3 centre;
  ObjectId object = kNoObject;
  Vec3 half_extent;
  std::uint32_t chunk = 0;
};

struct ChunkMapOptions {
  Box ground;               ///< its x-z rectangle is split; what stands outside belongs to the nearest region
  std::uint32_t depth = 3;  ///< of the quadtree, 0 … 6; 4^depth leaf regions
};

class ChunkMap {
public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kCapacity = 96;       ///< objects a chunk; a multiple of every SIMD width
  static constexpr std::uint32_t kSmallCapacity = 16;  ///< of a chunk that has never held more
  static constexpr std::uint32_t kGroupCapacity = 32;  ///< chunks a group
  static constexpr std::uint32_t kMaxDepth = 6;

  /// Where an object stands.
  struct Location {
    std::uint32_t chunk = kNone, slot = 0;
  };
  /// One a possible object id; maps that share no object may share the table.
  using Locations = std::vector<Location>;

  /// The objects of a chunk: arrays of `count` values, aligned to 64 bytes and readable up to the next
  /// multiple of 16.
  struct ChunkView {
    const float *min_x, *min_y, *min_z, *max_x, *max_y, *max_z;
    const ObjectId* objects;
    std::uint32_t count;
  };

  /// Bounds of up to 32 chunks, one array a coordinate in the order of ChunkView.
  struct alignas(64) Group {
    std::array<std::array<float, kGroupCapacity>, 6> bounds{};
    std::array<std::uint32_t, kGroupCapacity> chunks{};
    /// Of each chunk, what ChunkMap::chunk() would look up elsewhere: where its lanes begin, and how many
    /// objects it holds, with kSmall set where it has kSmallCapacity.
    std::array<std::uint32_t, kGroupCapacity> first_lane{}, count_and_size{};
    static constexpr std::uint32_t kSmall = 0x80000000u;
    Box box;                  ///< of all of them
    std::uint32_t count = 0;  ///< 0: the group is free
    std::uint32_t node = 0, index_in_node = 0;
    std::uint32_t objects = 0;
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
  /// entry for each id before it is inserted.
  explicit ChunkMap(const ChunkMapOptions& options, Locations* shared_locations = nullptr);
  ChunkMap(const ChunkMap&) = delete;
  ChunkMap& operator=(const ChunkMap&) = delete;

  /// Boxes must be valid (finite, min <= max); ids inserted must be absent, ids moved or removed present.
  void insert(ObjectId object, const Box& box);
  void move(ObjectId object, const Box& box);
  void remove(ObjectId object);
  /// Objects 0 … size-1 of an empty map at once; the same as inserting them one by one.
  void insert_all(const Boxes& boxes);

  [[nodiscard]] bool contains(ObjectId object) const noexcept;
  [[nodiscard]] Box box(ObjectId object) const noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const ChunkMapOptions& options() const noexcept { return options_; }
  [[nodiscard]] Location location(ObjectId object) const noexcept { return (*locations_)[object]; }

  /// Chunk numbers lie below this; free ones have a count of 0. A number may be reused.
  [[nodiscard]] std::uint32_t chunk_limit() const noexcept {
    return static_cast<std::uint32_t>(chunks_.size());
  }
  [[nodiscard]] ChunkView chunk(std::uint32_t chunk) const noexcept {
    const Chunk& c = chunks_[chunk];
    return {lanes(c, 0),
            lanes(c, 1),
            lanes(c, 2),
            lanes(c, 3),
            lanes(c, 4),
            lanes(c, 5),
            ids_.data() + c.first_lane,
            c.count};
  }
  /// The chunk at place i of a group.
  [[nodiscard]] ChunkView chunk(const Group& group, std::uint32_t i) const noexcept {
    const std::uint32_t first = group.first_lane[i], size = group.count_and_size[i];
    const std::size_t step = size & Group::kSmall ? kSmallCapacity : kCapacity;
    const float* at = lanes_.data() + 6 * std::size_t{first};
    return {at,
            at + step,
            at + 2 * step,
            at + 3 * step,
            at + 4 * step,
            at + 5 * step,
            ids_.data() + first,
            size & ~Group::kSmall};
  }
  /// Tight union of the chunk's boxes.
  [[nodiscard]] Box chunk_bounds(std::uint32_t chunk) const noexcept;
  [[nodiscard]] RegionSet chunk_regions(std::uint32_t chunk) const noexcept;
  /// Which leaf regions a box touches.
  [[nodiscard]] RegionSet regions(const Box& box) const noexcept;
  /// Writes the chunk's vertices; room for its count is needed. Returns how many.
  std::uint32_t write_vertices(std::uint32_t chunk, std::span<ChunkVertex> out) const noexcept;

  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  [[nodiscard]] std::span<const Group> groups() const noexcept { return groups_; }

  /// Chunks whose objects or boxes changed since the last acknowledge_changes(), freed ones included.
  [[nodiscard]] std::span<const std::uint32_t> changed_chunks() const noexcept { return changed_; }
  void acknowledge_changes() noexcept;

  /// Shrinks the bounds of quadtree nodes that moves and removals left too large; and once most chunks stand
  /// where there happened to be room, puts neighbours' lanes side by side: who reads a group then reads few
  /// pages of memory, and looking a page up costs more than reading a line of it. Spread over the insertions
  /// between, that copies each object less than thrice. ChunkViews are void afterwards.
  void tighten();

  /// Whether every invariant above holds; for tests, it looks at everything.
  [[nodiscard]] Status check() const;

private:
  struct Chunk {
    Box cell;  // of the centres that the k-d tree sends here
    std::uint32_t first_lane = 0, capacity = 0, count = 0;
    std::uint32_t key = kNone, parent = kNone;
    std::uint32_t next = kNone, previous = kNone;  // chunks that could not be split: all centres equal
    std::uint32_t group = kNone, index_in_group = 0;
    bool changed = false;
  };
  struct Key {
    RegionSet regions;
    std::uint32_t node = 0;      // of the quadtree
    std::uint32_t root = kNone;  // k-d reference
  };
  // A k-d reference is a split, or a chunk with the highest bit set.
  static constexpr std::uint32_t kChunkBit = 0x80000000u;
  static constexpr bool is_chunk(std::uint32_t reference) { return reference & kChunkBit; }

  struct Split {
    float at = 0;
    std::uint32_t axis = 0, parent = kNone;
    std::array<std::uint32_t, 2> child{};  // k-d references: centre < at, centre >= at
  };

  float* lanes(const Chunk& chunk, std::uint32_t side) noexcept {
    return lanes_.data() + 6 * std::size_t{chunk.first_lane} + side * chunk.capacity;
  }
  const float* lanes(const Chunk& chunk, std::uint32_t side) const noexcept {
    return lanes_.data() + 6 * std::size_t{chunk.first_lane} + side * chunk.capacity;
  }
  Box box_at(const Chunk& chunk, std::uint32_t slot) const noexcept;
  void write(std::uint32_t chunk, std::uint32_t slot, ObjectId object, const Box& box) noexcept;

  void build_nodes();
  std::uint32_t find_key(RegionSet regions);
  std::uint32_t find_chunk(const Key& key, const Vec3& centre) const noexcept;
  std::uint32_t add_chunk(std::uint32_t key, std::uint32_t capacity, Box cell);
  void free_chunk(std::uint32_t chunk);
  std::uint32_t make_room(std::uint32_t chunk, const Vec3& centre);
  bool split(std::uint32_t chunk);
  void grow(std::uint32_t chunk);
  void unlink(std::uint32_t chunk);
  void try_merge(std::uint32_t chunk);
  void replace_reference(std::uint32_t key, std::uint32_t parent, std::uint32_t from,
                         std::uint32_t to) noexcept;
  std::uint32_t take_lanes(std::uint32_t capacity);
  void give_lanes(std::uint32_t first, std::uint32_t capacity);
  void append(std::uint32_t chunk, ObjectId object, const Box& box);
  void erase_slot(std::uint32_t chunk, std::uint32_t slot) noexcept;
  void note_change(std::uint32_t chunk);
  void note_shape(std::uint32_t chunk) noexcept;
  void arrange();

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
  Box tight(const Chunk& chunk) const noexcept;
  Box tight(const Group& group) const noexcept;
  void loosen(std::uint32_t node, const Box& gone) noexcept;

  ChunkMapOptions options_;
  float columns_per_metre_ = 0, rows_per_metre_ = 0;
  std::uint32_t last_region_ = 0;  // of a row or column

  geometry::LargeVector<float> lanes_;
  geometry::LargeVector<ObjectId> ids_;
  std::vector<Chunk> chunks_;
  std::vector<Split> splits_;
  std::vector<Key> keys_;
  std::unordered_map<std::uint32_t, std::uint32_t> key_of_regions_;
  geometry::LargeVector<Group> groups_;
  std::vector<Node> nodes_;
  std::vector<std::uint8_t> loose_;  // one a node: its bounds may be too large
  bool any_loose_ = false;
  std::size_t misplaced_ = 0;  // how many chunks were given lanes anywhere since arrange()

  std::vector<std::uint32_t> free_chunks_, free_splits_, free_groups_, free_small_, free_large_;
  std::vector<std::uint32_t> changed_;
  Locations own_locations_;
  Locations* locations_;
  std::size_t size_ = 0;
};

/// What a walk of the regions leaves, reused frame after frame.
struct ChunkWalk {
  std::vector<std::uint32_t> inside;    ///< chunks wholly in the frustum
  std::vector<std::uint32_t> crossing;  ///< chunks whose bounds cross it
  std::uint64_t nodes_visited = 0;      ///< regions, groups and chunks looked at

  void clear() noexcept {
    inside.clear();
    crossing.clear();
    nodes_visited = 0;
  }
};

/// Walks the regions from the whole ground down and drops what the frustum misses; the same chunks in the
/// same order for the same history of the map. Fills `out` anew.
void walk(const ChunkMap& map, const Frustum& frustum, ChunkWalk& out);

}  // namespace sightline::world
