#include "occluder_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "library/geometry/linear.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::bench {

namespace {

using Row = std::array<double, 3>;

Row cross(const Row& a, const Row& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// First and last pixels of a side whose samples, anywhere in them, an interval may hold.
struct Pixels {
  int first, last;
};
Pixels pixels_of(double low, double high, std::uint32_t size) {
  return {static_cast<int>(std::floor(std::clamp(low - 1, 0.0, size - 1.0))),
          static_cast<int>(std::floor(std::clamp(high + 1, 0.0, size - 1.0)))};
}

}  // namespace

OccluderTruth::OccluderTruth(const View& view, float near_plane, std::uint32_t samples, std::uint64_t seed)
    : width_(view.width), height_(view.height), samples_(samples), least_w_(near_plane) {
  const glm::dmat4 m =
      glm::transpose(geometry::to_double(view.eye_to_clip) * geometry::to_double(view.world_to_eye));
  for (int i = 0; i < 4; ++i) {
    clip_[0][i] = (m[0][i] + m[3][i]) / 2 * width_, clip_[1][i] = (m[3][i] - m[1][i]) / 2 * height_;
    clip_[2][i] = m[3][i];
  }
  offsets_.assign(2 * std::size_t{width_} * height_ * samples_, 0.5f);
  if (samples > 1) {
    scene::Random random(seed);
    for (float& at : offsets_) at = random.unit();
  }
  depth_.assign(std::size_t{width_} * height_ * samples_, 0);
}

OccluderTruth::Place OccluderTruth::place(std::uint32_t x, std::uint32_t y, std::uint32_t sample) const {
  const float* offset = &offsets_[2 * ((std::size_t{y} * width_ + x) * samples_ + sample)];
  return {x + double{offset[0]}, y + double{offset[1]}};
}

void OccluderTruth::draw(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                         bool two_sided) {
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    // Rows whose product with (x, y, 1) are the corners' weights over w (Olano & Greer 1997): no clipping.
    std::array<Row, 3> at;
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    int before = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = positions[indices[i + k]];
      for (std::size_t r = 0; r < 3; ++r)
        at[k][r] = clip_[r][0] * p.x + clip_[r][1] * p.y + clip_[r][2] * p.z + clip_[r][3];
      const double w = at[k][2];
      before += w >= least_w_;
      x0 = std::min(x0, at[k][0] / w), x1 = std::max(x1, at[k][0] / w);
      y0 = std::min(y0, at[k][1] / w), y1 = std::max(y1, at[k][1] / w);
    }
    if (before == 0) continue;
    if (before < 3) x0 = y0 = 0, x1 = width_, y1 = height_;
    if (x1 < 0 || y1 < 0 || x0 > width_ || y0 > height_) continue;
    const double area = at[0][0] * cross(at[1], at[2])[0] + at[0][1] * cross(at[1], at[2])[1] +
                        at[0][2] * cross(at[1], at[2])[2];
    if (area == 0 || (!two_sided && area > 0)) continue;
    std::array<Row, 3> weight{cross(at[1], at[2]), cross(at[2], at[0]), cross(at[0], at[1])};
    const Pixels columns = pixels_of(x0, x1, width_), rows = pixels_of(y0, y1, height_);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x) {
        for (std::uint32_t s = 0; s < samples_; ++s) {
          const auto [px, py] = place(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), s);
          double over_w = 0;
          bool inside = true;
          for (const Row& row : weight) {
            const double share = (row[0] * px + row[1] * py + row[2]) / area;
            inside = inside && share >= 0;
            over_w += share;
          }
          if (!inside || !(over_w > 0) || over_w * least_w_ > 1) continue;
          double& depth =
              depth_[(static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)) * samples_ + s];
          depth = std::max(depth, over_w);
        }
      }
    }
  }
}

bool OccluderTruth::sees(const Box& box) const {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300, least_w = 1e300;
  for (int c = 0; c < 8; ++c) {
    const double p[3] = {c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y,
                         c & 4 ? box.max.z : box.min.z};
    double at[3];
    for (int r = 0; r < 3; ++r)
      at[r] = clip_[r][0] * p[0] + clip_[r][1] * p[1] + clip_[r][2] * p[2] + clip_[r][3];
    x0 = std::min(x0, at[0] / at[2]), x1 = std::max(x1, at[0] / at[2]);
    y0 = std::min(y0, at[1] / at[2]), y1 = std::max(y1, at[1] / at[2]);
    least_w = std::min(least_w, at[2]);
  }
  if (least_w <= least_w_) return true;
  const Pixels columns = pixels_of(x0, x1, width_), rows = pixels_of(y0, y1, height_);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      for (std::uint32_t s = 0; s < samples_; ++s) {
        const auto [px, py] = place(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), s);
        if (px < x0 || px > x1 || py < y0 || py > y1) continue;
        if (depth_[(static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)) * samples_ + s] <=
            1 / least_w)
          return true;
      }
    }
  }
  return false;
}

}  // namespace sightline::bench
