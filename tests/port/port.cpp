// Prints what the library answers: visible sets, what rays meet, and depth images. scripts/check-answers.sh
// holds every build and processor against tests/port/library.txt. Worlds and views are made by what rounds
// alike everywhere.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <sightline/sightline.hpp>

#include "library/geometry/elementary.hpp"
#include "library/rays/wide_rays.hpp"
#include "port/answers.hpp"
#include "support/run_threads.hpp"
#include "workbench/scene/random.hpp"

namespace {

using namespace sightline;

using test::Answers;
using test::Hash;

void add_vec(Hash& hash, const Vec3& v) {
  hash.add(v.x), hash.add(v.y), hash.add(v.z);
}
void add_plane(Hash& hash, const Plane& p) {
  add_vec(hash, p.normal), hash.add(p.distance);
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
float dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3 normalised(const Vec3& v) {
  const float length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

enum class Kind { perspective, reversed, orthographic };

View view_of(scene::Random& random, Kind kind, const Vec3& eye) {
  const Vec3 back =
      normalised({random.between(-1, 1), random.between(-0.3f, 0.3f), random.between(0.2f, 1.0f)});
  const Vec3 right = normalised(cross({0, 1, 0}, back)), up = cross(back, right);
  View view;
  view.width = 320, view.height = 200;
  view.world_to_eye.m = {right.x, up.x, back.x, 0, right.y,          up.y,          back.y,          0,
                         right.z, up.z, back.z, 0, -dot(right, eye), -dot(up, eye), -dot(back, eye), 1};
  const float near = 0.1f, far = 1000, scale_x = 0.9f, scale_y = 1.44f;
  switch (kind) {
    case Kind::perspective:
      view.eye_to_clip.m = {
          scale_x, 0, 0, 0, 0, scale_y, 0, 0, 0, 0, far / (near - far), -1, 0, 0, near * far / (near - far),
          0};
      break;
    case Kind::reversed:  // without a far plane
      view.eye_to_clip.m = {scale_x, 0, 0, 0, 0, scale_y, 0, 0, 0, 0, 0, -1, 0, 0, near, 0};
      break;
    case Kind::orthographic:
      view.eye_to_clip.m = {0.01f, 0, 0, 0, 0, 0.016f, 0, 0, 0, 0, -0.001f, 0, 0, 0, 0, 1};
  }
  return view;
}

constexpr Box kSpace{{-200, -10, -200}, {200, 30, 200}};
/// Holds all boxes about points in there.
constexpr Box kReach{{-210, -20, -210}, {210, 40, 210}};

Box box_of(scene::Random& random, float most) {
  const Vec3 at = random.inside(kSpace);
  const Vec3 half{random.between(0.1f, most), random.between(0.1f, most), random.between(0.1f, most)};
  return {{at.x - half.x, at.y - half.y, at.z - half.z}, {at.x + half.x, at.y + half.y, at.z + half.z}};
}

WorldBox world_box(const Box& b) {
  return {{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}};
}

struct NamedView {
  std::string name;
  View view;
};

std::vector<NamedView> views() {
  scene::Random random(1);
  std::vector<NamedView> all;
  for (const auto& [name, kind] : {std::pair{"perspective", Kind::perspective},
                                   {"reversed", Kind::reversed},
                                   {"orthographic", Kind::orthographic}}) {
    for (int i = 0; i < 4; ++i) {
      const Vec3 eye = random.inside({{-100, 0, -100}, {100, 20, 100}});
      all.push_back({std::string(name) + "." + std::to_string(i), view_of(random, kind, eye)});
    }
  }
  return all;
}

void answer_elementary(Answers& out) {
  scene::Random random(8);
  Hash angles, numbers;
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.between(-1, 1) * (i % 2 == 0 ? 7.0 : 1e6);
    angles.add(portable::sin(angle)), angles.add(portable::cos(angle)), angles.add(portable::tan(angle));
    const double number = portable::exp(static_cast<double>(random.between(-700, 700)));
    numbers.add(number), numbers.add(portable::log(number));
  }
  out.add("elementary.angles", angles), out.add("elementary.numbers", numbers);
}

void answer_geometry(const std::vector<NamedView>& views, Answers& out) {
  Hash planes, points, areas, rects;
  scene::Random random(2);
  for (const NamedView& named : views) {
    const Frustum frustum = make_frustum(named.view);
    for (const Plane& plane : frustum.planes) add_plane(planes, plane);
    add_vec(points, eye_position(named.view)), add_vec(points, view_direction(named.view));
    const Mat4 to_clip = world_to_clip(named.view);
    for (const float x : to_clip.m) points.add(x);
    const Projector projector = make_projector(named.view, kReach);
    for (int i = 0; i < 500; ++i) {
      const Sphere sphere{random.inside(kSpace), random.between(0.1f, 5)};
      areas.add(projected_area(projector, sphere)), areas.add(projected_area_bound(projector, sphere));
      const Rect rect = projected_rect(projector, box_of(random, 4));
      rects.add(rect.min_x), rects.add(rect.min_y), rects.add(rect.max_x), rects.add(rect.max_y);
    }
  }
  out.add("geometry.planes", planes), out.add("geometry.points", points);
  out.add("geometry.areas", areas), out.add("geometry.rectangles", rects);
  Hash made;
  const Result<View> view = make_view({.eye = {1, 2, 3}, .forward = {1, 0.2f, 3}}, 1280, 720);
  for (const float x : view->eye_to_clip.m) made.add(x);
  out.add("geometry.make_view", made);
}

void answer_frustum(const std::vector<NamedView>& views, Answers& out) {
  scene::Random random(3);
  Boxes boxes;
  std::vector<float> x, y, z, radius;
  for (int i = 0; i < 20000; ++i) {
    boxes.push_back(box_of(random, 3));
    const Vec3 at = random.inside(kSpace);
    x.push_back(at.x), y.push_back(at.y), z.push_back(at.z), radius.push_back(random.between(0.1f, 4));
  }
  std::vector<ObjectId> visible(boxes.size() + kCullPadding);
  for (const NamedView& named : views) {
    const Frustum planes = make_frustum(named.view);
    const std::size_t seen = *cull_boxes(planes, boxes.view(), visible);
    out.add_all("frustum.boxes." + named.name, std::span(visible).first(seen));
    const std::size_t round = *cull_spheres(
        planes, SphereView::arrays(x.data(), y.data(), z.data(), radius.data(), x.size()), visible);
    out.add_all("frustum.spheres." + named.name, std::span(visible).first(round));
  }
}

void expect(const Status& status) {
  if (!status) std::printf("refused: %s\n", status.message());
}

// Walls, and a mesh: a sphere's octahedron, coarse and closed.
void draw_occluders(OcclusionBuffer& buffer) {
  scene::Random random(4);
  std::vector<Box> walls;
  for (int i = 0; i < 60; ++i) {
    const Vec3 at = random.inside(kSpace);
    walls.push_back({{at.x - 12, -10, at.z - 1}, {at.x + 12, at.y + 5, at.z + 1}});
  }
  expect(buffer.draw_boxes(walls));
  const std::vector<Vec3> corners{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<std::uint32_t> faces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                         2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const OccluderMesh mesh = *OccluderMesh::make(corners, faces);
  for (int i = 0; i < 30; ++i) {
    const Vec3 at = random.inside(kSpace);
    const float size = random.between(1, 9);
    const float turned = 0.3f * size;
    expect(buffer.draw_mesh(mesh,
                            {{size, 0, -turned, 0, 0, size, 0, 0, turned, 0, size, 0, at.x, at.y, at.z, 1}}));
  }
}

void answer_occlusion(const std::vector<NamedView>& views, Answers& out) {
  scene::Random random(5);
  Boxes boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back(box_of(random, 2));
  OcclusionBuffer buffer;
  std::vector<float> depth;
  std::vector<std::uint8_t> seen(boxes.size());
  for (const NamedView& named : views) {
    expect(buffer.begin({named.view, {}}, {Coverage::centres}));
    draw_occluders(buffer);
    depth.assign(std::size_t{named.view.width} * named.view.height, 0);
    expect(buffer.read_nearness(depth));
    out.add_all("occlusion.depth." + named.name, depth);
    Hash covered;
    for (const float nearness : depth) covered.add(static_cast<std::uint8_t>(nearness > 0));
    out.add("occlusion.coverage." + named.name, covered);
    expect(buffer.may_see(boxes.view(), seen));
    out.add_all("occlusion.boxes." + named.name, seen);
    const auto answer_by = [&](const std::string& name, const OcclusionOptions& options) {
      expect(buffer.begin({named.view, {}}, options));
      draw_occluders(buffer);
      expect(buffer.read_nearness(depth));
      expect(buffer.may_see(boxes.view(), seen));
      Hash hash;
      for (const float nearness : depth) hash.add(nearness);
      for (const std::uint8_t answer : seen) hash.add(answer);
      out.add("occlusion." + name + "." + named.name, hash);
    };
    answer_by("area", {Coverage::area});
    answer_by("half", {Coverage::centres, 2});
    answer_by("quarter_area", {Coverage::area, 4});
  }
}

// Layers and distances of neighbours, or each object's own; from two places at once, one of which measures
// from the other.
void answer_columns(const std::vector<NamedView>& views, Answers& out) {
  scene::Random random(9);
  std::vector<WorldBox> boxes;
  std::vector<std::uint32_t> layers;
  std::vector<DistanceRange> distances;
  for (int i = 0; i < 30000; ++i) {
    boxes.push_back(world_box(box_of(random, 3)));
    const bool own = boxes.back().min.x > 0;
    layers.push_back(own ? 1 + random.below(7) : 3);
    distances.push_back({own ? random.between(0, 50) : 0, random.between(own ? 50 : 200, 200)});
  }
  std::vector<Handle> handles(boxes.size());
  World world;
  expect(world.insert(boxes, handles,
                      {.layers = std::span<const std::uint32_t>(layers),
                       .distances = std::span<const DistanceRange>(distances)}));
  Culler culler;
  const CullOptions options{.jobs = {test::run_threads, nullptr, out.threads}};
  std::vector<ObjectId> visible(cull_capacity(world, options));
  std::vector<std::uint8_t> masks(visible.size());
  for (const NamedView& named : views) {
    const std::array both{CullView{.view = {named.view, {}}, .layers = 2},
                          CullView{.view = {views[0].view, {}}, .distance_scale = 0.7f, .distance_view = 0}};
    const auto culled = culler.cull(world, both, options, {visible, masks});
    const std::size_t count = culled ? culled->count : 0;
    expect(culled.error());
    out.add_all("world.columns." + named.name, std::span(visible).first(count));
    out.add_all("world.columns_masks." + named.name, std::span(masks).first(count));
    const auto one = culler.cull(world, both[0], visible);
    expect(one.error());
    out.add_all("world.columns_alone." + named.name, std::span(visible).first(one ? one->count : 0));
  }
}

void answer_world(const std::vector<NamedView>& views, Answers& out) {
  scene::Random random(6);
  std::vector<WorldBox> boxes;
  for (int i = 0; i < 30000; ++i) boxes.push_back(world_box(box_of(random, 3)));
  std::vector<Handle> handles(boxes.size());
  World world;
  expect(world.insert(boxes, handles));
  Culler culler;
  OcclusionBuffer buffer;
  const CullOptions options{.jobs = {test::run_threads, nullptr, out.threads}};
  std::vector<ObjectId> visible(cull_capacity(world, options));
  for (const NamedView& named : views) {
    for (std::size_t i = 0; i < boxes.size(); i += 7) {
      const double step = random.between(-2, 2);
      boxes[i].min.x += step, boxes[i].max.x += step;
      expect(world.move({&handles[i], 1}, std::span(&boxes[i], 1)));
    }
    CullView view{.view = {named.view, {}}};
    const auto cull = [&](const char* with) {
      const auto culled = culler.cull(world, {&view, 1}, options, {visible});
      expect(culled.error());
      out.add_all("world." + std::string(with) + "." + named.name,
                  std::span(visible).first(culled ? culled->count : 0));
    };
    cull("frustum");
    expect(buffer.begin(view.view, {Coverage::centres}));
    draw_occluders(buffer);
    view.occlusion = &buffer;
    cull("occlusion");
    view.occlusion = nullptr, view.min_area = 4;
    cull("contribution");
  }
}

// A world in many places, turned and scaled; seen in part, and hidden in part.
void answer_instances(const std::vector<NamedView>& views, Answers& out) {
  scene::Random random(10);
  std::vector<WorldBox> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(world_box(box_of(random, 3)));
  std::vector<Handle> objects(boxes.size());
  World world;
  expect(world.insert(boxes, objects));
  Instances instances;
  const PlacedWorldId name = *instances.add_world(world);
  std::vector<InstancePlacement> placements;
  for (int i = 0; i < 40; ++i) {
    const float size = random.between(0.1f, 0.5f), c = 0.8f * size, s = 0.6f * size;
    const Vec3 at = random.inside(kSpace);
    placements.push_back({name, {{c, 0, -s, 0, 0, size, 0, 0, s, 0, c, 0, at.x, at.y, at.z, 1}}, {}});
  }
  std::vector<Handle> handles(placements.size());
  expect(instances.insert(placements, handles));
  InstanceCuller culler;
  OcclusionBuffer buffer;
  const InstanceCullOptions options{.jobs = {test::run_threads, nullptr, out.threads}, .masks = true};
  for (const NamedView& named : views) {
    const WorldView view{named.view, {}};
    expect(buffer.begin(view, {Coverage::centres}));
    draw_occluders(buffer);
    const std::array both{CullView{.view = view},
                          CullView{.view = view, .occlusion = &buffer, .min_area = 4}};
    for (const std::size_t count : {1, 2}) {
      const auto seen = culler.cull(instances, std::span(both).first(count), options);
      expect(seen.error());
      if (!seen) continue;
      Hash ranges;
      for (const auto& [instance, first, objects_seen] : seen->ranges)
        ranges.add(instance), ranges.add(first), ranges.add(objects_seen);
      const std::string by = "instances." + std::to_string(count) + "_views." + named.name;
      out.add(by, ranges);
      out.add_all(by + ".ids", seen->ids);
      out.add_all(by + ".masks", seen->masks);
    }
  }
}

void answer_rays(const std::vector<NamedView>& views, Answers& out) {
  scene::Random random(7);
  Boxes boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back(box_of(random, 4));
  rays::WideBvh tree;
  tree.build(boxes);
  rays::WideStack stack;
  rays::RayHits hits;
  rays::RayGrid grid;
  for (const NamedView& named : views) {
    grid.make(named.view, 80, 50);
    rays::cast_wide(tree, grid, stack, hits);
    out.add_all("rays.objects." + named.name, hits.object);
    out.add_all("rays.distances." + named.name, hits.distance);
  }
  // From anywhere, any way: few go along with their neighbours.
  grid.prepared.clear(), grid.order.clear();
  for (std::uint32_t i = 0; i < 4001; ++i) {
    const Vec3 to{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    grid.prepared.emplace_back(Ray{random.inside(kSpace), to});
    grid.order.push_back(i);
  }
  grid.rays.resize(grid.prepared.size());
  rays::cast_wide(tree, grid, stack, hits);
  out.add_all("rays.objects.anywhere", hits.object);
  out.add_all("rays.distances.anywhere", hits.distance);
}

}  // namespace

int main() {
  const std::vector<NamedView> all = views();
  const int others = test::print_answers([&](Answers& out) {
    answer_elementary(out);
    answer_geometry(all, out);
    answer_frustum(all, out);
    answer_occlusion(all, out);
    answer_world(all, out);
    answer_columns(all, out);
    answer_instances(all, out);
    answer_rays(all, out);
  });
  return others == 0 ? 0 : 1;
}
