#include "bake/cell_baker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <sightline/error.hpp>

#include "scene/random.hpp"

namespace sightline::bake {

namespace {

constexpr std::uint64_t kMostCells = std::uint64_t{1} << 22;
constexpr int kTries = 64;

}  // namespace

CellPvs make_cells(const Scene& scene, const CellOptions& options) {
  CellPvs cells;
  cells.bounds = extent(scene);
  cells.objects = static_cast<std::uint32_t>(scene.size());
  cells.scene = fingerprint(scene);
  const Box& b = cells.bounds;
  const double sides[] = {double{b.max.x} - b.min.x, double{b.max.y} - b.min.y, double{b.max.z} - b.min.z};
  double all = 1;
  for (int axis = 0; axis < 3; ++axis) all *= std::max(1.0, std::ceil(sides[axis] / options.cell));
  if (!(options.cell > 0) || !(all <= static_cast<double>(kMostCells))) {
    throw Error("bake: cells of " + std::to_string(options.cell) + " m make more than " +
                std::to_string(kMostCells) + " over '" + scene.name + "', expected a larger --cell");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.counts[axis] = static_cast<std::uint32_t>(std::max(1.0, std::ceil(sides[axis] / options.cell)));
  }
  const std::size_t count = static_cast<std::size_t>(all);
  cells.open.assign(count, 0);
  cells.first.assign(count + 1, 0);
  return cells;
}

bool open_point(const Scene& scene, const Box& cell, std::uint64_t& state, Vec3& point) {
  scene::Random random(state);
  bool found = false;
  for (int i = 0; i < kTries && !found; ++i) {
    point = random.inside(cell);
    found = !scene.level || scene.level->leaves[scene.level->leaf_at(point)].cluster >= 0;
  }
  state = random.next();
  return found;
}

CellBaker::CellBaker(const Scene& scene, const pvs::TriangleRays& rays, const CellOptions& options)
    : scene_(scene), rays_(rays), options_(options), seen_(scene.size()), known_(scene.size()) {
  // A spherical Fibonacci lattice (Swinbank & Purser 2006): evenly in all directions.
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::uint32_t i = 0; i < options.rays; ++i) {
    const double y = 1 - (2 * i + 1.0) / options.rays, r = std::sqrt(1 - y * y), a = golden * i;
    directions_.push_back(
        {static_cast<float>(r * std::cos(a)), static_cast<float>(y), static_cast<float>(r * std::sin(a))});
  }
  nearest_.resize(options.rays);
}

bool CellBaker::bake(const CellPvs& cells, std::uint32_t cell, std::vector<ObjectId>& visible) {
  visible.clear();
  std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
  std::fill(known_.begin(), known_.end(), std::uint8_t{0});
  std::uint64_t state = options_.seed * 0x9e3779b97f4a7c15u + cell;
  const Box box = cells.cell_bounds(cell);
  // New objects' rays of each viewpoint, and how many viewpoints make a judgement.
  std::vector<std::uint32_t> fresh;
  // At the target a window would hold 64 such rays; that it holds an eighth by chance all but never happens.
  const auto window = static_cast<std::size_t>(std::ceil(64 / (options_.target * options_.rays)));
  std::uint64_t in_window = 0;
  for (std::uint32_t v = 0; v < options_.most_viewpoints; ++v) {
    Vec3 eye;
    if (!open_point(scene_, box, state, eye)) {
      if (v == 0) return false;
      continue;
    }
    // The lattice turned at random, so that no two viewpoints look the same ways.
    scene::Random random(state);
    const Vec3 w = random.direction();
    const Vec3 up = std::fabs(w.y) > 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 u{up.y * w.z - up.z * w.y, up.z * w.x - up.x * w.z, up.x * w.y - up.y * w.x};
    const float length = std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    u = {u.x / length, u.y / length, u.z / length};
    const Vec3 t{w.y * u.z - w.z * u.y, w.z * u.x - w.x * u.z, w.x * u.y - w.y * u.x};
    state = random.next();
    batch_.clear();
    for (const Vec3& d : directions_) {
      batch_.push_back({eye,
                        {u.x * d.x + w.x * d.y + t.x * d.z, u.y * d.x + w.y * d.y + t.y * d.z,
                         u.z * d.x + w.z * d.y + t.z * d.z},
                        std::numeric_limits<float>::max()});
    }
    rays_.cast(batch_, nearest_, seen_, stack_, stats_);
    std::uint32_t news = 0;
    for (const ObjectId object : nearest_) news += object != kNoObject && !known_[object];
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      news += seen_[object] && !known_[object] && scene_.surface[object] == Surface::transparent;
    }
    known_ = seen_;
    fresh.push_back(news);
    in_window += news;
    if (fresh.size() > window) in_window -= fresh[fresh.size() - 1 - window];
    if (fresh.size() > window && static_cast<double>(in_window) <=
                                     0.5 * options_.target * static_cast<double>(window) * options_.rays) {
      break;
    }
  }
  for (ObjectId object = 0; object < scene_.size(); ++object) {
    if (seen_[object]) visible.push_back(object);
  }
  return true;
}

}  // namespace sightline::bake
