#include "lab/bake_check.hpp"

#include <algorithm>

#include <sightline/error.hpp>

#include "lab/loss.hpp"
#include "scene/random.hpp"

namespace sightline::lab {
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

BakeLoss check_bake(const Scene& scene, const CellPvs& cells, const EmbreeJudge& judge, std::size_t views,
                    std::uint32_t width, std::uint32_t height, std::uint64_t seed, const Progress& progress) {
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
    camera.near_plane = 0.01f;
    camera.far_plane = 1e5f;
    if (!place_in(scene, cells.cell_bounds(cell), random, camera.eye)) continue;
    const Result<View> view = make_view(camera, width, height);
    // The border between cells belongs to one of them only.
    if (!view || cells.cell_at(camera.eye) != cell) continue;
    const ItemBuffer truth = judge.render(*view);
    const auto set = cells.seen_from(cell);
    const Loss lost = compare_to_truth(truth, set);
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

std::vector<CellComparison> compare_with_level(const Scene& scene, const CellPvs& cells, std::uint64_t seed) {
  constexpr int kPlaces = 64;
  scene::Random random(seed);
  std::vector<CellComparison> rows;
  std::vector<std::uint8_t> mask(scene.size()), all(scene.size()), baked(scene.size());
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (!cells.open[cell]) continue;
    std::fill(all.begin(), all.end(), std::uint8_t{0});
    std::fill(baked.begin(), baked.end(), std::uint8_t{0});
    std::vector<std::uint32_t> leaves;
    for (int i = 0; i < kPlaces; ++i) {
      Vec3 place;
      if (!place_in(scene, cells.cell_bounds(cell), random, place)) continue;
      const std::uint32_t leaf = scene.level->leaf_at(place);
      if (std::find(leaves.begin(), leaves.end(), leaf) != leaves.end()) continue;
      leaves.push_back(leaf);
      scene.level->potentially_visible(place, mask);
      for (std::size_t o = 0; o < all.size(); ++o) all[o] |= mask[o];
    }
    for (const ObjectId object : cells.seen_from(cell)) baked[object] = 1;
    CellComparison row{cell};
    for (std::size_t o = 0; o < all.size(); ++o) {
      row.baked += baked[o], row.level += all[o];
      row.only_baked += baked[o] && !all[o], row.only_level += all[o] && !baked[o];
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace sightline::lab
