#include "workbench/measure/caster_proof.hpp"

#include <vector>

#include <sightline/workbench/error.hpp>
#include <sightline/world.hpp>

#include "library/geometry/linear.hpp"
#include "workbench/methods/raster_occlusion/scene_occluders.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::measure {

namespace {

constexpr std::uint32_t kSky = 0xffe6d4c2;  // as pixels are: alpha, blue, green, red

Vec3 plus(const Vec3& a, float by, const Vec3& b) {
  return {a.x + by * b.x, a.y + by * b.y, a.z + by * b.z};
}

// A scene's objects in a World, and what hides them.
class CulledScene {
public:
  explicit CulledScene(const Scene& scene) : occluders_(scene), handles_(scene.size()) {
    or_throw(world_.insert(scene.bounds.view(), handles_));
    ids_.resize(cull_capacity(world_));
  }

  [[nodiscard]] const World& world() const noexcept { return world_; }

  std::span<ObjectId> cull(const CullView& view) {
    const CullResult result = or_throw(culler_.cull(world_, view, ids_));
    return std::span(ids_).first(result.count);
  }

  // What the camera sees, and the depth of what hides the rest; null where that cannot be drawn.
  std::pair<std::span<const ObjectId>, const OcclusionBuffer*> look(const WorldView& camera) {
    const std::span<const ObjectId> in_view = cull({.view = camera});
    if (!occluders_.usable() || !occluders_.draw(camera, in_view)) return {in_view, nullptr};
    const std::span<ObjectId> left = cull({.view = camera, .occlusion = &occluders_.buffer()});
    return {left.first(occluders_.keep_seen(left)), &occluders_.buffer()};
  }

private:
  methods::SceneOccluders occluders_;
  World world_;
  Culler culler_;
  std::vector<Handle> handles_;
  std::vector<ObjectId> ids_;
};

Light random_light(const CasterOptions& options, const Camera& camera, const Vec3& forward,
                   scene::Random& random) {
  Light light{.kind = options.light};
  if (options.light == LightKind::directional) {
    const Vec3 any = random.direction();
    light.direction = {any.x, -random.between(0.4f, 2), any.z};
    light.reach = options.distance;
    return light;
  }
  // A lamp or a torch near the eye, at something before it.
  const Vec3 way = random.direction();
  const Vec3 at = plus(camera.eye, random.between(0, 8), way);
  const Vec3 shone_at = plus(camera.eye, random.between(5, 40), forward);
  light.position = {at.x, at.y, at.z};
  light.direction = plus(shone_at, -1, at);
  light.cone = random.between(0.5f, 2), light.range = random.between(0.3f, 1) * options.distance;
  return light;
}

void compare(const device::Picture& all, const device::Picture& kept, const oracle::ShadowLookup& lookup,
             std::size_t camera, CasterEvidence& evidence) {
  const std::uint32_t side = 2 * lookup.reach + 1;
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < all.pixels.size(); ++i) {
    const std::uint32_t lit = all.pixels[i] >> 24;
    different += all.pixels[i] != kept.pixels[i];
    evidence.shaded_pixels += all.pixels[i] != 0 && lit < side * side;
  }
  evidence.pixels += all.pixels.size(), evidence.different_pixels += different;
  evidence.different_views += different > 0;
  if (different > 0 && !evidence.first_different) evidence.first_different = camera;
}

}  // namespace

CasterEvidence prove_casters(device::Renderer& renderer, std::span<const Camera> cameras,
                             const CasterOptions& options, const Progress& progress) {
  if (options.light == LightKind::point)
    throw Error("casters: a point light has six maps, expected directional or spot");
  CulledScene scene(renderer.scene());
  oracle::LitPictures pictures(renderer);
  ShadowCasters casters;
  scene::Random random(options.seed);
  CasterEvidence evidence;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Camera camera = cameras[i];
    camera.far_plane = std::min(camera.far_plane, camera.near_plane + options.distance);
    const View view = or_throw(make_view(camera, options.width, options.height));
    const Light light = random_light(options, camera, view_direction(view), random);
    const WorldView at{view, {}};
    const auto map = shadow_view(light, at, {}, options.map);
    if (!map || !casters.begin(*map, at, {}, options.lookup.filter())) continue;
    evidence.in_light += scene.cull({.view = *map}).size();
    evidence.towards_it += scene.cull({.view = *map, .casters = &casters}).size();
    const auto [visible, depth] = scene.look(at);
    or_throw(casters.receive(scene.world(), visible, depth));
    const std::span<const ObjectId> kept = scene.cull({.view = *map, .casters = &casters});
    evidence.kept += kept.size();
    evidence.picture = pictures.draw(view, *map, options.lookup);
    compare(evidence.picture, pictures.draw(view, *map, options.lookup, kept), options.lookup, i, evidence);
    ++evidence.views;
    if (progress) progress(i + 1, cameras.size());
  }
  // Where nothing is drawn is a sky: in black no edge would show.
  for (std::uint32_t& pixel : evidence.picture.pixels) pixel = pixel == 0 ? kSky : pixel | 0xff000000u;
  return evidence;
}

}  // namespace sightline::measure
