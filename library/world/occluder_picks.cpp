#include "library/world/occluder_picks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sightline/frustum.hpp>
#include <sightline/projection.hpp>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"

namespace sightline::world {

namespace {

constexpr std::size_t kMostPicks = 1024;
constexpr float kTileArea = 64, kLeastArea = 16;  // px²
// A mesh of more triangles is drawn in parts, near ones first, for as much as there is to spend; it is picked
// for a few at the least, the cheaper objects are the more, and for no more than its share of what is left
// for drawing.
constexpr std::size_t kWhole = 512;
std::size_t least_part(const CullCosts& costs) noexcept {
  constexpr float kFewest = 64, kMost = 256;
  return static_cast<std::size_t>(std::clamp(kFewest * kObjectCost / costs.object, kFewest, kMost));
}
constexpr double kPartShare = 0.5;
// Where all of a pixel counts, what goes on beside a triangle is looked at, too, and much of it is drawn
// twice.
constexpr double kMarginCost = 3, kMarginTiles = 2;

bool in_parts(const OccluderShape& shape) noexcept {
  return shape.all.triangles() > kWhole;
}

// About the view's origin.
geometry::ExactAffine placement_about(const OccluderPlacement& placement, const WorldPoint& origin) {
  geometry::ExactAffine out = geometry::exact_affine(placement.transform);
  out.translation +=
      glm::dvec3(placement.origin.x - origin.x, placement.origin.y - origin.y, placement.origin.z - origin.z);
  return out;
}

// What a direction is at least scaled by, by Gershgorin's discs, rounded downwards.
double least_scale(const glm::dmat3& linear) {
  const glm::dmat3 products = glm::transpose(linear) * linear;
  double least = products[0][0];
  for (int a = 0; a < 3; ++a)
    least = std::min(
        least, products[a][a] - std::fabs(products[a][(a + 1) % 3]) - std::fabs(products[a][(a + 2) % 3]));
  return least > 0 ? std::sqrt(least) * (1 - 1e-6) : 0;
}

// A box around the part of the near plane that the image shows, and a little more for rounding.
Box near_rectangle(const View& view) {
  const glm::dmat4 to_eye = geometry::to_double(view.world_to_eye);
  const glm::dmat4 from_clip = glm::inverse(geometry::to_double(view.eye_to_clip) * to_eye);
  // Of depths 0 and 1 one is near; the other may be infinitely far.
  glm::dvec3 low(0), high(0);
  double nearest = std::numeric_limits<double>::infinity();
  for (const double depth : {0.0, 1.0}) {
    const glm::dvec4 middle = from_clip * glm::dvec4(0, 0, depth, 1);
    const double along = -(to_eye * (middle / middle.w)).z;
    if (!(along < nearest) || (!is_orthographic(view) && !(along > 0))) continue;
    nearest = along;
    for (const int corner : {0, 1, 2, 3}) {
      const glm::dvec4 p = from_clip * glm::dvec4(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, depth, 1);
      const glm::dvec3 at = glm::dvec3(p) / p.w;
      low = corner == 0 ? at : glm::min(low, at), high = corner == 0 ? at : glm::max(high, at);
    }
  }
  const glm::dvec3 size = high - low, far = glm::max(glm::abs(low), glm::abs(high));
  const double more = 1e-5 * (size.x + size.y + size.z + far.x + far.y + far.z);
  return {geometry::to_vec3(low - more), geometry::to_vec3(high + more)};
}

}  // namespace

// A view, and what is worked out once for all candidates.
struct OccluderPicks::Sight {
  Sight(const WorldState& in_world, const CullView& culled, const WorldPoint& measured_from,
        const OcclusionOptions& drawn, const CullCosts& at_costs)
      : world(in_world),
        view(culled),
        distance_eye(measured_from),
        costs(at_costs),
        margin(drawn.coverage == Coverage::area || drawn.scale > 1),
        triangle(double{at_costs.triangle} * (margin ? kMarginCost : 1)),
        tile(double{at_costs.tile} / (drawn.scale * drawn.scale)),
        projector(make_projector(culled.view.view, {})),
        frustum(make_frustum(culled.view.view)),
        image(projector.width * projector.height),
        near(near_rectangle(culled.view.view)) {}

  [[nodiscard]] Sphere sphere(const CarrierBrief& brief) const {
    const WorldPoint &c = brief.centre, &o = view.view.origin;
    return {{static_cast<float>(c.x - o.x), static_cast<float>(c.y - o.y), static_cast<float>(c.z - o.z)},
            brief.radius};
  }

  [[nodiscard]] bool sees_layers_of(ObjectId id) const {
    return ((world.columns.has_layers ? world.columns.layers[id] : kAllLayers) & view.layers) != 0;
  }

  // Whether some pixel may look from inside the box: what a pixel sees begins on the near plane, within the
  // image.
  [[nodiscard]] bool cuts(const Box& box) const {
    if (SIGHTLINE_MUTANT(near_occluders_drawn_whole)) return false;
    const Box& n = near;
    const bool apart = n.max.x < box.min.x || n.min.x > box.max.x || n.max.y < box.min.y ||
                       n.min.y > box.max.y || n.max.z < box.min.z || n.min.z > box.max.z;
    return !apart;
  }

  // The triangles of a shape to be drawn where it has that box. What lies inside an object would still show a
  // front to a pixel that looks from inside it.
  [[nodiscard]] const OccluderMesh& shown(const OccluderShape& shape, const Box& box) const {
    return cuts(box) ? shape.shown() : shape.all;
  }

  // What is drawn whole of a shape.
  [[nodiscard]] double shape_cost(const OccluderShape& shape, bool along_axes) const {
    const double box = along_axes ? double{costs.shape} : 12 * triangle;
    const double mesh = in_parts(shape) ? 0 : static_cast<double>(shape.all.triangles()) * triangle;
    return mesh + static_cast<double>(shape.boxes.size()) * box +
           static_cast<double>(shape.spheres.size()) * double{costs.shape};
  }

  // What may be spent on a mesh that is drawn in parts. Measured in levels: of a group of sixteen triangles
  // that is set up four are drawn, as one polygon and a half.
  [[nodiscard]] occlusion::MeshBudget parts_budget(double left) const {
    constexpr double kLook = 2, kSetUp = 1.5, kPolygon = 6;
    return {.look = kLook * double{costs.test},
            .query = double{costs.query},
            .triangle = kSetUp * triangle,
            .polygon = kPolygon * triangle,
            .tile = tile * (margin ? kMarginTiles : 1),
            .left = left};
  }

  // What it takes to set up `triangles` of it, in groups that each cover a little of the image.
  [[nodiscard]] double parts_cost(const OccluderShape& shape, std::size_t triangles) const {
    constexpr double kGroup = 16, kPolygons = 1.5, kTiles = 4;
    const occlusion::MeshBudget each = parts_budget(0);
    const double look = static_cast<double>(shape.all.triangles()) / kGroup * each.look,
                 group = kGroup * each.triangle + each.query + kPolygons * each.polygon + kTiles * each.tile;
    return look + static_cast<double>(triangles) / kGroup * group;
  }

  // Whether distances surely leave an object of this box.
  [[nodiscard]] bool in_range(ObjectId id, const WorldBox& box) const {
    if (!world.columns.has_distances || SIGHTLINE_MUTANT(far_occluders_drawn)) return true;
    const auto along = [](double low, double high, double eye) { return 0.5 * low + 0.5 * high - eye; };
    const double distance = glm::length(glm::dvec3(along(box.min.x, box.max.x, distance_eye.x),
                                                   along(box.min.y, box.max.y, distance_eye.y),
                                                   along(box.min.z, box.max.z, distance_eye.z)));
    const double error = 2e-3 + 2e-6 * distance, scale = double{view.distance_scale};
    const DistanceRange range = world.columns.distances[id];
    return (range.min == 0 || distance - error >= scale * double{range.min}) &&
           distance + error < scale * double{range.max};
  }

  // Whether `min_area` surely leaves an object of this box.
  [[nodiscard]] bool large(const Box& box) const {
    if (view.min_area == 0) return true;
    const Vec3 half{0.5f * (box.max.x - box.min.x), 0.5f * (box.max.y - box.min.y),
                    0.5f * (box.max.z - box.min.z)};
    const Sphere around{{box.min.x + half.x, box.min.y + half.y, box.min.z + half.z},
                        std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z)};
    return projected_area(projector, around) > 1.01f * view.min_area;
  }

  const WorldState& world;
  const CullView& view;
  const WorldPoint& distance_eye;
  const CullCosts& costs;
  bool margin;            // that of a pixel counts
  double triangle, tile;  // what a triangle and 8 × 8 pixels of the view cost to draw
  Projector projector;
  Frustum frustum;
  float image;  // px²
  Box near;     // around the part of the near plane that the image shows
};

double OccluderPicks::begin_cost(const CullView& view, const OcclusionOptions& options,
                                 const CullCosts& costs) noexcept {
  const std::uint32_t side = 8 * options.scale;
  const auto tiles = [&](std::uint32_t pixels) { return std::uint64_t{pixels + side - 1} / side; };
  const std::uint64_t all = tiles(view.view.view.width) * tiles(view.view.view.height);
  return static_cast<double>(all) * double{costs.tile};
}

OcclusionOptions OccluderPicks::affordable(const CullView& view, const OcclusionOptions& options,
                                           const CullCosts& costs, double left) noexcept {
  constexpr std::uint32_t kCoarsest = 4;
  constexpr double kShare = 1.0 / 4;
  OcclusionOptions out = options;
  while (out.scale < kCoarsest && begin_cost(view, out, costs) > kShare * left) out.scale *= 2;
  return out;
}

OccluderPicks::Drawn OccluderPicks::draw(const WorldState& world, const CullView& view,
                                         const WorldPoint& distance_eye, std::span<const ObjectId> in_view,
                                         const OcclusionOptions& wanted, const CullCosts& costs, double most,
                                         Purse& purse) {
  // Room for all, so that a camera that turns allocates nothing.
  const std::size_t carriers = world.occluders->carriers.size();
  picks_.reserve(carriers), seen_.reserve(carriers), drawn_.reserve(std::min(carriers, kMostPicks));
  picks_.clear(), drawn_.clear();
  const double had = purse.left();
  const auto left = [&] { return std::min(purse.left(), most - (had - purse.left())); };
  const OcclusionOptions options = affordable(view, wanted, costs, left());
  const double begin = begin_cost(view, options, costs);
  if (begin + static_cast<double>(seen_.size()) * double{costs.candidate} > left()) return Drawn::too_dear;
  const Sight sight(world, view, distance_eye, options, costs);
  find(sight, in_view, purse);
  if (picks_.empty()) return Drawn::nothing;
  const double budget = left() - begin;
  double spare = budget - choose(budget);
  if (picks_.empty()) return Drawn::too_dear;
  if (!buffer_.begin(view.view, options)) return Drawn::nothing;
  std::sort(picks_.begin(), picks_.end(), [](const Pick& a, const Pick& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.carrier < b.carrier;
  });
  options_ = options, coarse_ = options.scale > wanted.scale;
  for (Pick& pick : picks_) spare = draw_one(sight, pick, spare);
  purse.pay(begin + budget - spare);
  return Drawn::some;
}

bool OccluderPicks::worth_more() const noexcept {
  return !coarse_ && std::ranges::any_of(picks_, &Pick::cut);
}

void OccluderPicks::draw_on(const WorldState& world, const CullView& view, const WorldPoint& distance_eye,
                            const CullCosts& costs, double most, Purse& purse) {
  const Sight sight(world, view, distance_eye, options_, costs);
  double left = most;
  for (Pick& pick : picks_)
    if (pick.cut) left = draw_parts(sight, pick, left);
  purse.pay(most - left);
}

// Those that were seen the last time; all that are in view where most of these are no longer. What comes into
// view is seen, and so one of them the next time.
void OccluderPicks::find(const Sight& sight, std::span<const ObjectId> in_view, Purse& purse) {
  const WorldOccluders& o = *sight.world.occluders;
  const double candidate = double{sight.costs.candidate};
  std::size_t still = 0;
  for (const std::uint32_t carrier : seen_) still += carrier < o.briefs.size() && look_at(sight, carrier);
  purse.pay(static_cast<double>(seen_.size()) * candidate);
  const double all = static_cast<double>(in_view.size()) * candidate;
  if ((!seen_.empty() && 2 * still >= seen_.size()) || !purse.affords(all)) return;
  purse.pay(all);
  picks_.clear();
  for (const ObjectId id : in_view)
    if (const std::uint32_t carrier = o.carrier(id); carrier != kNothing) look_at(sight, carrier);
}

// Returns whether the view sees it at all.
bool OccluderPicks::look_at(const Sight& sight, std::uint32_t carrier) {
  const CarrierBrief& brief = sight.world.occluders->briefs[carrier];
  if (brief.occluder == kNoOccluder) return false;
  const Sphere sphere = sight.sphere(brief);
  if (!overlaps(sight.frustum, sphere)) return false;
  const float area = std::min(projected_area(sight.projector, sphere), sight.image);
  if (!(area >= kLeastArea) || !sight.sees_layers_of(brief.object)) return true;
  const Vec3& e = sight.projector.eye;
  const Vec3 to{sphere.centre.x - e.x, sphere.centre.y - e.y, sphere.centre.z - e.z};
  const OccluderShape& shape = sight.world.occluders->shapes[brief.occluder];
  // What is drawn in parts pays for its tiles by itself.
  const bool parts = in_parts(shape), solids = !shape.boxes.empty() || !shape.spheres.empty();
  const double tiles = parts && !solids ? 0 : sight.tile * double{area / kTileArea},
               whole = sight.shape_cost(shape, brief.along_axes) + tiles;
  const double claim = whole + (parts ? sight.parts_cost(shape, least_part(sight.costs)) : 0),
               most = whole + (parts ? sight.parts_cost(shape, shape.all.triangles()) : 0);
  picks_.push_back({area / static_cast<float>(claim), to.x * to.x + to.y * to.y + to.z * to.z, carrier, parts,
                    false, whole, claim, most});
  return true;
}

// Keeps those that cover most for what they cost, and returns what they cost together.
double OccluderPicks::choose(double budget) {
  const auto better = [](const Pick& a, const Pick& b) {
    return a.score != b.score ? a.score > b.score : a.carrier < b.carrier;
  };
  const std::size_t most = std::min(picks_.size(), kMostPicks);
  std::partial_sort(picks_.begin(), picks_.begin() + static_cast<std::ptrdiff_t>(most), picks_.end(), better);
  picks_.resize(most);
  double cost = 0;
  std::size_t kept = 0;
  for (Pick pick : picks_) {
    if (cost + pick.claim > budget) continue;  // a dear one leaves the cheaper ones their chance
    pick.claim = std::max(pick.claim, std::min(pick.most, kPartShare * (budget - cost)));
    cost += pick.claim;
    picks_[kept++] = pick;
  }
  picks_.resize(kept);
  return cost;
}

double OccluderPicks::draw_one(const Sight& sight, Pick& pick, double spare) {
  const Carrier& carrier = sight.world.occluders->carriers[pick.carrier];
  const WorldBox stored = stored_box(sight.world, carrier.object);
  const Box box = geometry::relative_box(stored, sight.view.view.origin);
  const bool here = stands(carrier.bounds, carrier.placement.origin, carrier.object_box, stored) ||
                    SIGHTLINE_MUTANT(moved_occluders_drawn);
  if (!here || !sight.large(box) || !sight.in_range(carrier.object, stored)) return spare;
  drawn_.push_back(carrier.object);
  const OccluderShape& shape = sight.world.occluders->shapes[carrier.placement.occluder];
  const geometry::ExactAffine placement = placement_about(carrier.placement, sight.view.view.origin);
  if (pick.parts)
    spare = draw_parts(sight, pick, pick.claim - pick.whole + spare);
  else
    draw_mesh(sight.shown(shape, box), placement);
  if (sight.cuts(box)) return spare;
  if (!shape.boxes.empty()) draw_boxes(shape, carrier.placement);
  if (shape.turned.triangles() > 0 && boxes_.empty()) draw_mesh(shape.turned, placement);
  draw_spheres(shape, placement);
  return spare;
}

void OccluderPicks::draw_mesh(const OccluderMesh& mesh, const geometry::ExactAffine& placement) {
  if (mesh.triangles() > 0)
    occlusion::draw_mesh(OcclusionAccess::tiles(buffer_), OcclusionAccess::topology(mesh), placement);
}

// A large mesh for what there is, of which it leaves some.
double OccluderPicks::draw_parts(const Sight& sight, Pick& pick, double left) {
  const Carrier& carrier = sight.world.occluders->carriers[pick.carrier];
  const Box box = geometry::relative_box(stored_box(sight.world, carrier.object), sight.view.view.origin);
  const OccluderMesh& mesh = sight.shown(sight.world.occluders->shapes[carrier.placement.occluder], box);
  if (mesh.triangles() == 0) return left;
  occlusion::MeshBudget budget = sight.parts_budget(left);
  occlusion::draw_mesh(OcclusionAccess::tiles(buffer_), OcclusionAccess::topology(mesh),
                       placement_about(carrier.placement, sight.view.view.origin), &budget);
  pick.cut = budget.refused;
  return budget.left;
}

// Leaves boxes_ empty where the placement turns boxes.
void OccluderPicks::draw_boxes(const OccluderShape& shape, const OccluderPlacement& placement) {
  boxes_.clear();
  const auto& m = placement.transform.m;
  if (m[1] != 0 || m[2] != 0 || m[4] != 0 || m[6] != 0 || m[8] != 0 || m[9] != 0) return;
  const WorldPoint& o = placement.origin;
  for (const Box& box : shape.boxes) {
    const auto range = [&](std::size_t a, float low, float high, double at) {
      const double scale = double{m[5 * a]}, moved = double{m[12 + a]} + at;
      return std::minmax({scale * double{low} + moved, scale * double{high} + moved});
    };
    const auto x = range(0, box.min.x, box.max.x, o.x), y = range(1, box.min.y, box.max.y, o.y),
               z = range(2, box.min.z, box.max.z, o.z);
    boxes_.push_back({{x.first, y.first, z.first}, {x.second, y.second, z.second}});
  }
  static_cast<void>(buffer_.draw_boxes(std::span<const WorldBox>(boxes_)));
}

void OccluderPicks::draw_spheres(const OccluderShape& shape, const geometry::ExactAffine& placement) {
  if (shape.spheres.empty()) return;
  spheres_.clear();
  const double scale = least_scale(placement.linear);
  for (const Sphere& s : shape.spheres) {
    const Vec3 c =
        geometry::to_vec3(placement.linear * geometry::to_double(s.centre) + placement.translation);
    // Less what the centre may have been moved by in rounding.
    const double moved = 1e-6 * (std::fabs(double{c.x}) + std::fabs(double{c.y}) + std::fabs(double{c.z}));
    const double radius = double{s.radius} * scale - moved;
    if (radius > 0) spheres_.push_back({c, static_cast<float>(radius)});
  }
  static_cast<void>(buffer_.draw_spheres(std::span<const Sphere>(spheres_)));
}

}  // namespace sightline::world
