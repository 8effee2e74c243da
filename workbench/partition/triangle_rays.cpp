#include "workbench/partition/triangle_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "library/geometry/linear.hpp"

#ifndef SIGHTLINE_PVS_TRIANGLE_ARRAYS
#define SIGHTLINE_PVS_TRIANGLE_ARRAYS
namespace sightline::partition {
struct TriangleArrays {
  const TriangleRays::MeshTree* meshes;
  const std::uint32_t* mesh;
  const Affine* to_mesh;
  const std::uint8_t* invertible;
  const Sides* sides;
  std::uint64_t *object_stack, *triangle_stack;
};
}  // namespace sightline::partition
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "workbench/partition/triangle_rays.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/rays/wide_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::partition::HWY_NAMESPACE {

HWY_INLINE float dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The nearest triangle of one mesh.
struct NearestTriangle {
  const TriangleRays::Triangle* triangles;
  Vec3 origin, direction;
  bool front_only;
  float distance;
  bool hit = false;

  // Möller & Trumbore 1997.
  void offer(float, std::uint32_t id) {
    const TriangleRays::Triangle& t = triangles[id];
    const Vec3 p = cross(direction, t.ac);
    const float determinant = dot(t.ab, p);
    if (determinant == 0 || (front_only && determinant < 0)) return;
    const float inverse = 1 / determinant;
    const Vec3 from{origin.x - t.a.x, origin.y - t.a.y, origin.z - t.a.z};
    const float u = dot(from, p) * inverse;
    if (!(u >= 0 && u <= 1)) return;
    const Vec3 q = cross(from, t.ab);
    const float v = dot(direction, q) * inverse;
    if (!(v >= 0 && u + v <= 1)) return;
    const float at = dot(t.ac, q) * inverse;
    if (at >= 0 && at <= distance) distance = at, hit = true;
  }
};

struct Caster {
  const TriangleArrays& arrays;

  // Distance to the nearest triangle of an object within `limit`; -1 for none.
  HWY_INLINE float meet(const Ray& ray, ObjectId object, float limit, rays::HWY_NAMESPACE::Work& work) const {
    const TriangleRays::MeshTree& tree = arrays.meshes[arrays.mesh[object]];
    if (tree.triangles.empty()) return -1;
    const auto& rows = arrays.to_mesh[object].rows;
    const auto turn = [&](const Vec3& v) -> Vec3 {
      return {rows[0].x * v.x + rows[0].y * v.y + rows[0].z * v.z,
              rows[1].x * v.x + rows[1].y * v.y + rows[1].z * v.z,
              rows[2].x * v.x + rows[2].y * v.y + rows[2].z * v.z};
    };
    const Vec3 at = turn(ray.origin);
    const Ray local{{at.x + rows[0].w, at.y + rows[1].w, at.z + rows[2].w}, turn(ray.direction), limit};
    NearestTriangle nearest{tree.triangles.data(), local.origin, local.direction,
                            arrays.sides[object] == Sides::front, limit};
    rays::HWY_NAMESPACE::walk(tree.bvh.nodes().data(), rays::WideNode::kInner, PreparedRay(local), nearest,
                              arrays.triangle_stack, work);
    return nearest.hit ? nearest.distance : -1;
  }
};

// Which of two coincident faces a renderer shows is up to its rounding: up to this far behind the nearest, in
// shares of the distance and of the origin's largest coordinate, an object counts as seen too.
constexpr float kCoincident = 8e-6f;
constexpr std::size_t kMostCoincident = 8;

struct NearestOpaque {
  const Caster& caster;
  const Ray& ray;
  const ObjectId* ids;
  rays::HWY_NAMESPACE::Work& work;
  float slack;     // of the distances, from the origin's size
  float distance;  // up to where an object matters
  float nearest = std::numeric_limits<float>::infinity();
  ObjectId object = kNoObject;
  std::size_t count = 0;
  struct Met {
    float distance;
    ObjectId object;
  };
  Met met[kMostCoincident];

  NearestOpaque(const Caster& with, const Ray& cast, const ObjectId* of, rays::HWY_NAMESPACE::Work& done)
      : caster(with),
        ray(cast),
        ids(of),
        work(done),
        slack(kCoincident *
              std::max({std::fabs(cast.origin.x), std::fabs(cast.origin.y), std::fabs(cast.origin.z)})),
        distance(cast.max_distance) {}

  void offer(float, std::uint32_t slot) {
    const ObjectId id = ids[slot];
    const float t = caster.meet(ray, id, distance, work);
    if (t < 0) return;
    if (t < nearest || (t == nearest && id < object)) {
      nearest = t, object = id;
      distance = std::min(distance, t + kCoincident * t + slack);
    }
    if (count == kMostCoincident) forget_farther();
    if (count < kMostCoincident) met[count++] = {t, id};
  }
  void forget_farther() {
    count = static_cast<std::size_t>(
        std::remove_if(met, met + count, [&](const Met& m) { return m.distance > distance; }) - met);
  }
  // The nearest and what coincides with it.
  void mark(std::uint8_t* seen) {
    forget_farther();
    for (std::size_t i = 0; i < count; ++i) seen[met[i].object] = 1;
    if (object != kNoObject) seen[object] = 1;
  }
};

struct SeenThrough {
  const Caster& caster;
  const Ray& ray;
  const ObjectId* ids;
  std::uint8_t* seen;
  rays::HWY_NAMESPACE::Work& work;
  float distance;

  void offer(float, std::uint32_t slot) {
    const ObjectId id = ids[slot];
    if (seen[id]) return;
    if (!caster.arrays.invertible[id] || caster.meet(ray, id, distance, work) >= 0) seen[id] = 1;
  }
};

void cast_triangles(const TriangleArrays* arrays, const TriangleRays::Kind* opaque,
                    const TriangleRays::Kind* see_through, const Ray* rays, std::size_t count,
                    ObjectId* nearest, std::uint8_t* seen, rays::RayStats* stats) {
  const Caster caster{*arrays};
  rays::HWY_NAMESPACE::Work work, triangles;
  for (std::size_t r = 0; r < count; ++r) {
    const PreparedRay ray(rays[r]);
    NearestOpaque found(caster, rays[r], opaque->ids.data(), triangles);
    if (!opaque->ids.empty()) {
      rays::HWY_NAMESPACE::walk(opaque->bvh.nodes().data(), rays::WideNode::kInner, ray, found,
                                arrays->object_stack, work);
    }
    nearest[r] = found.object;
    found.mark(seen);
    stats->hits += found.object != kNoObject;
    if (see_through->ids.empty()) continue;
    SeenThrough through{caster, rays[r], see_through->ids.data(), seen, triangles, found.distance};
    rays::HWY_NAMESPACE::walk(see_through->bvh.nodes().data(), rays::WideNode::kInner, ray, through,
                              arrays->object_stack, work);
  }
  stats->rays += count;
  stats->nodes += (work.inner + triangles.inner) * rays::kWide;
  stats->boxes += (work.leaves + triangles.leaves) * rays::kWide;
}

}  // namespace sightline::partition::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::partition {

HWY_EXPORT(cast_triangles);

namespace {

// A triangle's box, widened by what testing it in single precision may lose: a flat one must not be missed.
Box box_of(const TriangleRays::Triangle& t) {
  const Vec3 b{t.a.x + t.ab.x, t.a.y + t.ab.y, t.a.z + t.ab.z},
      c{t.a.x + t.ac.x, t.a.y + t.ac.y, t.a.z + t.ac.z};
  const auto low = [](float x, float y, float z) { return std::min({x, y, z}); };
  const auto high = [](float x, float y, float z) { return std::max({x, y, z}); };
  const Box box{{low(t.a.x, b.x, c.x), low(t.a.y, b.y, c.y), low(t.a.z, b.z, c.z)},
                {high(t.a.x, b.x, c.x), high(t.a.y, b.y, c.y), high(t.a.z, b.z, c.z)}};
  const Vec3 reach = geometry::largest(box);
  const float slack = 4 * std::numeric_limits<float>::epsilon() * std::max({reach.x, reach.y, reach.z});
  return {{box.min.x - slack, box.min.y - slack, box.min.z - slack},
          {box.max.x + slack, box.max.y + slack, box.max.z + slack}};
}

bool invert(const Affine& affine, Affine& inverse) {
  glm::dmat4 m(1);
  for (int r = 0; r < 3; ++r) {
    const Vec4& row = affine.rows[static_cast<std::size_t>(r)];
    m[0][r] = row.x, m[1][r] = row.y, m[2][r] = row.z, m[3][r] = row.w;
  }
  const double size = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
  if (!(std::fabs(glm::determinant(m)) > 1e-9 * size)) return false;
  const glm::dmat4 i = glm::inverse(m);
  for (int r = 0; r < 3; ++r) {
    inverse.rows[static_cast<std::size_t>(r)] = {static_cast<float>(i[0][r]), static_cast<float>(i[1][r]),
                                                 static_cast<float>(i[2][r]), static_cast<float>(i[3][r])};
  }
  return true;
}

}  // namespace

TriangleRays::TriangleRays(const Scene& scene)
    : scene_(scene), meshes_(scene.meshes.size()), to_mesh_(scene.size()), invertible_(scene.size()) {
  Boxes boxes;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    boxes.resize(mesh.index_count / 3);
    for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
      const auto corner = [&](std::uint32_t k) {
        return scene.positions[mesh.first_vertex + scene.indices[mesh.first_index + i + k]];
      };
      const Vec3 a = corner(0), b = corner(1), c = corner(2);
      meshes_[m].triangles.push_back(
          {a, {b.x - a.x, b.y - a.y, b.z - a.z}, {c.x - a.x, c.y - a.y, c.z - a.z}});
      boxes.set(i / 3, box_of(meshes_[m].triangles.back()));
    }
    meshes_[m].bvh.build(boxes);
    stack_size_ = std::max<std::size_t>(stack_size_, meshes_[m].bvh.stack_size());
  }
  refresh();
}

void TriangleRays::update() {
  refresh();
}

void TriangleRays::refresh() {
  opaque_.ids.clear(), see_through_.ids.clear();
  for (ObjectId object = 0; object < scene_.size(); ++object) {
    invertible_[object] = invert(scene_.transform[object], to_mesh_[object]);
    const bool hides = invertible_[object] && scene_.surface[object] == Surface::opaque;
    (hides ? opaque_ : see_through_).ids.push_back(object);
  }
  Boxes boxes;
  for (Kind* kind : {&opaque_, &see_through_}) {
    boxes.resize(kind->ids.size());
    for (std::size_t slot = 0; slot < kind->ids.size(); ++slot) {
      // Widened like a triangle's, as the transform into mesh space rounds too.
      Box box = scene_.bounds[kind->ids[slot]];
      const Vec3 reach = geometry::largest(box);
      const float slack = 4 * std::numeric_limits<float>::epsilon() * std::max({reach.x, reach.y, reach.z});
      for (float* low : {&box.min.x, &box.min.y, &box.min.z}) *low -= slack;
      for (float* high : {&box.max.x, &box.max.y, &box.max.z}) *high += slack;
      boxes.set(slot, box);
    }
    kind->bvh.build(boxes);
    stack_size_ = std::max<std::size_t>(stack_size_, kind->bvh.stack_size());
  }
}

void TriangleRays::cast(std::span<const Ray> rays, std::span<ObjectId> nearest, std::span<std::uint8_t> seen,
                        Stack& stack, rays::RayStats& stats) const {
  if (stack.objects.size() < stack_size_)
    stack.objects.resize(stack_size_), stack.triangles.resize(stack_size_);
  const TriangleArrays arrays{meshes_.data(),        scene_.mesh.data(),  to_mesh_.data(),
                              invertible_.data(),    scene_.sides.data(), stack.objects.data(),
                              stack.triangles.data()};
  HWY_DYNAMIC_DISPATCH(cast_triangles)
  (&arrays, &opaque_, &see_through_, rays.data(), rays.size(), nearest.data(), seen.data(), &stats);
}

}  // namespace sightline::partition
#endif
