#include <sightline/culling.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "culling/frustum_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::ScalableTag<float>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;

// signed_distance() of a vector of points: mul and add apart, in its order, so that it rounds alike.
HWY_INLINE VF distance(const Plane& plane, VF x, VF y, VF z) {
  const F f;
  const VF xy = hn::Add(hn::Mul(hn::Set(f, plane.normal.x), x), hn::Mul(hn::Set(f, plane.normal.y), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(f, plane.normal.z), z)), hn::Set(f, plane.distance));
}

// Calls test(first) -> mask for each vector and packs the indices that pass; the rest that fills no vector
// goes through `test_one`.
template <class Test, class TestOne>
HWY_INLINE std::size_t pack(std::size_t count, ObjectId* HWY_RESTRICT out, const Test& test,
                            const TestOne& test_one) {
  const F f;
  const U u;
  const std::size_t lanes = hn::Lanes(f);
  std::size_t kept = 0, i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto mask = test(i);
    if (hn::AllFalse(f, mask)) continue;
    const auto ids = hn::Iota(u, static_cast<std::uint32_t>(i));
    const auto keep = hn::RebindMask(u, mask);
    // Packed in a register and stored whole: the packing store is microcoded on some processors.
    hn::StoreU(hn::Compress(ids, keep), u, out + kept);
    kept += hn::CountTrue(u, keep);
  }
  for (; i < count; ++i) {
    out[kept] = static_cast<ObjectId>(i);
    kept += test_one(i) ? 1 : 0;
  }
  return kept;
}

std::size_t cull_boxes(const Frustum& frustum, const BoxSpan& boxes, ObjectId* out) {
  const F f;
  struct Corner {
    const float *x, *y, *z;
  };
  std::array<Corner, Frustum::sides> nearest;
  for (std::size_t p = 0; p < Frustum::sides; ++p) {
    const Vec3& n = frustum.planes[p].normal;
    nearest[p] = {n.x >= 0 ? boxes.max_x : boxes.min_x, n.y >= 0 ? boxes.max_y : boxes.min_y,
                  n.z >= 0 ? boxes.max_z : boxes.min_z};
  }
  return pack(
      boxes.count, out,
      [&](std::size_t i) HWY_ATTR {
        // The smallest distance of all planes decides: one comparison instead of six.
        VF worst = hn::Set(f, 0.0f);
        for (std::size_t p = 0; p < Frustum::sides; ++p) {
          const Corner& c = nearest[p];
          worst = hn::Min(worst, distance(frustum.planes[p], hn::LoadU(f, c.x + i), hn::LoadU(f, c.y + i),
                                          hn::LoadU(f, c.z + i)));
        }
        return hn::Ge(worst, hn::Zero(f));
      },
      [&](std::size_t i) {
        return overlaps(frustum, Box{{boxes.min_x[i], boxes.min_y[i], boxes.min_z[i]},
                                     {boxes.max_x[i], boxes.max_y[i], boxes.max_z[i]}});
      });
}

std::size_t cull_spheres(const Frustum& frustum, const SphereSpan& s, ObjectId* out) {
  const F f;
  return pack(
      s.count, out,
      [&](std::size_t i) HWY_ATTR {
        const VF x = hn::LoadU(f, s.x + i), y = hn::LoadU(f, s.y + i), z = hn::LoadU(f, s.z + i);
        VF worst = distance(frustum.planes[0], x, y, z);
        for (std::size_t p = 1; p < Frustum::sides; ++p) {
          worst = hn::Min(worst, distance(frustum.planes[p], x, y, z));
        }
        return hn::Ge(worst, hn::Neg(hn::LoadU(f, s.radius + i)));
      },
      [&](std::size_t i) {
        return overlaps(frustum, Sphere{{s.x[i], s.y[i], s.z[i]}, s.radius[i]});
      });
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace culling {
HWY_EXPORT(cull_boxes);
HWY_EXPORT(cull_spheres);

static std::size_t flat_boxes(const Frustum& frustum, const BoxSpan& boxes, ObjectId* out) {
  return HWY_DYNAMIC_DISPATCH(cull_boxes)(frustum, boxes, out);
}

static std::size_t flat_spheres(const Frustum& frustum, const SphereSpan& spheres, ObjectId* out) {
  return HWY_DYNAMIC_DISPATCH(cull_spheres)(frustum, spheres, out);
}
}  // namespace culling

BoxSpan span_of(const Boxes& b) noexcept {
  return {b.min_x.data(), b.min_y.data(), b.min_z.data(), b.max_x.data(),
          b.max_y.data(), b.max_z.data(), b.size()};
}

std::size_t cull_boxes(const Frustum& frustum, const BoxSpan& boxes, std::span<ObjectId> visible) noexcept {
  return culling::flat_boxes(frustum, boxes, visible.data());
}

std::size_t cull_spheres(const Frustum& frustum, const SphereSpan& spheres,
                         std::span<ObjectId> visible) noexcept {
  return culling::flat_spheres(frustum, spheres, visible.data());
}

}  // namespace sightline
#endif
