// The C++ API beside World: views, frusta, projections, flat culling, occlusion buffers, rays. Any numbers
// may go in where a header does not say otherwise, and views with null pointers, strides and counts that are
// none, spans that are too short and buffers that were never begun; nothing may crash, and answers must be
// ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <sightline/sightline.hpp>

#include "views.hpp"

namespace {

using namespace sightline;
using fuzz::box_of;
using fuzz::Numbers;
using fuzz::require;

constexpr std::size_t kTooMany = static_cast<std::size_t>(-1);

// Whether the call did what it says; a refusal has a sentence and a code that is one.
bool done(const Status& status) {
  require(status.message() && *status.message() && status.code() <= StatusCode::bad_file);
  require(static_cast<bool>(status) == (status.code() == StatusCode::ok));
  return static_cast<bool>(status);
}
template <class T>
bool done(const Result<T>& result) {
  require(static_cast<bool>(result) == done(result.error()));
  return static_cast<bool>(result);
}

// Boxes and spheres in a caller's structs.
struct Thing {
  std::uint8_t tag;
  Box box;
  Sphere sphere;
};

struct Scenery {
  Boxes boxes;
  std::vector<Thing> things;
  std::vector<float> x, y, z, radius;

  explicit Scenery(Numbers& in) {
    things.resize(in.byte() % 40);
    for (Thing& thing : things) {
      const Box box = in.rarely() ? Box{in.point(), in.point()} : box_of(in);
      const Sphere sphere{in.point(), in.number()};
      thing.box = box, thing.sphere = sphere;
      boxes.push_back(box);
      x.push_back(sphere.centre.x), y.push_back(sphere.centre.y), z.push_back(sphere.centre.z);
      radius.push_back(sphere.radius);
    }
  }
  [[nodiscard]] std::size_t size() const { return things.size(); }
};

template <class T>
T* member(Thing* first, std::size_t offset) {
  return first ? reinterpret_cast<T*>(reinterpret_cast<std::byte*>(first) + offset) : nullptr;
}

// The boxes as arrays, as members of structs, or as what is neither.
BoxView view_of_boxes(Numbers& in, Scenery& from, bool& right) {
  Thing* first = from.things.data();
  auto* minimum = member<float>(first, offsetof(Thing, box));
  auto* maximum = member<float>(first, offsetof(Thing, box) + offsetof(Box, max));
  std::size_t stride = sizeof(Thing), count = from.size();
  right = true;
  switch (in.byte() % 16) {
    case 0:
      right = count == 0, minimum = nullptr;
      break;
    case 1:
      right = count == 0, stride = in.byte() % 12;
      break;
    case 2:
      right = count == 0, stride = kTooMany;
      break;
    case 3:
      right = false, count = kTooMany - in.byte();
      break;
    case 4:
      return BoxView::centre_half(minimum, maximum, stride, count, {in.number(), 0, 0});
    case 5:
      return BoxView::min_max(minimum, maximum, stride, count, {in.number(), 0, in.number()});
    case 6:
    case 7:
      return BoxView::min_max(minimum, maximum, stride, count);
    default:
      return from.boxes.view();
  }
  const BoxView view = BoxView::min_max(minimum, maximum, stride, count);
  require(view.sound() == right);
  return view;
}

SphereView view_of_spheres(Numbers& in, Scenery& from, bool& right) {
  Thing* first = from.things.data();
  auto* centre = member<float>(first, offsetof(Thing, sphere));
  auto* radius = member<float>(first, offsetof(Thing, sphere) + offsetof(Sphere, radius));
  right = true;
  switch (in.byte() % 8) {
    case 0:
      right = from.size() == 0;
      return {centre, nullptr, sizeof(Thing), from.size()};
    case 1:
      right = from.size() == 0;
      return {centre, radius, 11, from.size()};
    case 2:
      right = false;
      return {centre, radius, sizeof(Thing), kTooMany};
    case 3:
      return {centre, radius, sizeof(Thing), from.size()};
    default:
      return SphereView::arrays(from.x.data(), from.y.data(), from.z.data(), from.radius.data(), from.size());
  }
}

void flat(Numbers& in, const View& view, Scenery& from) {
  const Box around = box_of(in);
  const Frustum frustum = make_frustum(view);
  const Projector projector = make_projector(view, around);
  bool right = false;
  const BoxView boxes = view_of_boxes(in, from, right);
  const bool room = !in.rarely();
  std::vector<ObjectId> visible(from.size() + kCullPadding - (room ? 0 : 1));
  const auto kept = cull_boxes(frustum, boxes, visible);
  require(done(kept) == (right && room));
  if (kept) {
    require(*kept <= from.size() && std::is_sorted(visible.begin(), visible.begin() + std::ptrdiff_t(*kept)));
    require(*kept == 0 || visible[*kept - 1] < from.size());
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Box box = from.boxes[i];
    require(overlaps(frustum, box) == (classify(frustum, box) != Overlap::outside));
    (void)covers_sample(projector, projected_rect(projector, box));
    const Sphere sphere = from.things[i].sphere;
    (void)overlaps(frustum, sphere), (void)projected_area(projector, sphere);
    (void)projected_area_bound(projector, sphere);
  }
  const SphereView spheres = view_of_spheres(in, from, right);
  const auto round = cull_spheres(frustum, spheres, visible);
  require(done(round) == (right && room) && (!round || *round <= from.size()));
}

// Flat culling of valid boxes keeps what testing one by one keeps, in any layout.
void flat_is_exact(Numbers& in, const View& view) {
  const Frustum frustum = make_frustum(view);
  Boxes boxes;
  for (std::size_t i = in.byte() % 80; i > 0; --i) boxes.push_back(box_of(in));
  std::vector<Box> structs;
  for (std::size_t i = 0; i < boxes.size(); ++i) structs.push_back(boxes[i]);
  std::vector<ObjectId> first(boxes.size() + kCullPadding), second(first.size());
  const auto of_arrays = cull_boxes(frustum, boxes.view(), first),
             of_structs = cull_boxes(frustum, structs, second);
  require(done(of_arrays) && done(of_structs) && *of_arrays == *of_structs);
  require(std::equal(first.begin(), first.begin() + std::ptrdiff_t(*of_arrays), second.begin()));
  const auto overlapping = [&](const Box& box) { return overlaps(frustum, box); };
  require(static_cast<std::ptrdiff_t>(*of_arrays) == std::ranges::count_if(structs, overlapping));
}

// What is made of a mesh that may be drawn may be drawn, too, and keeps within its means.
void make_occluder_of(Numbers& in, std::span<const Vec3> points, std::span<const std::uint32_t> indices,
                      std::span<const Sides> sides) {
  const OccluderOptions options{in.byte() % 32u, in.byte() % 4u};
  const auto made = make_occluder(points, indices, sides, options);
  require(static_cast<bool>(made) == (options.most_triangles > 0 || options.most_boxes > 0));
  if (!made) return;
  require(made->sides.size() <= options.most_triangles && made->boxes.size() <= options.most_boxes);
  require(made->indices.size() == 3 * made->sides.size() && made->solid_triangles <= made->sides.size());
  require(static_cast<bool>(OccluderMesh::make(made->positions, made->indices, made->sides)));
  for (const Box& box : made->boxes)
    require(box.min.x < box.max.x && box.min.y < box.max.y && box.min.z < box.max.z);
}

Status draw(Numbers& in, OcclusionBuffer& buffer) {
  std::vector<Vec3> points(in.byte() % 40);
  std::vector<std::uint32_t> indices(3 * (in.byte() % 30));
  for (Vec3& p : points) p = in.rarely() ? in.point() : box_of(in).min;
  const auto range = in.rarely() ? 44u : std::max(1u, static_cast<std::uint32_t>(points.size()));
  for (std::uint32_t& i : indices) i = in.byte() % range;
  std::vector<Sides> sides(in.byte() & 1 ? indices.size() / 3 : in.byte() % 3);
  for (Sides& s : sides) s = in.byte() & 1 ? Sides::front : Sides::both;
  const auto mesh = OccluderMesh::make(points, indices, sides);
  if (!done(mesh)) return mesh.error();
  if (in.byte() % 64 == 0) make_occluder_of(in, points, indices, sides);
  Mat4 transform;
  if (in.byte() & 1) transform.m[in.byte() % 16] = in.number();
  return buffer.draw_mesh(*mesh, transform);
}

// The boxes as they stand about an origin: a single box is asked for about the view's.
BoxView about(const Boxes& b, const WorldPoint& origin) {
  return BoxView::arrays(b.min_x.data(), b.min_y.data(), b.min_z.data(), b.max_x.data(), b.max_y.data(),
                         b.max_z.data(), b.size(), origin);
}

void ask(Numbers& in, const OcclusionBuffer& buffer, Scenery& from) {
  bool right = false;
  const BoxView boxes = view_of_boxes(in, from, right);
  const bool room = !in.rarely() || from.size() == 0;
  std::vector<std::uint8_t> seen(from.size() - (room ? 0 : 1), 9);
  if (done(buffer.may_see(boxes, seen))) require(std::ranges::all_of(seen, [](auto s) { return s <= 1; }));
  const bool answered = done(buffer.may_see(about(from.boxes, buffer.view().origin), seen));
  require(answered == room);
  for (std::size_t i = 0; answered && i < from.size(); ++i)
    require(buffer.may_see(from.boxes[i]) == (seen[i] == 1));
  const SphereView spheres = view_of_spheres(in, from, right);
  require(done(buffer.may_see(spheres, seen)) == (right && room));

  std::vector<Vec3> corners(3 * (in.byte() % 40));
  for (Vec3& c : corners) c = in.point();
  bool any = !buffer.begun();
  for (std::size_t i = 0; i < corners.size(); i += 3)
    any = buffer.may_see(std::span<const Vec3>(corners).subspan(i, 3)) || any;
  require(buffer.may_see(std::span<const Vec3>(corners)) == any);

  OccludeeTriangles triangles;
  const std::array<std::uint32_t, 2> counts{static_cast<std::uint32_t>(corners.size() / 3),
                                            in.rarely() ? 1u : 0u};
  if (done(triangles.assign(corners, counts))) require(buffer.may_see(triangles, 0) == any);
  (void)done(triangles.set(in.byte() % 3, corners));
  std::array<std::uint32_t, 8> objects;
  for (std::uint32_t& o : objects) o = in.byte() % 4;
  require(buffer.keep_seen(triangles, objects) <= objects.size());
  std::vector<float> pixels(std::size_t{buffer.view().view.width} * buffer.view().view.height -
                            (in.rarely() ? 1 : 0));
  (void)done(buffer.read_nearness(pixels));
}

void occlude(Numbers& in, const View& view, Scenery& from) {
  OcclusionBuffer buffer;
  bool right = false;
  const BoxView boxes = view_of_boxes(in, from, right);
  const SphereView spheres = view_of_spheres(in, from, right);
  WorldView at{view, {}};
  if (in.byte() & 1) at.origin = {in.take<double>(), in.number(), in.number()};
  const bool begun = !in.rarely() && done(buffer.begin(at));
  require(buffer.begun() == begun);
  const bool drawn = done(buffer.draw_boxes(boxes)), round = done(buffer.draw_spheres(spheres)),
             meshed = done(draw(in, buffer));
  require(begun || (!drawn && !round && !meshed));
  ask(in, buffer, from);
}

void rays(Numbers& in, const View& view, Scenery& from) {
  BoxBvh bvh;
  bool right = false;
  const BoxView boxes = view_of_boxes(in, from, right);
  WorldPoint origin;
  if (in.byte() & 1) origin = {in.take<double>(), in.number(), in.number()};
  require(!done(bvh.build(boxes, origin)) || bvh.size() == from.size());
  std::vector<Ray> rays(in.byte() % 40);
  for (Ray& ray : rays) ray = {in.point(), in.point(), in.byte() & 1 ? in.number() : 1e6f};
  const bool room = !in.rarely() || rays.empty();
  std::vector<ObjectId> met(rays.size() - (room ? 0 : 1));
  std::vector<float> distances(in.byte() & 1 ? met.size() : 0);
  const JobSystem jobs{nullptr, nullptr, in.byte() % 70u};
  if (done(bvh.cast(rays, met, distances, jobs))) {
    for (const ObjectId object : met) require(object < bvh.size() || object == kNoObject);
  }
  std::vector<ObjectId> visible(from.size());
  const auto count = bvh.visible_set({view, origin}, in.byte() % 20, in.byte() % 20, visible);
  require(!done(count) || *count <= bvh.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Numbers in(data, size);
  while (!in.empty()) {
    const std::uint8_t which = in.byte() % 4;
    const View view = fuzz::view_of(in);
    if (!done(check(view))) continue;
    Scenery from(in);
    switch (which) {
      case 0:
        flat(in, view, from);
        break;
      case 1:
        flat_is_exact(in, view);
        break;
      case 2:
        occlude(in, view, from);
        break;
      default:
        rays(in, view, from);
        break;
    }
  }
  return 0;
}
