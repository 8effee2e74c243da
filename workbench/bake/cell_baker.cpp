#include "workbench/bake/cell_baker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <sightline/workbench/error.hpp>

#include "library/geometry/elementary.hpp"

namespace sightline::bake {

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

namespace {

// A spherical Fibonacci lattice (Swinbank & Purser 2006): evenly in all directions.
std::vector<Vec3> lattice(std::uint32_t count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - y * y), a = golden * i;
    directions.push_back({static_cast<float>(r * portable::cos(a)), static_cast<float>(y),
                          static_cast<float>(r * portable::sin(a))});
  }
  return directions;
}

bool is_open(const Scene& scene, const Vec3& point) {
  return !scene.level || scene.level->leaves[scene.level->leaf_at(point)].cluster >= 0;
}

// Points all over a box, evenly after any number of them (Roberts 2018, "The unreasonable effectiveness of
// quasirandom sequences"), those that are open.
class OpenPoints {
public:
  OpenPoints(const Scene& scene, const Box& box, scene::Random& random)
      : scene_(scene), box_(box), start_{random.unit(), random.unit(), random.unit()} {}

  // False when there were `tries` in vain.
  bool next(std::uint64_t tries, Vec3& point) {
    constexpr double kG = 1.2207440846057596;  // kG^4 = kG + 1
    for (std::uint64_t i = 0; i < tries; ++i) {
      ++at_;
      const auto along = [&](double start, double step, float low, float high) {
        const double x = start + static_cast<double>(at_) * step;
        return static_cast<float>(low + (x - std::floor(x)) * (double{high} - low));
      };
      point = {along(start_.x, 1 / kG, box_.min.x, box_.max.x),
               along(start_.y, 1 / (kG * kG), box_.min.y, box_.max.y),
               along(start_.z, 1 / (kG * kG * kG), box_.min.z, box_.max.z)};
      if (is_open(scene_, point)) return true;
    }
    return false;
  }

private:
  const Scene& scene_;
  Box box_;
  Vec3 start_;
  std::uint64_t at_ = 0;
};

constexpr std::uint64_t kTries = 256;  // a point in vain, before a cell counts as closed
constexpr std::size_t kBatch = 1024;   // rays at once

}  // namespace

CellBaker::CellBaker(const Scene& scene, const partition::TriangleRays& rays, const CellOptions& options)
    : scene_(scene),
      rays_(rays),
      options_(options),
      few_(lattice(options.rays)),
      many_(lattice(64)),
      seen_(scene.size()),
      known_(scene.size()) {
  for (ObjectId object = 0; object < scene.size(); ++object) {
    if (scene.surface[object] != Surface::opaque) see_through_.push_back(object);
  }
}

// The directions turned at random, so that no two viewpoints look the same ways.
void CellBaker::look(const Vec3& eye, std::span<const Vec3> directions, scene::Random& random) {
  // A uniform unit quaternion (Shoemake 1992).
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const float u = random.unit(), a = kTurn * random.unit(), b = kTurn * random.unit();
  const float s = std::sqrt(1 - u), t = std::sqrt(u);
  const float x = s * portable::sin(a), y = s * portable::cos(a), z = t * portable::sin(b),
              w = t * portable::cos(b);
  for (const Vec3& d : directions) {
    batch_.push_back(
        {eye,
         {(1 - 2 * (y * y + z * z)) * d.x + 2 * (x * y - z * w) * d.y + 2 * (x * z + y * w) * d.z,
          2 * (x * y + z * w) * d.x + (1 - 2 * (x * x + z * z)) * d.y + 2 * (y * z - x * w) * d.z,
          2 * (x * z - y * w) * d.x + 2 * (y * z + x * w) * d.y + (1 - 2 * (x * x + y * y)) * d.z},
         std::numeric_limits<float>::max()});
  }
}

// Casts what was gathered, notes where new objects were seen from, and returns how many rays met one.
std::uint64_t CellBaker::cast() {
  nearest_.resize(batch_.size());
  rays_.cast(batch_, nearest_, seen_, stack_, stats_);
  std::uint64_t news = 0;
  for (std::size_t r = 0; r < batch_.size(); ++r) {
    if (nearest_[r] == kNoObject || known_[nearest_[r]]) continue;
    ++news;
    if (leads_.empty() || leads_.back() != batch_[r].origin) leads_.push_back(batch_[r].origin);
  }
  for (const ObjectId object : see_through_) news += seen_[object] && !known_[object];
  known_ = seen_;
  batch_.clear();
  return news;
}

// Many rays from and around every viewpoint that found something new, and those that these find.
void CellBaker::follow(const Box& cell, scene::Random& random) {
  constexpr float kReach = 1.0f / 32;  // of the cell
  const Vec3 reach{kReach * (cell.max.x - cell.min.x), kReach * (cell.max.y - cell.min.y),
                   kReach * (cell.max.z - cell.min.z)};
  while (!leads_.empty()) {
    const Vec3 at = leads_.back();
    leads_.pop_back();
    const Box around{{std::max(cell.min.x, at.x - reach.x), std::max(cell.min.y, at.y - reach.y),
                      std::max(cell.min.z, at.z - reach.z)},
                     {std::min(cell.max.x, at.x + reach.x), std::min(cell.max.y, at.y + reach.y),
                      std::min(cell.max.z, at.z + reach.z)}};
    look(at, many_, random);
    while (batch_.size() < kBatch) {
      const Vec3 eye = random.inside(around);
      look(is_open(scene_, eye) ? eye : at, many_, random);
    }
    cast();
  }
}

void CellBaker::begin() {
  leads_.clear();
  std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
  std::fill(known_.begin(), known_.end(), std::uint8_t{0});
}

bool CellBaker::try_out(const CellPvs& cells, std::uint32_t cell) {
  begin();
  scene::Random random(cell);
  OpenPoints points(scene_, cells.cell_bounds(cell), random);
  Vec3 eye;
  if (!points.next(kTries, eye)) return false;
  while (batch_.size() < kBatch) look(eye, few_, random);
  cast();
  return true;
}

double CellBaker::least_rays() const noexcept {
  return std::min(3 / options_.target, static_cast<double>(options_.most_viewpoints)) * options_.rays;
}

bool CellBaker::bake(const CellPvs& cells, std::uint32_t cell, std::vector<ObjectId>& visible) {
  visible.clear();
  begin();
  const Box box = cells.cell_bounds(cell);
  scene::Random random(options_.seed * 0x9e3779b97f4a7c15u + cell);
  OpenPoints points(scene_, box, random);
  Vec3 eye;
  if (!points.next(kTries, eye)) return false;

  const std::size_t a_batch = std::max<std::size_t>(1, kBatch / options_.rays);
  const auto window =
      static_cast<std::size_t>(std::ceil(3 / (options_.target * static_cast<double>(a_batch))));
  const double few = 0.5 * options_.target * static_cast<double>(window * a_batch * options_.rays);
  std::vector<std::uint64_t> news;  // by batch
  std::uint64_t in_window = 0;
  bool more = true;
  for (std::uint32_t viewpoints = 0; more && viewpoints < options_.most_viewpoints;) {
    for (std::size_t i = 0; more && i < a_batch && viewpoints < options_.most_viewpoints; ++i, ++viewpoints) {
      look(eye, few_, random);
      more = points.next(kTries, eye);
    }
    news.push_back(cast());
    follow(box, random);
    in_window += news.back();
    if (news.size() > window) {
      in_window -= news[news.size() - 1 - window];
      more = more && static_cast<double>(in_window) > few;
    }
  }
  for (ObjectId object = 0; object < scene_.size(); ++object) {
    if (seen_[object]) visible.push_back(object);
  }
  return true;
}

}  // namespace sightline::bake
