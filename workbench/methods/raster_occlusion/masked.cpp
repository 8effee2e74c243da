// Occlusion on the CPU, after masked software occlusion culling (Hasselgren, Andersson & Akenine-Möller
// 2016): the frustum's objects first, of these the largest on the image as occluders into the depth tiles
// (round ones as balls, which are cheap, so nearly all of them), then all against the tiles by box and
// sphere. Where a scene is one built thing of few triangles, like a game level, all of it occludes, and what
// its box leaves of an object is tested triangle by triangle.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include <sightline/occlusion.hpp>
#include <sightline/projection.hpp>
#include <sightline/world.hpp>

#include "library/geometry/scale_bounds.hpp"
#include "library/occlusion/depth_tiles.hpp"
#include "workbench/methods/methods.hpp"
#include "workbench/methods/raster_occlusion/inner_shell.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kParameters{
    ParameterInfo{"occluders", "at most so many objects occlude as meshes, the largest on the image", "512",
                  0, 100000, true},
    ParameterInfo{"pixels", "px², the least area of such an occluder's bounding sphere", "150", 0, 1e9},
    ParameterInfo{"balls", "px², the least area of an object that occludes by the ball inside it", "5", 0,
                  1e9},
    ParameterInfo{"whole", "most triangles of a scene that occludes as one", "150000", 0, 1e9, true},
};

WorldBox wide(const Box& b) {
  return {{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}};
}

class Masked final : public Method {
public:
  Masked(const Scene& scene, const Parameters& parameters)
      : scene_(scene),
        most_occluders_(parameters.count("occluders")),
        least_area_(static_cast<float>(parameters.number("pixels"))),
        least_ball_(static_cast<float>(parameters.number("balls"))),
        draw_list_(scene),
        handles_(scene.size()),
        moved_(scene.size(), 0) {
    std::vector<WorldBox> boxes(scene.size());
    for (ObjectId o = 0; o < scene.size(); ++o) boxes[o] = wide(scene.bounds[o]);
    usable_ = !world_.insert(boxes, handles_);
    kept_.resize(scene.size());
    // Objects that share few meshes are instances, whose triangles would be too many in one.
    const bool one_thing = 2 * scene.meshes.size() >= scene.size();
    if (one_thing && triangle_count(scene) <= parameters.count("whole")) {
      find_blocks();
      build_whole();
    } else {
      find_balls();
    }
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::conservative; }

  void update(std::span<const ObjectId> objects) override {
    bool first_time = false;
    for (const ObjectId o : objects) {
      const WorldBox box = wide(scene_.bounds[o]);
      usable_ = usable_ && !world_.move({&handles_[o], 1}, {&box, 1});
      first_time = first_time || !moved_[o];
      moved_[o] = 1;
    }
    if (!whole_) return;
    for (const ObjectId o : objects) place_triangles(o);
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
    if (!whole_) result = culler_.cull(world_, {&at, 1}, {}, frame.visible);
    const bool worth_it = whole_ || (result.error == CullError::none && result.count > 1);
    // A world or view beyond what the tiles hold is culled by frustum alone, or not at all.
    if (usable_ && worth_it && !buffer_.begin(at)) {
      draw_occluders(view, std::span(frame.visible).first(result.count));
      const OcclusionBuffer* buffer = &buffer_;
      result = culler_.cull(world_, {&at, 1}, {.occlusion = {&buffer, 1}}, frame.visible);
      const auto left = std::span(frame.visible).first(result.count);
      whole_ ? drop_hidden_triangles(left, result) : drop_hidden_spheres(left, result);
    } else if (whole_) {
      result = culler_.cull(world_, {&at, 1}, {}, frame.visible);
    }
    if (!usable_ || result.error != CullError::none) {
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
  struct Occluder {
    float area, distance;
    ObjectId object;
    bool cut;  // by the near plane
  };

  // Three corners a triangle, in world space.
  std::span<const Vec3> corners_of(ObjectId o) {
    const Mesh& mesh = scene_.meshes[scene_.mesh[o]];
    corners_.clear();
    for (const std::uint32_t i : std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count))
      corners_.push_back(transform_point(scene_.transform[o], scene_.positions[mesh.first_vertex + i]));
    return corners_;
  }

  std::span<occlusion::TriangleBlock> blocks_of(ObjectId o) noexcept {
    return std::span(blocks_).subspan(first_block_[o], first_block_[o + 1] - first_block_[o]);
  }

  void place_triangles(ObjectId o) {
    const std::span<const Vec3> corners = corners_of(o);
    const std::span<occlusion::TriangleBlock> its = blocks_of(o);
    for (std::size_t b = 0; b < its.size(); ++b) its[b].take(corners, b * occlusion::TriangleBlock::kSize);
  }

  void find_blocks() {
    constexpr std::size_t kSize = occlusion::TriangleBlock::kSize;
    first_block_.assign(1, 0);
    for (ObjectId o = 0; o < scene_.size(); ++o)
      first_block_.push_back(first_block_.back() +
                             static_cast<std::uint32_t>((scene_.triangles(o) + kSize - 1) / kSize));
    blocks_.resize(first_block_.back());
    for (ObjectId o = 0; o < scene_.size(); ++o) place_triangles(o);
  }

  // All opaque objects that never moved, in world space, so that their seams are joined across objects.
  void build_whole() {
    std::vector<Vec3> positions;
    for (ObjectId o = 0; o < scene_.size(); ++o) {
      if (moved_[o] || scene_.surface[o] != Surface::opaque) continue;
      const std::span<const Vec3> corners = corners_of(o);
      positions.insert(positions.end(), corners.begin(), corners.end());
    }
    std::vector<std::uint32_t> indices(positions.size());
    std::iota(indices.begin(), indices.end(), 0u);
    whole_ = std::make_unique<OccluderMesh>(positions, indices);
  }

  // Of what its box leaves, an object's triangles may drop some more. Keeps the rest in front, in order.
  void drop_hidden_triangles(std::span<ObjectId> visible, CullResult& result) {
    constexpr std::size_t kAhead = 3;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < visible.size(); ++i) {
      if (i + kAhead < visible.size()) occlusion::prefetch(blocks_of(visible[i + kAhead]));
      const ObjectId o = visible[i];
      visible[kept] = o;
      kept += occlusion::query_triangles(buffer_.tiles(), blocks_of(o), scene_.triangles(o));
    }
    result.culled_occlusion += visible.size() - kept;
    result.count = kept;
  }

  void find_balls() {
    meshes_.resize(scene_.meshes.size());
    cut_meshes_.resize(scene_.meshes.size());
    balls_.resize(scene_.meshes.size());
    for (std::size_t m = 0; m < balls_.size(); ++m) {
      const Mesh& mesh = scene_.meshes[m];
      balls_[m] = inner_ball(std::span(scene_.positions).subspan(mesh.first_vertex, mesh.vertex_count),
                             std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count));
    }
  }

  // What stands in for a mesh lies inside it, so of one that the near plane cuts it would still show a front
  // where the inside is seen: such a mesh is drawn as it is.
  const OccluderMesh& mesh_of(const Occluder& occluder) {
    const std::uint32_t index = scene_.mesh[occluder.object];
    std::unique_ptr<OccluderMesh>& made = (occluder.cut ? cut_meshes_ : meshes_)[index];
    if (!made) {
      const Mesh& mesh = scene_.meshes[index];
      const auto positions = std::span(scene_.positions).subspan(mesh.first_vertex, mesh.vertex_count);
      const auto indices = std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count);
      made = std::make_unique<OccluderMesh>(occluder.cut ? OccluderMesh(positions, indices)
                                                         : simple_occluder(positions, indices));
    }
    return *made;
  }

  void draw_occluders(const View& view, std::span<const ObjectId> candidates) {
    if (whole_) return buffer_.draw_mesh(*whole_, {});
    const Projector projector = make_projector(view, extent(scene_));
    // The frustum's planes are pushed outwards with the scene's size; here as far inwards, for what the true
    // near plane cuts must not pass for whole.
    Plane front = make_frustum(view, {}).planes[Frustum::front];
    front.distance -= make_frustum(view, extent(scene_)).planes[Frustum::front].distance - front.distance;
    picked_.clear(), near_first_.clear(), drawn_balls_.clear();
    for (const ObjectId o : candidates) {
      if (scene_.surface[o] != Surface::opaque) continue;
      const Sphere sphere = scene_.sphere(o);
      const float area = projected_area(projector, sphere);
      const Vec3 to{sphere.centre.x - projector.eye.x, sphere.centre.y - projector.eye.y,
                    sphere.centre.z - projector.eye.z};
      const float distance = to.x * to.x + to.y * to.y + to.z * to.z;
      const bool cut = signed_distance(front, sphere.centre.x, sphere.centre.y, sphere.centre.z) <=
                       sphere.radius * (1 + 1e-4f);
      if (!cut && balls_[scene_.mesh[o]]) {
        if (area >= least_ball_)
          near_first_.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | o);
      } else if (area >= least_area_) {
        picked_.push_back({area, distance, o, cut});
      }
    }
    draw_picked_balls();
    draw_picked_meshes();
  }

  void draw_picked_balls() {
    std::sort(near_first_.begin(), near_first_.end());
    for (const std::uint64_t key : near_first_) {
      const auto o = static_cast<ObjectId>(key);
      const Sphere& ball = *balls_[scene_.mesh[o]];
      const Affine& to_world = scene_.transform[o];
      drawn_balls_.push_back(
          {transform_point(to_world, ball.centre), ball.radius * geometry::scale_bounds(to_world).least});
    }
    buffer_.draw_spheres(drawn_balls_);
  }

  void draw_picked_meshes() {
    if (picked_.size() > most_occluders_) {
      std::nth_element(picked_.begin(), picked_.begin() + most_occluders_, picked_.end(),
                       [](const Occluder& a, const Occluder& b) {
                         return a.area != b.area ? a.area > b.area : a.object < b.object;
                       });
      picked_.resize(most_occluders_);
    }
    std::sort(picked_.begin(), picked_.end(), [](const Occluder& a, const Occluder& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.object < b.object;
    });
    for (const Occluder& occluder : picked_) {
      buffer_.draw_mesh(mesh_of(occluder), scene_.transform[occluder.object]);
    }
  }

  // Of what its box leaves, an object's sphere may drop some more. Keeps the rest in front, in order.
  void drop_hidden_spheres(std::span<ObjectId> visible, CullResult& result) {
    constexpr std::size_t kSome = 256;
    std::array<float, kSome> x, y, z, radius;
    std::size_t kept = 0;
    for (std::size_t first = 0; first < visible.size(); first += kSome) {
      const std::size_t count = std::min(kSome, visible.size() - first);
      for (std::size_t i = 0; i < count; ++i) {
        const Sphere sphere = scene_.sphere(visible[first + i]);
        x[i] = sphere.centre.x, y[i] = sphere.centre.y, z[i] = sphere.centre.z, radius[i] = sphere.radius;
      }
      buffer_.may_see(SphereSpan{x.data(), y.data(), z.data(), radius.data(), count}, kept_);
      for (std::size_t i = 0; i < count; ++i) {
        visible[kept] = visible[first + i];
        kept += kept_[i];
      }
    }
    result.culled_occlusion += visible.size() - kept;
    result.count = kept;
  }

  const Scene& scene_;
  std::uint32_t most_occluders_;
  float least_area_, least_ball_;
  submission::DrawList draw_list_;
  World world_;
  Culler culler_;
  OcclusionBuffer buffer_;
  std::vector<Handle> handles_;
  std::vector<std::uint8_t> moved_;
  std::unique_ptr<OccluderMesh> whole_;
  std::vector<occlusion::TriangleBlock> blocks_;  // of all triangles, object by object; for `whole_`
  std::vector<std::uint32_t> first_block_;        // one an object, and the end
  std::vector<Vec3> corners_;
  std::vector<std::unique_ptr<OccluderMesh>> meshes_, cut_meshes_;
  std::vector<std::optional<Sphere>> balls_;  // one a mesh, in its own space
  std::vector<Occluder> picked_;
  std::vector<std::uint64_t> near_first_;  // squared distance and object
  std::vector<Sphere> drawn_balls_;
  std::vector<std::uint8_t> kept_;
  bool usable_ = false;
};

}  // namespace

const MethodInfo kMasked{"masked",
                         "Hasselgren et al. 2016",
                         "occluders into a hierarchical depth buffer on the CPU, then boxes against it",
                         Guarantee::conservative,
                         "",
                         kParameters,
                         fits_any_scene,
                         make<Masked>};

}  // namespace sightline::methods
