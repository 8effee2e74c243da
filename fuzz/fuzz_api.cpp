// The C++ API beside World: views, frusta, projections, flat culling, occlusion buffers, methods by name. Any
// numbers may go in where a header does not say otherwise; nothing may crash, and answers must be ones.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <sightline/sightline.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "bytes.hpp"

namespace {

using namespace sightline;

void require(bool holds) {
  if (!holds) std::abort();
}

struct Bytes : fuzz::Bytes {
  using fuzz::Bytes::Bytes;
  // Mostly ordinary, now and then anything.
  float number() {
    const std::uint8_t kind = byte();
    return kind < 8 ? take<float>()
                    : static_cast<float>(take<std::int16_t>()) / static_cast<float>(1 << (kind % 16));
  }
  Vec3 point() { return {number(), number(), number()}; }
};

View view_of(Bytes& in) {
  Camera camera{.eye = in.point(), .forward = in.point(), .up = in.point()};
  camera.vertical_fov = in.number(), camera.orthographic_height = in.byte() & 1 ? in.number() : 0;
  camera.near_plane = in.number(), camera.far_plane = in.byte() & 1 ? in.number() : 1000;
  camera.shift_x = in.byte() & 1 ? in.number() : 0;
  camera.depth = in.byte() & 1 ? Depth::reversed : Depth::standard;
  const std::uint32_t width = 1 + in.byte(), height = 1 + in.byte();
  const Result<View> made = make_view(camera, width, height);
  View view = made ? *made : *make_view(Camera{}, width, height);
  const std::uint8_t harm = in.byte();
  if (harm < 16) view.eye_to_clip.m[harm] = in.take<float>();
  if (harm >= 16 && harm < 32) view.world_to_eye.m[harm - 16] = in.take<float>();
  return view;
}

// Valid boxes, as the flat functions ask for.
Box box_of(Bytes& in) {
  const Vec3 a = in.point(), b = in.point();
  const auto finite = [](float v) { return std::isfinite(v) ? std::clamp(v, -1e30f, 1e30f) : 0; };
  const auto low = [&](float p, float q) { return std::min(finite(p), finite(q)); };
  const auto high = [&](float p, float q) { return std::max(finite(p), finite(q)); };
  return {{low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)}, {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)}};
}

struct Spheres {
  std::vector<float> x, y, z, radius;
  [[nodiscard]] SphereSpan span() const { return {x.data(), y.data(), z.data(), radius.data(), x.size()}; }
};

void flat(Bytes& in, const View& view, const Boxes& boxes, const Spheres& spheres) {
  const Box around = box_of(in);
  const Frustum frustum = make_frustum(view, around);
  const Projector projector = make_projector(view, around);
  std::vector<ObjectId> visible(boxes.size() + spheres.x.size() + kCullPadding);
  const std::size_t kept = cull_boxes(frustum, span_of(boxes), visible);
  require(kept <= boxes.size());
  std::size_t one_by_one = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    one_by_one += overlaps(frustum, boxes[i]);
    (void)classify(frustum, boxes[i]);
    (void)covers_sample(projector, projected_rect(projector, boxes[i]));
  }
  require(kept == one_by_one);
  require(cull_spheres(frustum, spheres.span(), visible) <= spheres.x.size());
  for (std::size_t i = 0; i < spheres.x.size(); ++i) {
    const Sphere s{{spheres.x[i], spheres.y[i], spheres.z[i]}, spheres.radius[i]};
    (void)projected_area(projector, s), (void)projected_area_bound(projector, s);
  }
}

void occlude(Bytes& in, const View& view, const Boxes& boxes, const Spheres& spheres) {
  OcclusionBuffer buffer;
  WorldView at{view, {}};
  if (in.byte() & 1) at.origin = {in.take<double>(), in.number(), in.number()};
  if (buffer.begin(at)) return;
  std::vector<Box> occluders;
  std::vector<Sphere> solids;
  std::vector<Vec3> points(in.byte() % 40);
  std::vector<std::uint32_t> indices(3 * (in.byte() % 30));
  for (std::size_t i = in.byte() % 20; i > 0; --i) {
    occluders.push_back(in.byte() & 7 ? box_of(in) : Box{in.point(), in.point()});
    solids.push_back({in.point(), in.number()});
  }
  for (Vec3& p : points) p = box_of(in).min;
  for (std::uint32_t& i : indices) i = in.byte() % 44;
  buffer.draw_boxes(occluders);
  buffer.draw_spheres(solids);
  const OccluderMesh mesh(points, indices);
  Affine transform;
  if (in.byte() & 1) transform.rows[in.byte() % 3] = {in.number(), in.number(), in.number(), in.number()};
  buffer.draw_mesh(mesh, transform);
  std::vector<std::uint8_t> seen(std::max(boxes.size(), spheres.x.size()), 9);
  buffer.may_see(span_of(boxes), seen);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    require(seen[i] <= 1);
    require(buffer.may_see(boxes[i]) == (seen[i] == 1));
  }
  buffer.may_see(spheres.span(), seen);
  for (std::size_t i = 0; i < spheres.x.size(); ++i) require(seen[i] <= 1);
  buffer.may_see(span_of(boxes), {in.number(), in.number(), in.number()}, seen);
  std::vector<Vec3> corners(3 * (in.byte() % 40));
  for (Vec3& c : corners) c = in.point();
  bool any = false;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    any = buffer.may_see(std::span<const Vec3>(corners).subspan(i, 3)) || any;
  require(buffer.may_see(std::span<const Vec3>(corners)) == any);
  std::vector<float> pixels(std::size_t{buffer.width()} * buffer.height());
  buffer.read_nearness(pixels);
}

void methods(Bytes& in, const View& view) {
  static const Scene scene = [] {
    Scene made;
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, normals(4, {0, 1, 0});
    const std::uint32_t mesh =
        made.add_mesh(corners, normals, std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    for (int i = 0; i < 50; ++i) {
      Affine at;
      at.rows[0].w = static_cast<float>(i % 10) * 3 - 15, at.rows[2].w = static_cast<float>(i / 10) * -5;
      made.add_object(mesh, at);
    }
    return made;
  }();
  const auto known = all_methods();
  std::string specification(known[in.byte() % known.size()].name);
  if (in.byte() & 1) {
    specification += '?';
    for (std::size_t i = in.byte() % 24; i > 0; --i) specification += static_cast<char>(in.byte());
  }
  auto method = create_method(specification, scene);
  if (!method || check(view)) return;
  Frame frame;
  cull(**method, view, frame);
  require(frame.visible.size() <= scene.size());
  for (const ObjectId id : frame.visible) require(id < scene.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  while (!in.empty()) {
    const std::uint8_t which = in.byte() % 8;
    const View view = view_of(in);
    if (which == 0) {
      methods(in, view);
      continue;
    }
    if (check(view)) continue;
    Boxes boxes;
    for (std::size_t i = in.byte() % 40; i > 0; --i) boxes.push_back(box_of(in));
    Spheres spheres;
    for (std::size_t i = in.byte() % 40; i > 0; --i) {
      const Box box = box_of(in);
      spheres.x.push_back(box.min.x), spheres.y.push_back(box.min.y), spheres.z.push_back(box.min.z);
      spheres.radius.push_back(std::fabs(box.max.x));
    }
    which < 4 ? flat(in, view, boxes, spheres) : occlude(in, view, boxes, spheres);
  }
  return 0;
}
