// native_worlds COUNT FILE: random worlds that live through some frames, with what the library answers here:
// what web/test/worlds.test.mjs gives the package. Little-endian numbers, in the order they are written
// below.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include <sightline/sightline.hpp>

#include "web/test/writer.hpp"

namespace {

using namespace sightline;
using web::Writer;

class Random {  // splitmix64
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double between(double low, double high) { return low + (high - low) * unit(); }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(unit() * count); }

private:
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  std::uint64_t state_;
};

// Worlds of one kind: about the origin or far from it, narrow or over several sectors.
struct Place {
  WorldPoint centre;
  double reach = 0;
};

WorldBox box_in(Random& random, const Place& place, double most) {
  const auto about = [&](double centre) { return centre + random.between(-place.reach, place.reach); };
  const WorldPoint at{about(place.centre.x), about(place.centre.y) * 0.1, about(place.centre.z)};
  const auto half = [&] { return random.between(0.05, most); };
  const double x = half(), y = half(), z = half();
  return {{at.x - x, at.y - y, at.z - z}, {at.x + x, at.y + y, at.z + z}};
}

std::vector<WorldBox> boxes_in(Random& random, const Place& place, std::size_t count, double most) {
  std::vector<WorldBox> boxes(count);
  for (WorldBox& box : boxes) box = box_in(random, place, most);
  return boxes;
}

WorldView view_in(Random& random, const Place& place) {
  const float angle = static_cast<float>(random.between(0, 6.28)), c = std::cos(angle), s = std::sin(angle);
  WorldView view;
  view.origin = {place.centre.x + random.between(-0.5, 0.5) * place.reach, 0,
                 place.centre.z + random.between(-0.5, 0.5) * place.reach};
  view.view.width = 160, view.view.height = 100;
  const auto height = static_cast<float>(random.between(0, 10));
  view.view.world_to_eye.m = {c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, -height, 0, 1};
  const auto far = static_cast<float>(place.reach);
  const float near = 0.1f;
  if (random.below(4) == 0) {
    view.view.eye_to_clip.m = {2 / far, 0, 0, 0, 0, 3 / far, 0, 0, 0, 0, -1 / far, 0, 0, 0, 0, 1};
  } else {
    view.view.eye_to_clip.m = {
        0.9f, 0, 0, 0, 0, 1.44f, 0, 0, 0, 0, far / (near - far), -1, 0, 0, near * far / (near - far), 0};
  }
  return view;
}

/// The boxes as the view has them, to cast rays at and to cull flat.
std::vector<Box> about(const WorldPoint& origin, const std::vector<WorldBox>& boxes) {
  std::vector<Box> moved;
  for (const WorldBox& b : boxes) {
    const auto f = [](double x) { return static_cast<float>(x); };
    moved.push_back({{f(b.min.x - origin.x), f(b.min.y - origin.y), f(b.min.z - origin.z)},
                     {f(b.max.x - origin.x), f(b.max.y - origin.y), f(b.max.z - origin.z)}});
  }
  return moved;
}

struct Life {
  Random random;
  Place place;
  World world;
  Culler culler;
  OcclusionBuffer buffer;
  std::vector<WorldBox> boxes;
  std::vector<Handle> handles;
};

void require(const Status& status) {
  if (!status) std::fprintf(stderr, "%s\n", status.message()), std::exit(1);
}

CullResult write_cull(Life& life, Writer& out, std::span<const CullView> views,
                      const CullOptions& options = {}) {
  std::vector<std::uint32_t> ids(cull_capacity(life.world));
  std::vector<std::uint8_t> masks(ids.size());
  const auto culled = life.culler.cull(life.world, views, options, {ids, masks});
  require(culled.error());
  ids.resize(culled->count), masks.resize(culled->count);
  out.one(static_cast<std::uint32_t>(culled->count));
  out.all(ids), out.all(masks);
  return *culled;
}

void write_views(Life& life, Writer& out) {
  const std::vector<WorldBox> walls = boxes_in(life.random, life.place, 8, life.place.reach * 0.1);
  std::vector<CullView> views(1 + life.random.below(3));
  out.one(static_cast<std::uint32_t>(views.size()));
  for (CullView& view : views) {
    view.view = view_in(life.random, life.place);
    view.layers = 1u + life.random.below(15);
    view.min_area = life.random.below(3) == 0 ? 2.0f : 0.0f;
    out.one(view.view), out.one(view.layers), out.one(view.min_area);
  }
  out.one(static_cast<std::uint32_t>(walls.size()));
  out.all(walls);
  write_cull(life, out, views);
  require(life.buffer.begin(views[0].view));
  require(life.buffer.draw_boxes(BoxView(walls)));
  views[0].occlusion = &life.buffer;
  write_cull(life, out, {views.data(), 1});
}

void write_flat(Life& life, Writer& out) {
  const WorldView view = view_in(life.random, life.place);
  const std::vector<Box> boxes = about(view.origin, life.boxes);
  std::vector<ObjectId> seen(boxes.size() + kCullPadding);
  const auto culled = cull_boxes(make_frustum(view.view), BoxView(boxes), seen);
  require(culled.error());
  out.one(view), out.all(boxes);
  out.one(static_cast<std::uint32_t>(*culled));
  out.all(std::span<const ObjectId>(seen).first(*culled));

  std::vector<Ray> rays(64);
  const auto number = [&](double most) { return static_cast<float>(life.random.between(-most, most)); };
  for (Ray& ray : rays) {
    ray.origin = {number(life.place.reach), number(10), number(life.place.reach)};
    ray.direction = {number(1), number(0.2), number(1)};
    if (life.random.below(5) == 0) ray.direction.y = 0;
  }
  BoxBvh bvh;
  require(bvh.build(BoxView(boxes)));
  std::vector<ObjectId> objects(rays.size());
  std::vector<float> distances(rays.size());
  require(bvh.cast(rays, objects, distances));
  out.all(rays), out.all(objects), out.all(distances);
}

// Moves a fifth, takes a tenth out, puts some in: what the ids of later frames depend on.
void write_change(Life& life, Writer& out) {
  std::vector<std::uint32_t> moved, gone;
  for (std::uint32_t i = 0; i < life.boxes.size(); ++i) {
    if (life.random.below(5) == 0) moved.push_back(i);
  }
  for (std::uint32_t i = static_cast<std::uint32_t>(life.boxes.size()); i-- > 0;) {
    if (life.random.below(10) == 0) gone.push_back(i);  // descending
  }
  out.one(static_cast<std::uint32_t>(moved.size()));
  out.all(moved);
  std::vector<Handle> named;
  std::vector<WorldBox> to;
  for (const std::uint32_t i : moved) {
    to.push_back(life.boxes[i] = box_in(life.random, life.place, 4));
    named.push_back(life.handles[i]);
  }
  require(life.world.move(named, to));
  out.all(to);
  out.one(static_cast<std::uint32_t>(gone.size()));
  out.all(gone);
  for (const std::uint32_t i : gone) {
    require(life.world.remove({&life.handles[i], 1}));
    life.boxes.erase(life.boxes.begin() + i), life.handles.erase(life.handles.begin() + i);
  }
  const std::vector<WorldBox> more = boxes_in(life.random, life.place, life.random.below(40), 4);
  std::vector<Handle> handles(more.size());
  require(life.world.insert(more, handles));
  out.one(static_cast<std::uint32_t>(more.size()));
  out.all(more);
  life.boxes.insert(life.boxes.end(), more.begin(), more.end());
  life.handles.insert(life.handles.end(), handles.begin(), handles.end());
}

// A unit cube in three words: a box, triangles, and a ball inside it.
std::vector<OccluderId> add_cubes(World& world) {
  Occluder box, shell;
  box.boxes = {{{0, 0, 0}, {1, 1, 1}}};
  for (int i = 0; i < 8; ++i)
    shell.positions.push_back(
        {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2 & 1)});
  shell.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                   2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  shell.sides = {Sides::front};
  shell.solid_triangles = 12;
  const Sphere ball{{0.5f, 0.5f, 0.5f}, 0.5f};
  std::vector<OccluderId> cubes;
  for (const auto& added :
       {world.add_occluder(box), world.add_occluder(shell), world.add_occluder({}, {&ball, 1})}) {
    require(added.error());
    cubes.push_back(*added);
  }
  return cubes;
}

Mat4 cube_to(const WorldBox& box, const WorldPoint& origin) {
  const auto f = [](double x) { return static_cast<float>(x); };
  Mat4 m;
  m.m[0] = f(box.max.x - box.min.x), m.m[5] = f(box.max.y - box.min.y), m.m[10] = f(box.max.z - box.min.z);
  m.m[12] = f(box.min.x - origin.x), m.m[13] = f(box.min.y - origin.y), m.m[14] = f(box.min.z - origin.z);
  return m;
}

// Frames with automatic occlusion: walls that carry occluders, some of which are switched off in the third
// frame; a box that is one triangle from the fourth frame on; a camera that goes on.
void write_automatic(Life& life, Writer& out) {
  const std::vector<WorldBox> walls = boxes_in(life.random, life.place, 9, life.place.reach * 0.1);
  std::vector<Handle> handles(walls.size());
  require(life.world.insert(walls, handles));
  const std::vector<OccluderId> cubes = add_cubes(life.world);
  std::vector<OccluderPlacement> placements;
  for (std::size_t i = 0; i < walls.size(); ++i)
    placements.push_back({cubes[i % 3], cube_to(walls[i], life.place.centre), life.place.centre});
  require(life.world.set_occluders(handles, placements));
  out.all(walls);
  for (const OccluderPlacement& placement : placements) out.one(placement.transform);
  out.one(life.place.centre);

  std::vector<CullView> views(1 + life.random.below(2));
  for (CullView& view : views) view.view = view_in(life.random, life.place);
  out.one(static_cast<std::uint32_t>(views.size()));
  CullOptions options;
  options.occlusion = Occlusion::automatic;
  options.costs.object = static_cast<float>(life.random.below(3)) * 20'000;  // 0: what frames teach
  out.one(options.costs.object);
  const std::vector<std::uint8_t> on{0, 1, 0, 1, 0, 1, 0, 1, 0};
  const Vec3 triangle[] = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int frame = 0; frame < 6; ++frame) {
    for (CullView& view : views) view.view.origin.x += 0.1, out.one(view.view);
    if (frame == 2)
      require(life.world.set_occluding(handles, Strided<const std::uint8_t>(on.data(), on.size())));
    if (frame == 3) require(life.world.set_triangles(handles[8], triangle, views[0].view.origin));
    const CullResult culled = write_cull(life, out, views, options);
    out.one(static_cast<double>(culled.culled_occlusion)), out.one(culled.cost), out.one(culled.frustum_cost);
    require(life.culler.report_frame_time(1e5 + 3e3 * static_cast<double>(culled.count)));
  }
}

void write_world(std::uint64_t seed, Writer& out) {
  Life life{Random(seed), {}, {}, {}, {}, {}, {}};
  const double reaches[] = {60, 400, 9000};
  life.place.reach = reaches[life.random.below(3)];
  if (life.random.below(3) == 0) life.place.centre = {6.4e6, 0, -3.2e6};
  life.boxes = boxes_in(life.random, life.place, 20 + life.random.below(400), 4);
  life.handles.resize(life.boxes.size());
  std::vector<std::uint32_t> layers(life.boxes.size());
  for (std::uint32_t& layer : layers) layer = 1u << life.random.below(4);
  require(life.world.insert(life.boxes, life.handles, {layers, {}}));
  out.one(static_cast<std::uint32_t>(life.boxes.size()));
  out.all(life.boxes), out.all(layers);
  for (int frame = 0; frame < 3; ++frame) write_views(life, out), write_change(life, out);
  out.one(static_cast<std::uint32_t>(life.boxes.size()));
  write_flat(life, out);
  write_automatic(life, out);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::fprintf(stderr, "usage: native_worlds COUNT FILE\n"), 2;
  std::FILE* file = std::fopen(arguments[2], "wb");
  if (!file) return std::perror(arguments[2]), 2;
  Writer out(file);
  const auto worlds = static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10));
  out.one(worlds);
  for (std::uint32_t i = 0; i < worlds; ++i) write_world(i, out);
  return std::fclose(file) == 0 && out.good() ? 0 : 1;
}
