// Surface nets (Gibson 1998): a point in each cell that the surface passes through, joined across the edges
// that it crosses.
#include "library/occlusion/shell.hpp"

namespace sightline::occlusion {

namespace {

constexpr float kBelow = 0.3f * static_cast<float>(SolidGrid::kStep);  // the surface

class SurfaceNet {
public:
  explicit SurfaceNet(const SolidGrid& grid) : grid_(grid), point_(grid.depth.size(), kNone) {
    for_each_cell([&](int x, int y, int z) { add_point(x, y, z); });
    for_each_cell([&](int x, int y, int z) {
      for (int axis = 0; axis < 3; ++axis) add_quad({x, y, z}, axis);
    });
  }
  Shell take() { return std::move(out_); }

private:
  static constexpr std::uint32_t kNone = ~0u;

  template <class Visit>
  static void for_each_cell(Visit visit) {
    for (int z = 0; z + 1 < SolidGrid::kNodes; ++z) {
      for (int y = 0; y + 1 < SolidGrid::kNodes; ++y) {
        for (int x = 0; x + 1 < SolidGrid::kNodes; ++x) visit(x, y, z);
      }
    }
  }
  [[nodiscard]] float depth(int x, int y, int z) const {
    return grid_.depth[SolidGrid::index(x, y, z)] - kBelow;
  }

  // The middle of where the cell's edges are crossed.
  void add_point(int x, int y, int z) {
    glm::dvec3 sum(0);
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 4; ++i) {
        int from[3] = {x, y, z};
        from[(axis + 1) % 3] += i % 2, from[(axis + 2) % 3] += i / 2;
        int to[3] = {from[0], from[1], from[2]};
        ++to[axis];
        const float a = depth(from[0], from[1], from[2]), b = depth(to[0], to[1], to[2]);
        if ((a > 0) == (b > 0)) continue;
        const double t = double{a} / (double{a} - double{b});
        sum +=
            (1 - t) * SolidGrid::place(from[0], from[1], from[2]) + t * SolidGrid::place(to[0], to[1], to[2]);
        ++count;
      }
    }
    if (count == 0) return;
    point_[SolidGrid::index(x, y, z)] = static_cast<std::uint32_t>(out_.points.size());
    out_.points.push_back(sum / static_cast<double>(count));
  }

  // Around the edge from a node along an axis, if it is crossed.
  void add_quad(const std::array<int, 3>& from, int axis) {
    const std::size_t a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    if (from[b] == 0 || from[c] == 0) return;
    std::array<int, 3> to = from;
    ++to[a];
    const bool inside = depth(from[0], from[1], from[2]) > 0;
    if (inside == (depth(to[0], to[1], to[2]) > 0)) return;
    std::array<std::uint32_t, 4> corner{};
    constexpr int kBack[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<int, 3> cell = from;
      cell[b] -= kBack[i][0], cell[c] -= kBack[i][1];
      corner[inside ? i : 3 - i] = point_[SolidGrid::index(cell[0], cell[1], cell[2])];
    }
    out_.triangles.push_back({corner[0], corner[1], corner[2]});
    out_.triangles.push_back({corner[0], corner[2], corner[3]});
  }

  const SolidGrid& grid_;
  std::vector<std::uint32_t> point_;
  Shell out_;
};

}  // namespace

Shell grid_shell(const SolidGrid& grid) {
  return SurfaceNet(grid).take();
}

}  // namespace sightline::occlusion
