// Occlusion on the CPU, after masked software occlusion culling (Hasselgren, Andersson & Akenine-Möller
// 2016): the frustum's objects first, of these the largest on the image as occluders into the depth tiles
// (round ones as spheres, which are cheap, so nearly all of them), then all against the tiles by box and
// sphere. Where a scene is one built thing of few triangles, like a game level, all of it occludes, and what
// its box leaves of an object is tested triangle by triangle.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <sightline/frustum.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/projection.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/world.hpp>

#include "workbench/methods/methods.hpp"
#include "workbench/methods/raster_occlusion/occluder_proxy.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kMaskedParameters{
    ParameterInfo{"occluders", "at most so many objects occlude as meshes, the largest on the image", "512",
                  0, 100000, true},
    ParameterInfo{"pixels", "px², the least area of such an occluder's bounding sphere", "150", 0, 1e9},
    ParameterInfo{"spheres", "px², the least area of an object that occludes by the sphere inside it", "5", 0,
                  1e9},
    ParameterInfo{"whole", "most triangles of a scene that occludes as one", "150000", 0, 1e9, true},
    ParameterInfo{"solid",
                  "what occludes: opaque surfaces from the sides that are drawn, or everything, cut-outs "
                  "and both sides, as many engines have it: loses what is seen through and past them",
                  "opaque", 0, 0, false, "opaque|all"},
};

class Masked final : public CpuMethod {
public:
  Masked(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene),
        most_occluders_(parameters.count("occluders")),
        least_area_(static_cast<float>(parameters.number("pixels"))),
        least_sphere_(static_cast<float>(parameters.number("spheres"))),
        all_solid_(parameters.word("solid") == "all"),
        draw_list_(scene),
        handles_(scene.size()),
        moved_(scene.size(), 0) {
    usable_ = static_cast<bool>(world_.insert(scene.bounds.view(), handles_));
    seen_.resize(scene.size());
    // Objects that share few meshes are instances, whose triangles would be too many in one.
    const bool one_thing = 2 * scene.meshes.size() >= scene.size();
    if (one_thing && triangle_count(scene) <= parameters.count("whole")) {
      usable_ = take_triangles() && usable_;
      build_whole();
    } else {
      find_occluders();
      extent_ = extent(scene);
    }
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return all_solid_ ? Guarantee::approximate : Guarantee::conservative;
  }

  void do_update(std::span<const ObjectId> objects) override {
    bool first_time = false;
    for (const ObjectId o : objects) {
      usable_ = usable_ && world_.move({&handles_[o], 1}, scene_.bounds.view().part(o, 1));
      first_time = first_time || !moved_[o];
      moved_[o] = 1;
    }
    if (!whole_) {
      extent_ = extent(scene_);
      return;
    }
    for (const ObjectId o : objects) {
      corners_.clear();
      append_corners(o);
      usable_ = occludees_.set(o, corners_) && usable_;
    }
    if (first_time) build_whole();
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    CullStats& stats = frame.stats;
    stats.objects = scene_.size();
    frame.visible.resize(cull_capacity(world_));
    const WorldView at{view, {}};
    CullResult result;
    // What is in view at all, from which occluders are picked.
    bool culled = !whole_ && cull_world({.view = at}, frame, result);
    const bool worth_it = whole_ || (culled && result.count > 1);
    // A world or view beyond what the tiles hold is culled by frustum alone, or not at all.
    if (usable_ && worth_it && buffer_.begin(at)) {
      draw_occluders(view, std::span(frame.visible).first(result.count));
      culled = cull_world({.view = at, .occlusion = &buffer_}, frame, result);
      const auto left = std::span(frame.visible).first(result.count);
      const std::size_t kept = whole_ ? buffer_.keep_seen(occludees_, left) : keep_seen_spheres(left);
      result.culled_occlusion += left.size() - kept;
      result.count = kept;
    } else if (whole_) {
      culled = cull_world({.view = at}, frame, result);
    }
    if (!usable_ || !culled) {
      frame.visible.resize(scene_.size());
      for (ObjectId o = 0; o < scene_.size(); ++o) frame.visible[o] = o;
    } else {
      frame.visible.resize(result.count);
      stats.culled_occlusion = result.culled_occlusion;
    }
    stats.tested = result.tested;
    stats.nodes_visited = result.nodes_visited;
    stats.culled_frustum = scene_.size() - frame.visible.size() - stats.culled_occlusion;
    draw_list_.build(scene_, view, frame);
  }

private:
  // A mesh, and what lies inside it and is drawn in its place.
  struct Occluder {
    std::optional<OccluderMesh> whole, proxy;
    std::optional<Sphere> sphere;
  };

  struct Picked {
    float area, distance;
    ObjectId object;
    bool cut;  // by the near plane
  };

  bool cull_world(const CullView& view, Frame& frame, CullResult& result) noexcept {
    const Result<CullResult> culled = culler_.cull(world_, view, frame.visible);
    result = culled ? *culled : CullResult{};
    return static_cast<bool>(culled);
  }

  [[nodiscard]] bool occludes(ObjectId o) const noexcept {
    return all_solid_ || scene_.surface[o] == Surface::opaque;
  }
  [[nodiscard]] Sides sides_of(ObjectId o) const noexcept {
    return all_solid_ ? Sides::both : scene_.sides[o];
  }

  // Three corners a triangle, in world space, counter-clockwise from its front.
  void append_corners(ObjectId o) {
    const Mesh& mesh = scene_.meshes[scene_.mesh[o]];
    const std::size_t first = corners_.size();
    for (const std::uint32_t i : std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count))
      corners_.push_back(transform_point(scene_.transform[o], scene_.positions[mesh.first_vertex + i]));
    if (!mirrors(scene_.transform[o])) return;
    for (std::size_t i = first; i < corners_.size(); i += 3) std::swap(corners_[i + 1], corners_[i + 2]);
  }

  bool take_triangles() {
    std::vector<std::uint32_t> counts;
    for (ObjectId o = 0; o < scene_.size(); ++o) {
      append_corners(o);
      counts.push_back(static_cast<std::uint32_t>(scene_.triangles(o)));
    }
    return static_cast<bool>(occludees_.assign(corners_, counts));
  }

  // All opaque objects that never moved, in world space, so that their seams are joined across objects.
  void build_whole() {
    corners_.clear();
    std::vector<Sides> sides;
    for (ObjectId o = 0; o < scene_.size(); ++o) {
      if (moved_[o] || !occludes(o)) continue;
      append_corners(o);
      sides.resize(corners_.size() / 3, sides_of(o));
    }
    std::vector<std::uint32_t> indices(corners_.size());
    std::iota(indices.begin(), indices.end(), 0u);
    whole_ = or_throw(OccluderMesh::make(corners_, indices, sides));
  }

  // What an object is drawn as: by its mesh, and the sides of it that are drawn.
  [[nodiscard]] std::size_t occluder_of(ObjectId o) const noexcept {
    return 2 * std::size_t{scene_.mesh[o]} + (sides_of(o) == Sides::front);
  }

  void find_occluders() {
    std::vector<std::uint8_t> asked(2 * scene_.meshes.size(), 0);
    for (ObjectId o = 0; o < scene_.size(); ++o) asked[occluder_of(o)] |= occludes(o);
    occluders_.resize(asked.size());
    for (std::size_t i = 0; i < occluders_.size(); ++i) {
      if (!asked[i]) continue;
      const Mesh& mesh = scene_.meshes[i / 2];
      const Sides sides = i % 2 == 0 ? Sides::both : Sides::front;
      const auto positions = std::span(scene_.positions).subspan(mesh.first_vertex, mesh.vertex_count);
      const auto indices = std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count);
      occluders_[i].whole = or_throw(OccluderMesh::make(positions, indices, sides));
      occluders_[i].sphere = inner_sphere(positions, indices, sides);
      if (!occluders_[i].sphere) occluders_[i].proxy = occluder_proxy(positions, indices, sides);
    }
  }

  void draw_occluders(const View& view, std::span<const ObjectId> candidates) {
    // What is refused is not drawn, and hides nothing.
    if (whole_) return static_cast<void>(buffer_.draw_mesh(*whole_));
    pick_occluders(view, candidates);
    draw_picked_spheres();
    draw_picked_meshes();
  }

  void pick_occluders(const View& view, std::span<const ObjectId> candidates) {
    const Projector projector = make_projector(view, extent_);
    // The frustum's planes are moved outwards by some 1e-6 of the distances from the eye and the origin; what
    // the true near plane cuts must not pass for whole.
    const Plane front = make_frustum(view).planes[Frustum::front];
    const float eye_reach =
        std::fabs(projector.eye.x) + std::fabs(projector.eye.y) + std::fabs(projector.eye.z);
    picked_.clear(), near_first_.clear(), drawn_spheres_.clear();
    for (const ObjectId o : candidates) {
      if (!occludes(o)) continue;
      const Sphere sphere = scene_.sphere(o);
      const float area = projected_area(projector, sphere);
      const Vec3 to{sphere.centre.x - projector.eye.x, sphere.centre.y - projector.eye.y,
                    sphere.centre.z - projector.eye.z};
      const float distance = to.x * to.x + to.y * to.y + to.z * to.z;
      const float moved = 1e-5f * (eye_reach + std::fabs(to.x) + std::fabs(to.y) + std::fabs(to.z));
      const bool cut = signed_distance(front, sphere.centre.x, sphere.centre.y, sphere.centre.z) <=
                       sphere.radius * (1 + 1e-4f) + moved;
      if (!cut && occluders_[occluder_of(o)].sphere) {
        if (area >= least_sphere_)
          near_first_.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | o);
      } else if (area >= least_area_) {
        picked_.push_back({area, distance, o, cut});
      }
    }
  }

  void draw_picked_spheres() {
    std::sort(near_first_.begin(), near_first_.end());
    for (const std::uint64_t key : near_first_) {
      const auto o = static_cast<ObjectId>(key);
      drawn_spheres_.push_back(sphere_inside(scene_.transform[o], *occluders_[occluder_of(o)].sphere));
    }
    static_cast<void>(buffer_.draw_spheres(std::span<const Sphere>(drawn_spheres_)));
  }

  void draw_picked_meshes() {
    if (picked_.size() > most_occluders_) {
      std::nth_element(picked_.begin(), picked_.begin() + most_occluders_, picked_.end(),
                       [](const Picked& a, const Picked& b) {
                         return a.area != b.area ? a.area > b.area : a.object < b.object;
                       });
      picked_.resize(most_occluders_);
    }
    std::sort(picked_.begin(), picked_.end(), [](const Picked& a, const Picked& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.object < b.object;
    });
    for (const Picked& picked : picked_) {
      const Occluder& occluder = occluders_[occluder_of(picked.object)];
      // What stands in for a mesh lies inside it, so of one that the near plane cuts it would still show a
      // front where the inside is seen: such a mesh is drawn as it is.
      const bool simply = occluder.proxy && !picked.cut;
      static_cast<void>(buffer_.draw_mesh(simply ? *occluder.proxy : *occluder.whole,
                                          to_matrix(scene_.transform[picked.object])));
    }
  }

  // Of what its box leaves, an object's sphere may drop some more. Keeps the rest in front, in order, and
  // returns how many.
  std::size_t keep_seen_spheres(std::span<ObjectId> visible) {
    constexpr std::size_t kBatch = 256;
    std::array<float, kBatch> x, y, z, radius;
    std::size_t kept = 0;
    for (std::size_t first = 0; first < visible.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, visible.size() - first);
      for (std::size_t i = 0; i < count; ++i) {
        const Sphere sphere = scene_.sphere(visible[first + i]);
        x[i] = sphere.centre.x, y[i] = sphere.centre.y, z[i] = sphere.centre.z, radius[i] = sphere.radius;
      }
      const auto spheres = SphereView::arrays(x.data(), y.data(), z.data(), radius.data(), count);
      const bool asked = static_cast<bool>(buffer_.may_see(spheres, seen_));
      for (std::size_t i = 0; i < count; ++i) {
        visible[kept] = visible[first + i];
        kept += !asked || seen_[i];
      }
    }
    return kept;
  }

  std::uint32_t most_occluders_;
  float least_area_, least_sphere_;
  bool all_solid_;
  submission::DrawList draw_list_;
  World world_;
  Culler culler_;
  OcclusionBuffer buffer_;
  std::vector<Handle> handles_;
  std::vector<std::uint8_t> moved_;
  std::optional<OccluderMesh> whole_;  // where the scene occludes as one
  OccludeeTriangles occludees_;        // of all objects, where it does
  std::vector<Vec3> corners_;          // of the objects at hand
  std::vector<Occluder> occluders_;    // two a mesh, by its sides, where it does not
  Box extent_;                         // of the scene, as it stands
  std::vector<Picked> picked_;
  std::vector<std::uint64_t> near_first_;  // squared distance and object
  std::vector<Sphere> drawn_spheres_;
  std::vector<std::uint8_t> seen_;
  bool usable_ = false;
};

}  // namespace

extern const MethodInfo kMasked{
    .name = "masked",
    .paper = "Hasselgren et al. 2016",
    .summary = "occluders into a hierarchical depth buffer on the CPU, then boxes against it",
    .cpu = on_cpu<Masked>(Guarantee::conservative, kMaskedParameters)};

}  // namespace sightline::methods
