#include "workbench/measure/level_evidence.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include <sightline/workbench/error.hpp>

#include "workbench/oracle/pixel_rays.hpp"
#include "workbench/scene/level_space.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::measure {
namespace {

constexpr double kBeforeFace = 1e-3;    ///< metres before a face where a line of sight is held to end
constexpr double kThroughSolid = 1e-3;  ///< metres of solid that are more than a brush past a corner

struct Direction {
  Vec3 forward, up;
};
constexpr std::array<Direction, 6> kDirections{{{{1, 0, 0}, {0, 1, 0}},
                                                {{-1, 0, 0}, {0, 1, 0}},
                                                {{0, 1, 0}, {0, 0, 1}},
                                                {{0, -1, 0}, {0, 0, 1}},
                                                {{0, 0, 1}, {0, 1, 0}},
                                                {{0, 0, -1}, {0, 1, 0}}}};

View look(const Vec3& eye, const Direction& direction, std::uint32_t side) {
  Camera camera;
  camera.eye = eye, camera.forward = direction.forward, camera.up = direction.up;
  camera.vertical_fov = std::numbers::pi_v<float> / 2;
  camera.near_plane = 0.01f;
  camera.far_plane = std::numeric_limits<float>::infinity();
  return or_throw(make_view(camera, side, side));
}

/// The line of sight to an object that runs through the least solid.
struct Sight {
  double solid = std::numeric_limits<double>::infinity();  ///< metres; infinite while none was confirmed
  Vec3 end;
  bool beyond = false;  ///< there was one longer than the level is drawn
};

/// All that is seen from one eye, and for what the level denies, the clearest line of sight.
class Panorama {
public:
  Panorama(const Scene& scene, const oracle::EmbreeJudge& judge, const Vec3& eye, std::uint32_t side)
      : scene_(scene), level_(*scene.level), eye_(eye), mask_(scene.size()), seen_(scene.size(), 0) {
    level_.potentially_visible(eye, mask_);
    for (const Direction& direction : kDirections) {
      const View view = look(eye, direction, side);
      const oracle::ItemBuffer truth = judge.render(view);
      for (ObjectId object = 0; object < scene.size(); ++object) {
        if (!truth.sees(object)) continue;
        seen_[object] = 1;
        if (mask_[object] == 0) follow(object, oracle::PixelRays(view), truth);
      }
    }
  }

  [[nodiscard]] std::uint64_t objects_seen() const {
    return static_cast<std::uint64_t>(std::count(seen_.begin(), seen_.end(), std::uint8_t{1}));
  }
  [[nodiscard]] const std::map<ObjectId, Sight>& denied() const noexcept { return denied_; }

private:
  const oracle::ObjectTriangles& triangles(ObjectId object) {
    return triangles_.try_emplace(object, scene_, object).first->second;
  }

  /// Where the pixel's ray meets the object, if nothing opaque lies before it.
  std::optional<double> distance(ObjectId object, ObjectId nearest, const oracle::PixelRay& ray) {
    const bool is_opaque = scene_.surface[object] == Surface::opaque;
    if (is_opaque && nearest != object) return {};
    const std::optional<double> t = triangles(object).meet(ray);
    if (!t || is_opaque || nearest == kNoObject) return t;
    const std::optional<double> opaque = triangles(nearest).meet(ray);
    return opaque && *opaque < *t ? std::nullopt : t;
  }

  void follow(ObjectId object, const oracle::PixelRays& rays, const oracle::ItemBuffer& truth) {
    Sight& clearest = denied_[object];
    for (std::uint32_t y = 0; y < truth.height; ++y) {
      for (std::uint32_t x = 0; x < truth.width; ++x) {
        const oracle::PixelRay ray = rays.through(x, y);
        const std::optional<double> t = distance(object, truth.ids[std::size_t{y} * truth.width + x], ray);
        if (!t) continue;
        const glm::dvec3 end = ray.origin + std::max(0.0, *t - kBeforeFace) * ray.direction;
        const Vec3 point{static_cast<float>(end.x), static_cast<float>(end.y), static_cast<float>(end.z)};
        if (glm::length(end - ray.origin) > level_.far_plane) {
          clearest.beyond = true;
          continue;
        }
        const double solid = scene::solid_length(level_, eye_, point);
        if (solid < clearest.solid) clearest = {solid, point};
      }
    }
  }

  const Scene& scene_;
  const LevelPvs& level_;
  Vec3 eye_;
  std::vector<std::uint8_t> mask_, seen_;
  std::map<ObjectId, oracle::ObjectTriangles> triangles_;
  std::map<ObjectId, Sight> denied_;
};

bool lists(const LevelPvs& level, const LevelPvs::Leaf& leaf, ObjectId object) {
  const auto first = level.leaf_objects.begin() + leaf.first_object;
  return std::find(first, first + leaf.object_count, object) != first + leaf.object_count;
}

PvsException reason_for(const LevelPvs& level, const Vec3& eye, ObjectId object, const Sight& sight) {
  if (sight.solid == std::numeric_limits<double>::infinity()) {
    return sight.beyond ? PvsException::beyond_far_plane : PvsException::unconfirmed;
  }
  if (sight.solid > kThroughSolid) return PvsException::through_solid;
  if (level.in_world_model[object] == 0) return PvsException::moving_part;
  const LevelPvs::Leaf& there = level.leaves[level.leaf_at(sight.end)];
  const bool may_see = level.may_see(level.leaves[level.leaf_at(eye)].cluster, there.cluster);
  if (there.cluster >= 0 && may_see && !lists(level, there, object)) return PvsException::unlisted;
  return PvsException::unexplained;
}

}  // namespace

std::string_view explanation(PvsException exception) noexcept {
  switch (exception) {
    case PvsException::through_solid:
      return "every line of sight to it runs through solid space whose faces are not drawn (caulk)";
    case PvsException::moving_part:
      return "a face of a moving part (door, lift), which leaves do not list by where it may be seen";
    case PvsException::beyond_far_plane:
      return "farther away than the level is drawn (_farplanedist)";
    case PvsException::unlisted:
      return "the leaf it is seen in may be seen, but the compiler did not list the face there";
    case PvsException::unconfirmed:
      return "seen by single precision alone, on a silhouette";
    case PvsException::unexplained:
      break;
  }
  return "a clear line of sight to a face that the level's visibility denies";
}

LevelEvidence gather_level_evidence(const Scene& scene, const oracle::EmbreeJudge& judge, std::size_t eyes,
                                    std::uint32_t side, std::uint64_t seed) {
  if (!scene.level) throw Error("scene '" + scene.name + "' has no level PVS, expected a .bsp level");
  const LevelPvs& level = *scene.level;
  const std::vector<std::uint32_t> leaves = scene::open_leaves(level);
  if (leaves.empty()) throw Error("scene '" + scene.name + "' has no open leaf to look from");
  scene::Random random(seed);
  LevelEvidence evidence;
  // A leaf is no box, so some places in its bounds lie outside it; a bound keeps hostile levels from a loop.
  for (std::size_t attempt = 0; evidence.eyes < eyes && attempt < 100 * eyes; ++attempt) {
    const std::uint32_t leaf = leaves[random.below(static_cast<std::uint32_t>(leaves.size()))];
    const Vec3 eye = random.inside(level.leaves[leaf].bounds);
    if (!scene::is_open(level, eye)) continue;
    ++evidence.eyes;
    const Panorama panorama(scene, judge, eye, side);
    evidence.objects_seen += panorama.objects_seen();
    evidence.objects_denied += panorama.denied().size();
    for (const auto& [object, sight] : panorama.denied()) {
      const PvsException reason = reason_for(level, eye, object, sight);
      ++evidence.objects[static_cast<std::size_t>(reason)];
      if (reason == PvsException::unexplained && evidence.unexplained.size() < 10) {
        evidence.unexplained.push_back({eye, sight.end, object});
      }
    }
  }
  return evidence;
}

}  // namespace sightline::measure
