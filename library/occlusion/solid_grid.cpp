#include "library/occlusion/solid_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sightline::occlusion {

namespace {

constexpr int kCells = SolidGrid::kCells + 2;  // between all nodes
constexpr double kLeastBox = 1e-3;             // of the cube

// Cells by their lowest node: 1 where all eight lie inside, not yet in a box.
class FullCells {
public:
  explicit FullCells(const SolidGrid& grid) : full_(std::size_t{kCells} * kCells * kCells) {
    for (int z = 0; z < kCells; ++z) {
      for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
          bool full = true;
          for (int i = 0; i < 8; ++i)
            full = full && grid.depth[SolidGrid::index(x + i % 2, y + i / 2 % 2, z + i / 4)] > 0;
          full_[at({x, y, z})] = full;
        }
      }
    }
  }

  struct Range {
    std::array<int, 3> low, high;  // high is not in it
  };

  // The largest cube, and what it grows to in its six directions, the largest growth first.
  [[nodiscard]] Range largest() const {
    Range best = largest_cube();
    while (best.low[0] < best.high[0]) {
      Range grown = best;
      long most = 0;
      for (int a = 0; a < 3; ++a) {
        for (const bool up : {false, true}) {
          Range slab = best, next = best;
          (up ? next.high : next.low)[a] += up ? 1 : -1;
          slab.low[a] = up ? best.high[a] : next.low[a], slab.high[a] = slab.low[a] + 1;
          if (volume(slab) > most && all_full(slab)) most = volume(slab), grown = next;
        }
      }
      if (most == 0) break;
      best = grown;
    }
    return best;
  }

  void clear(const Range& r) {
    for_each(r, [&](const std::array<int, 3>& c) { return full_[at(c)] = 0, true; });
  }

private:
  static std::size_t at(const std::array<int, 3>& c) {
    return (static_cast<std::size_t>(c[2]) * kCells + static_cast<std::size_t>(c[1])) * kCells +
           static_cast<std::size_t>(c[0]);
  }
  static long volume(const Range& r) {
    return long{r.high[0] - r.low[0]} * (r.high[1] - r.low[1]) * (r.high[2] - r.low[2]);
  }
  template <class Visit>
  static bool for_each(const Range& r, Visit visit) {
    for (int z = r.low[2]; z < r.high[2]; ++z) {
      for (int y = r.low[1]; y < r.high[1]; ++y) {
        for (int x = r.low[0]; x < r.high[0]; ++x) {
          if (!visit({x, y, z})) return false;
        }
      }
    }
    return true;
  }
  [[nodiscard]] bool all_full(const Range& r) const {
    for (int a = 0; a < 3; ++a) {
      if (r.low[a] < 0 || r.high[a] > kCells) return false;
    }
    return for_each(r, [&](const std::array<int, 3>& c) { return full_[at(c)] != 0; });
  }
  [[nodiscard]] Range largest_cube() const {
    std::vector<std::uint8_t> side(full_.size(), 0);  // of the largest cube whose highest cell this is
    Range best{};
    int most = 0;
    for_each({{0, 0, 0}, {kCells, kCells, kCells}}, [&](const std::array<int, 3>& c) {
      if (!full_[at(c)]) return true;
      int least = kCells;
      for (int i = 1; i < 8; ++i) {
        const std::array<int, 3> before{c[0] - i % 2, c[1] - i / 2 % 2, c[2] - i / 4};
        const bool there = before[0] >= 0 && before[1] >= 0 && before[2] >= 0;
        least = std::min(least, there ? int{side[at(before)]} : 0);
      }
      side[at(c)] = static_cast<std::uint8_t>(least + 1);
      if (least + 1 > most) {
        most = least + 1;
        for (std::size_t a = 0; a < 3; ++a) best.low[a] = c[a] - least, best.high[a] = c[a] + 1;
      }
      return true;
    });
    return best;
  }

  std::vector<std::uint8_t> full_;
};

// Moves each side outwards as far as it goes, to a part of a cell.
void widen(const Solid& solid, const std::vector<Bounds3>& others, Bounds3& box) {
  const auto free = [&](const Bounds3& b) {
    return !solid.touches(b) && std::ranges::none_of(others, [&](const Bounds3& o) {
      return glm::all(glm::lessThan(o.low, b.high)) && glm::all(glm::lessThan(b.low, o.high));
    });
  };
  for (int side = 0; side < 6; ++side) {
    double by = SolidGrid::kStep;
    for (int tries = 0; tries < 7; ++tries, by /= 2) {
      Bounds3 wider = box;
      (side < 3 ? wider.low : wider.high)[side % 3] += side < 3 ? -by : by;
      if (free(wider)) box = wider;
    }
  }
}

}  // namespace

SolidGrid::SolidGrid(const Solid& solid) : depth(std::size_t{kNodes} * kNodes * kNodes) {
  std::vector<Solid::Crossing> met;
  for (int z = 0; z < kNodes; ++z) {
    for (int y = 0; y < kNodes; ++y) {
      // Where the line passes an edge, nothing is said to be inside.
      if (!solid.crossings(place(0, y, z), 0, met)) met.clear();
      std::size_t passed = 0;
      int turns = 0;
      double near = 2 * kStep;  // how far off the surface is at most: a step farther than before
      for (int x = 0; x < kNodes; ++x) {
        const glm::dvec3 at = place(x, y, z);
        for (; passed < met.size() && met[passed].at < at.x; ++passed) turns -= met[passed].turn;
        const double away = solid.distance(at, near);
        near = std::min(2 * kStep, away + 1.001 * kStep);
        depth[index(x, y, z)] = static_cast<float>(solid.inside_by(turns, passed) ? away : -away);
      }
    }
  }
}

std::vector<Bounds3> boxes_inside(const Solid& solid, const SolidGrid& grid, std::size_t most) {
  std::vector<Bounds3> out;
  FullCells cells(grid);
  for (std::size_t tries = 0; tries < 4 * most && out.size() < most; ++tries) {
    const FullCells::Range range = cells.largest();
    Bounds3 box;
    box.add(SolidGrid::place(range.low[0], range.low[1], range.low[2]));
    box.add(SolidGrid::place(range.high[0], range.high[1], range.high[2]));
    const glm::dvec3 size = box.high - box.low;
    if (!(size.x * size.y * size.z > kLeastBox)) break;
    cells.clear(range);
    // What is thinner than a cell the grid has not seen.
    for (int i = 0; i < 3 && solid.touches(box); ++i)
      box.low += 0.5 * SolidGrid::kStep, box.high -= 0.5 * SolidGrid::kStep;
    if (!glm::all(glm::lessThan(box.low, box.high)) || !solid.holds(box)) continue;
    widen(solid, out, box);
    out.push_back(box);
  }
  return out;
}

}  // namespace sightline::occlusion
