// What a program does that links the library alone: its objects in a World, each with the occluder that
// make_occluder finds in its mesh, and Culler::cull with occlusion left to it. A scene that is one built
// thing of few triangles, like a game level, carries one occluder, and each object its triangles.
#include <array>
#include <numeric>
#include <vector>

#include <sightline/workbench/error.hpp>
#include <sightline/world.hpp>

#include "workbench/methods/methods.hpp"
#include "workbench/methods/raster_occlusion/buffer_parameters.hpp"
#include "workbench/methods/raster_occlusion/occluder_proxy.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kWorldParameters{
    ParameterInfo{"occlusion",
                  "none: by frustum alone; automatic: what hides is picked and drawn as far as it pays",
                  "automatic", 0, 0, false, "none|automatic"},
    ParameterInfo{"object", "ns, what drawing an object costs; 0: learned from the frames' times", "10000", 0,
                  1e9},
    ParameterInfo{"whole", "most triangles of a scene that occludes as one", "150000", 0, 1e9, true},
    kCoverageParameter,
    kResolutionParameter,
};

class WorldMethod final : public CpuMethod {
public:
  WorldMethod(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene), draw_list_(scene), handles_(scene.size()), moved_(scene.size(), 0) {
    options_.occlusion = parameters.word("occlusion") == "automatic" ? Occlusion::automatic : Occlusion::none;
    options_.buffer = buffer_from(parameters);
    options_.costs.object = static_cast<float>(parameters.number("object"));
    usable_ = static_cast<bool>(world_.insert(scene.bounds.view(), handles_));
    if (!usable_ || options_.occlusion == Occlusion::none) return;
    // Objects that share few meshes are instances, whose triangles would be too many in one.
    whole_ = 2 * scene.meshes.size() >= scene.size() && triangle_count(scene) <= parameters.count("whole");
    if (whole_) {
      for (ObjectId o = 0; o < scene.size(); ++o) set_triangles(o);
      const Box everything = extent(scene);
      usable_ = world_.insert(BoxView(std::span(&everything, 1)), std::span(&whole_handle_, 1)) && usable_;
      build_whole();
    } else {
      find_occluders();
      for (ObjectId o = 0; o < scene.size(); ++o) place(o);
    }
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::conservative; }
  [[nodiscard]] Coverage coverage() const noexcept override {
    return options_.occlusion == Occlusion::none ? Coverage::area : options_.buffer.coverage;
  }

  void do_update(std::span<const ObjectId> objects) override {
    bool first_time = false;
    for (const ObjectId o : objects) {
      usable_ = world_.move({&handles_[o], 1}, scene_.bounds.view().part(o, 1)) && usable_;
      first_time = first_time || !moved_[o];
      moved_[o] = 1;
      if (options_.occlusion == Occlusion::none) continue;
      whole_ ? set_triangles(o) : place(o);
    }
    if (whole_ && first_time) build_whole();
  }

  void report_frame_time(double milliseconds) noexcept override {
    static_cast<void>(culler_.report_frame_time(1e6 * milliseconds));
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    CullStats& stats = frame.stats;
    stats.objects = scene_.size();
    frame.visible.resize(cull_capacity(world_, options_));
    const CullView at{.view = {view, {}}};
    const Result<CullResult> culled = usable_ ? culler_.cull(world_, {&at, 1}, options_, {frame.visible, {}})
                                              : Status{StatusCode::bad_view, ""};
    if (culled) {
      frame.visible.resize(culled->count);
      std::erase_if(frame.visible, [&](ObjectId o) { return o >= scene_.size(); });
      stats.culled_occlusion = culled->culled_occlusion;
      stats.tested = culled->tested, stats.nodes_visited = culled->nodes_visited;
    } else {
      // A world or view beyond what the library takes is not culled at all.
      frame.visible.resize(scene_.size());
      std::iota(frame.visible.begin(), frame.visible.end(), 0u);
    }
    stats.culled_frustum = scene_.size() - frame.visible.size() - stats.culled_occlusion;
    draw_list_.build(scene_, view, frame);
  }

private:
  // Three corners a triangle, in world space, counter-clockwise from its front.
  void append_corners(ObjectId o) {
    const Mesh& mesh = scene_.meshes[scene_.mesh[o]];
    const std::size_t first = corners_.size();
    for (const std::uint32_t i : std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count))
      corners_.push_back(transform_point(scene_.transform[o], scene_.positions[mesh.first_vertex + i]));
    if (!mirrors(scene_.transform[o])) return;
    for (std::size_t i = first; i < corners_.size(); i += 3) std::swap(corners_[i + 1], corners_[i + 2]);
  }

  void set_triangles(ObjectId o) {
    corners_.clear();
    append_corners(o);
    usable_ = world_.set_triangles(handles_[o], corners_, {}, scene_.sides[o]) && usable_;
  }

  // All opaque objects that never moved, in world space, so that their seams are joined across objects.
  void build_whole() {
    corners_.clear();
    Occluder occluder;
    for (ObjectId o = 0; o < scene_.size(); ++o) {
      if (moved_[o] || scene_.surface[o] != Surface::opaque) continue;
      append_corners(o);
      occluder.sides.resize(corners_.size() / 3, scene_.sides[o]);
    }
    occluder.positions = corners_;
    occluder.indices.resize(corners_.size());
    std::iota(occluder.indices.begin(), occluder.indices.end(), 0u);
    const OccluderId before = placement_.occluder;
    placement_.occluder = or_throw(world_.add_occluder(occluder));
    usable_ = world_.set_occluders({&whole_handle_, 1}, {&placement_, 1}) && usable_;
    if (before != kNoOccluder) usable_ = world_.remove_occluder(before) && usable_;
  }

  // What an object is drawn as: by its mesh, and the sides of it that are drawn.
  [[nodiscard]] std::size_t occluder_of(ObjectId o) const noexcept {
    return 2 * std::size_t{scene_.mesh[o]} + (scene_.sides[o] == Sides::front);
  }

  void find_occluders() {
    std::vector<std::uint8_t> asked(2 * scene_.meshes.size(), 0);
    for (ObjectId o = 0; o < scene_.size(); ++o)
      asked[occluder_of(o)] |= scene_.surface[o] == Surface::opaque;
    occluders_.resize(asked.size(), kNoOccluder);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (!asked[i]) continue;
      const Mesh& mesh = scene_.meshes[i / 2];
      const Sides sides = i % 2 == 0 ? Sides::both : Sides::front;
      const auto positions = std::span(scene_.positions).subspan(mesh.first_vertex, mesh.vertex_count);
      const auto indices = std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count);
      // A round mesh by the sphere inside it, which is cheap.
      if (const std::optional<Sphere> sphere = inner_sphere(positions, indices, sides)) {
        occluders_[i] = or_throw(world_.add_occluder({}, {&*sphere, 1}));
        continue;
      }
      const Occluder made = or_throw(make_occluder(positions, indices, {&sides, 1}));
      if (!made.indices.empty() || !made.boxes.empty()) occluders_[i] = or_throw(world_.add_occluder(made));
    }
  }

  void place(ObjectId o) {
    if (scene_.surface[o] != Surface::opaque) return;
    const OccluderPlacement placement{occluders_[occluder_of(o)], to_matrix(scene_.transform[o]), {}};
    usable_ = world_.set_occluders({&handles_[o], 1}, {&placement, 1}) && usable_;
  }

  submission::DrawList draw_list_;
  World world_;
  Culler culler_;
  CullOptions options_;
  std::vector<Handle> handles_;
  std::vector<std::uint8_t> moved_;
  std::vector<OccluderId> occluders_;  // two a mesh, by its sides
  bool whole_ = false;
  Handle whole_handle_;  // of what carries the occluder of all, behind the scene's objects
  OccluderPlacement placement_;
  std::vector<Vec3> corners_;  // of the objects at hand
  bool usable_ = false;
};

}  // namespace

extern const MethodInfo kWorld{
    .name = "world",
    .paper = "",
    .summary = "the library's World by itself: frustum, then occluders that it picks as far as they pay",
    .cpu = on_cpu<WorldMethod>(Guarantee::conservative, kWorldParameters)};

}  // namespace sightline::methods
