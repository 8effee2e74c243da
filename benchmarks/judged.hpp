// What an answer lost, and what it kept for nothing, judged by the planes of its views in double precision.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/view.hpp>

namespace sightline::benchmarks {

class ExactPlanes {
public:
  explicit ExactPlanes(const View& view) {
    std::array<std::array<double, 4>, 4> rows{};
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t i = 0; i < 16; ++i) {
        rows[r][i / 4] += static_cast<double>(view.eye_to_clip.m[4 * (i % 4) + r]) *
                          static_cast<double>(view.world_to_eye.m[i]);
      }
    }
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        planes_[2 * axis][c] = rows[3][c] + rows[axis][c];
        planes_[2 * axis + 1][c] = rows[3][c] - rows[axis][c];
      }
      planes_[4][c] = rows[2][c];
      planes_[5][c] = rows[3][c] - rows[2][c];
    }
  }

  /// Whether no plane has all of the box behind it.
  [[nodiscard]] bool keep(const Box& box) const {
    return std::ranges::all_of(planes_, [&](const std::array<double, 4>& p) {
      return p[0] * (p[0] >= 0 ? box.max.x : box.min.x) + p[1] * (p[1] >= 0 ? box.max.y : box.min.y) +
                 p[2] * (p[2] >= 0 ? box.max.z : box.min.z) + p[3] >=
             0;
    });
  }

private:
  std::array<std::array<double, 4>, 6> planes_;
};

/// Counts what the views together see and the answer lacks, and the reverse.
inline void judge(benchmark::State& state, const Boxes& boxes, std::span<const View> views,
                  std::span<const ObjectId> visible) {
  const std::vector<ExactPlanes> planes(views.begin(), views.end());
  std::vector<bool> kept(boxes.size());
  for (const ObjectId id : visible) kept[id] = true;
  std::size_t lost = 0, excess = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool right = std::ranges::any_of(planes, [&](const ExactPlanes& p) { return p.keep(boxes[i]); });
    lost += right && !kept[i], excess += kept[i] && !right;
  }
  state.counters["visible"] = static_cast<double>(visible.size());
  state.counters["lost"] = static_cast<double>(lost);
  state.counters["excess"] = static_cast<double>(excess);
}

}  // namespace sightline::benchmarks
