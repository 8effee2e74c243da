#include "workbench/bake/bake_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <sightline/workbench/error.hpp>

#include "workbench/oracle/loss.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::bake {
namespace {

// A place in the cell where somebody can be.
bool place_in(const Scene& scene, const Box& cell, scene::Random& random, Vec3& place) {
  for (int i = 0; i < 64; ++i) {
    place = random.inside(cell);
    if (!scene.level || scene.level->leaves[scene.level->leaf_at(place)].cluster >= 0) return true;
  }
  return false;
}

}  // namespace

BakeLoss check_bake(const Scene& scene, const CellPvs& cells, const oracle::EmbreeJudge& judge,
                    std::size_t views, std::uint32_t width, std::uint32_t height, std::uint64_t seed,
                    const Progress& progress) {
  std::vector<std::uint32_t> open;
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (cells.open[cell]) open.push_back(cell);
  }
  if (open.empty()) throw Error("bake: no cell of '" + scene.name + "' is open");
  scene::Random random(seed);
  BakeLoss loss;
  while (loss.views < views) {
    const std::uint32_t cell = open[random.below(static_cast<std::uint32_t>(open.size()))];
    Camera camera;
    const Vec3 way = random.direction();
    camera.forward = {way.x, 0.5f * way.y, way.z};
    camera.vertical_fov = random.between(0.8f, 1.6f);
    camera.near_plane = 1e-4f;
    camera.far_plane = 1e5f;
    if (!place_in(scene, cells.cell_bounds(cell), random, camera.eye)) continue;
    const Result<View> view = make_view(camera, width, height);
    // The border between cells belongs to one of them only.
    if (!view || cells.cell_at(camera.eye) != cell) continue;
    const oracle::ItemBuffer truth = judge.render(*view);
    const auto set = cells.seen_from(cell);
    const oracle::Loss lost = oracle::compare_to_truth(truth, set);
    loss.lost_pixels += lost.lost_pixels;
    loss.lost_objects += lost.lost.size();
    loss.kept += set.size();
    loss.visible += truth.visible_count();
    loss.pixels += std::uint64_t{width} * height;
    ++loss.views;
    if (progress) progress(loss.views, views);
  }
  return loss;
}

namespace {

// The clusters that have some of their space in the box, or all that border on it.
std::vector<std::int32_t> clusters_in(const LevelPvs& level, const Box& box) {
  std::vector<std::int32_t> clusters, waiting{level.nodes.empty() ? -1 : 0};
  const Vec3 c{(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2},
      h{box.max.x - c.x, box.max.y - c.y, box.max.z - c.z};
  while (!waiting.empty()) {
    const std::int32_t child = waiting.back();
    waiting.pop_back();
    if (child < 0) {
      const std::int32_t cluster = level.leaves[static_cast<std::size_t>(-(child + 1))].cluster;
      if (cluster >= 0) clusters.push_back(cluster);
      continue;
    }
    const LevelPvs::Node& node = level.nodes[static_cast<std::size_t>(child)];
    const Vec3& n = node.plane.normal;
    const float at = n.x * c.x + n.y * c.y + n.z * c.z + node.plane.distance;
    const float reach = std::fabs(n.x) * h.x + std::fabs(n.y) * h.y + std::fabs(n.z) * h.z;
    if (at + reach >= 0) waiting.push_back(node.front);
    if (at - reach <= 0) waiting.push_back(node.back);
  }
  std::ranges::sort(clusters);
  clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
  return clusters;
}

/// Metres between two boxes, as the crow flies.
float between(const Box& a, const Box& b) {
  const auto gap = [](float a_min, float a_max, float b_min, float b_max) {
    return std::max({0.0f, b_min - a_max, a_min - b_max});
  };
  return std::hypot(gap(a.min.x, a.max.x, b.min.x, b.max.x), gap(a.min.y, a.max.y, b.min.y, b.max.y),
                    gap(a.min.z, a.max.z, b.min.z, b.max.z));
}

}  // namespace

std::vector<CellComparison> compare_with_level(const Scene& scene, const CellPvs& cells) {
  const LevelPvs& level = *scene.level;
  std::vector<CellComparison> rows;
  std::vector<std::uint8_t> all(scene.size()), baked(scene.size());
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (!cells.open[cell]) continue;
    const std::vector<std::int32_t> clusters = clusters_in(level, cells.cell_bounds(cell));
    for (std::size_t o = 0; o < all.size(); ++o) all[o] = level.in_some_leaf[o] == 0;
    for (const LevelPvs::Leaf& leaf : level.leaves) {
      const bool seen = leaf.cluster >= 0 && std::ranges::any_of(clusters, [&](std::int32_t from) {
                          return level.may_see(from, leaf.cluster);
                        });
      for (std::uint32_t i = 0; seen && i < leaf.object_count; ++i) {
        all[level.leaf_objects[leaf.first_object + i]] = 1;
      }
    }
    std::ranges::fill(baked, std::uint8_t{0});
    for (const ObjectId object : cells.seen_from(cell)) baked[object] = 1;
    CellComparison row;
    row.cell = cell;
    for (ObjectId o = 0; o < all.size(); ++o) {
      row.baked += baked[o], row.level += all[o];
      // What lies farther away than the level is drawn the level says nothing of.
      const bool judged = all[o] || between(cells.cell_bounds(cell), scene.bounds[o]) <= level.far_plane;
      if (baked[o] && !all[o] && judged) row.only_baked.push_back(o);
      if (all[o] && !baked[o]) row.only_level.push_back(o);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string comparison_csv(const CellPvs& cells, const std::vector<CellComparison>& rows) {
  std::string csv =
      "cell,min_x,min_y,min_z,max_x,max_y,max_z,baked,level,only_baked,only_level,only_baked_objects,"
      "only_level_objects\n";
  const auto list = [&](const std::vector<ObjectId>& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) csv += (i > 0 ? " " : "") + std::to_string(objects[i]);
  };
  for (const CellComparison& row : rows) {
    const Box b = cells.cell_bounds(row.cell);
    csv += std::to_string(row.cell);
    for (const float x : {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}) csv += fmt::format(",{}", x);
    csv += fmt::format(",{},{},{},{},", row.baked, row.level, row.only_baked.size(), row.only_level.size());
    list(row.only_baked);
    csv += ',';
    list(row.only_level);
    csv += '\n';
  }
  return csv;
}

}  // namespace sightline::bake
