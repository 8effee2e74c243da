// What the ray methods of Ye et al. 2023 do on the CPU, for web/src/webgpu: toca, boca and wide-rays whole,
// the tree laid flat for saa, and the candidates of bvha. Part of the whole module.
#include <algorithm>
#include <utility>
#include <vector>

#include <sightline/boxes.hpp>

#include "library/geometry/linear.hpp"
#include "library/rays/bvh.hpp"
#include "library/rays/ray_grid.hpp"
#include "library/rays/wide_rays.hpp"
#include "web/wasm/glue.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"

namespace sightline::web {

namespace {

// As web/src/webgpu/shaders.ts reads it.
struct SentRay {
  Vec3 origin;
  float max_distance;
  Vec3 inverse;
  float pad = 0;
};
static_assert(sizeof(SentRay) == 32 && sizeof(Box) == 24 && sizeof(rays::BvhNode) == 32);

struct RaySet {
  std::vector<Box> boxes;  // as they are sent
  Boxes columns;
  rays::Bvh tree;
  rays::WideBvh wide;
  bool wide_stands = false;
  rays::RayGrid grid;
  std::vector<SentRay> sent;
  rays::RayHits hits;
  rays::WideStack stack;
  methods::Candidates candidates;
  std::vector<std::uint32_t> owners;  // of the candidates
};

enum class CpuMethod : std::uint32_t { toca, boca, wide_rays };

Status build(RaySet& set, const float* numbers, std::size_t count) {
  std::vector<Box> boxes(count);
  Boxes columns;
  columns.resize(count);
  for (std::size_t i = 0; i < count; ++i, numbers += 6) {
    boxes[i] = {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
    if (!geometry::is_valid(boxes[i]))
      return {StatusCode::bad_box, "rays: a box is not valid, expected finite min <= max", i};
    columns.set(i, boxes[i]);
  }
  set.boxes = std::move(boxes), set.columns = std::move(columns);
  set.tree.build(set.columns);
  set.wide_stands = false;
  return {};
}

// What the CPU does before the device does the rest.
void collect(RaySet& set) {
  methods::collect_candidates(set.tree, set.grid.prepared, set.candidates);
  const auto& first = set.candidates.first;
  set.owners.resize(set.candidates.objects.size());
  for (std::uint32_t r = 0; r + 1 < first.size(); ++r)
    std::fill(set.owners.begin() + first[r], set.owners.begin() + first[r + 1], r);
}

void cast(RaySet& set, CpuMethod method) {
  if (method == CpuMethod::toca) {
    methods::cast_at_all_boxes(set.columns, set.grid.prepared, set.hits);
  } else if (method == CpuMethod::boca) {
    methods::cast_down_bvh(set.tree, set.grid.prepared, set.hits);
  } else {
    if (!std::exchange(set.wide_stands, true)) set.wide.build(set.columns);
    rays::cast_wide(set.wide, set.grid, set.stack, set.hits);
  }
}

template <class T>
double address(const std::vector<T>& values) {
  return static_cast<double>(reinterpret_cast<std::uintptr_t>(values.data()));
}

}  // namespace

extern "C" {

SIGHTLINE_WEB(rays_create) RaySet* rays_create() {
  return new RaySet;
}
SIGHTLINE_WEB(rays_destroy) void rays_destroy(RaySet* set) {
  delete set;
}
/// Six numbers a box, minimum and maximum.
SIGHTLINE_WEB(rays_build) std::uint32_t rays_build(RaySet* set, const float* numbers, std::size_t count) {
  return keep(build(*set, numbers, count));
}
SIGHTLINE_WEB(rays_aim)
std::uint32_t rays_aim(RaySet* set, const WorldView* view, std::uint32_t columns, std::uint32_t rows) {
  constexpr std::uint64_t kMostRays = std::uint64_t{1} << 24;
  if (const Status sound = check(*view); !sound) return keep(sound);
  if (columns == 0 || rows == 0 || std::uint64_t{columns} * rows > kMostRays)
    return keep({StatusCode::bad_argument, "rays: expected 1 to 2^24 rays"});
  set->grid.make(view->view, columns, rows);
  set->sent.clear();
  for (const PreparedRay& ray : set->grid.prepared)
    set->sent.push_back({ray.origin, ray.max_distance, ray.inverse});
  return keep({});
}
SIGHTLINE_WEB(rays_cast) void rays_cast(RaySet* set, std::uint32_t method) {
  cast(*set, static_cast<CpuMethod>(method));
}
SIGHTLINE_WEB(rays_collect) void rays_collect(RaySet* set) {
  collect(*set);
}
/// Where arrays lie and how long they are, two numbers each, as web/src/webgpu/rays.ts names them.
SIGHTLINE_WEB(rays_arrays) void rays_arrays(const RaySet* set, double* out) {
  const auto nodes = set->tree.nodes();
  const double all[] = {
      address(set->boxes),
      static_cast<double>(set->boxes.size()),
      static_cast<double>(reinterpret_cast<std::uintptr_t>(nodes.data())),
      static_cast<double>(nodes.size()),
      address(set->sent),
      static_cast<double>(set->sent.size()),
      address(set->hits.object),
      static_cast<double>(set->hits.object.size()),
      address(set->hits.distance),
      static_cast<double>(set->hits.distance.size()),
      address(set->candidates.objects),
      static_cast<double>(set->candidates.objects.size()),
      address(set->candidates.first),
      static_cast<double>(set->candidates.first.size()),
      address(set->owners),
      static_cast<double>(set->owners.size()),
  };
  std::copy(std::begin(all), std::end(all), out);
}

}  // extern "C"

}  // namespace sightline::web
