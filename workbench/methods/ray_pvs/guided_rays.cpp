#include "workbench/methods/ray_pvs/guided_rays.hpp"

#include <algorithm>
#include <numeric>

namespace sightline::methods {

namespace {

constexpr ObjectId kNotCast = kNoObject - 1, kWaiting = kNoObject - 2;
constexpr std::size_t kBatch = 1024;

std::size_t count_seen(std::span<const std::uint8_t> seen) {
  return static_cast<std::size_t>(std::accumulate(seen.begin(), seen.end(), std::uint64_t{0}));
}

}  // namespace

void GuidedRays::add(std::uint32_t x, std::uint32_t y) {
  const std::uint32_t pixel = y * width_ + x;
  if (nearest_[pixel] != kNotCast) return;
  nearest_[pixel] = kWaiting;
  pixels_.push_back(pixel);
  rays_.push_back(view_rays_->through(x + 0.5, y + 0.5));
}

void GuidedRays::flush(const partition::TriangleRays& rays, std::span<std::uint8_t> seen,
                       partition::TriangleRays::Stack& stack, rays::RayStats& stats) {
  hits_.resize(rays_.size());
  rays.cast(rays_, hits_, seen, stack, stats);
  for (std::size_t i = 0; i < pixels_.size(); ++i) nearest_[pixels_[i]] = hits_[i];
  pixels_.clear(), rays_.clear();
}

void GuidedRays::cast(const View& view, const partition::TriangleRays& rays, const Options& options,
                      std::span<std::uint8_t> seen, partition::TriangleRays::Stack& stack,
                      rays::RayStats& stats) {
  const rays::ViewRays view_rays(view);
  view_rays_ = &view_rays;
  width_ = view.width, height_ = view.height;
  const std::uint32_t pixels = width_ * height_;
  nearest_.assign(pixels, kNotCast);

  // A cell is named by its corner; its far corners are cut off at the image's border.
  std::uint32_t step = options.spacing;
  const auto far_x = [&](std::uint32_t x, std::uint32_t by) { return std::min(x + by, width_ - 1); };
  const auto far_y = [&](std::uint32_t y, std::uint32_t by) { return std::min(y + by, height_ - 1); };
  cells_.clear();
  for (std::uint32_t y = 0; y < height_; y += step) {
    for (std::uint32_t x = 0; x < width_; x += step) {
      cells_.push_back(y * width_ + x);
      for (const std::uint32_t corner_y : {y, far_y(y, step)})
        add(x, corner_y), add(far_x(x, step), corner_y);
    }
  }
  flush(rays, seen, stack, stats);
  for (; step > 1; step /= 2) {
    const std::uint32_t half = step / 2;
    finer_.clear();
    for (const std::uint32_t cell : cells_) {
      const std::uint32_t x = cell % width_, y = cell / width_, right = far_x(x, step),
                          below = far_y(y, step);
      const ObjectId first = nearest_[cell];
      if (nearest_[y * width_ + right] == first && nearest_[below * width_ + x] == first &&
          nearest_[below * width_ + right] == first) {
        continue;
      }
      for (const std::uint32_t finer_y : {y, far_y(y, half)}) {
        for (const std::uint32_t finer_x : {x, far_x(x, half)}) finer_.push_back(finer_y * width_ + finer_x);
      }
    }
    std::sort(finer_.begin(), finer_.end());
    finer_.erase(std::unique(finer_.begin(), finer_.end()), finer_.end());
    for (const std::uint32_t cell : finer_) {
      const std::uint32_t x = cell % width_, y = cell / width_;
      for (const std::uint32_t corner_y : {y, far_y(y, half)})
        add(x, corner_y), add(far_x(x, half), corner_y);
    }
    flush(rays, seen, stack, stats);
    std::swap(cells_, finer_);
  }

  // Probes, spread evenly at every length of the row: steps of the golden section through all pixels.
  std::uint32_t stride = std::max(1u, static_cast<std::uint32_t>(0.6180339887498949 * pixels));
  while (std::gcd(stride, pixels) != 1) ++stride;
  std::uint64_t at = 0;
  std::uint64_t quiet = 0;
  std::size_t found = count_seen(seen);
  auto left = static_cast<std::uint64_t>(std::count(nearest_.begin(), nearest_.end(), kNotCast));
  for (std::uint32_t turn = 0; turn < pixels && left > 0;) {
    for (; turn < pixels && rays_.size() < kBatch; ++turn, at = (at + stride) % pixels) {
      const auto pixel = static_cast<std::uint32_t>(at);
      add(pixel % width_, pixel / width_);
    }
    const std::size_t cast_now = rays_.size();
    left -= cast_now;
    flush(rays, seen, stack, stats);
    const std::size_t now = count_seen(seen);
    quiet = now > found ? 0 : quiet + cast_now;
    found = now;
    // The lost share is at most that of `left`, of which `quiet` samples showed nothing new.
    if (static_cast<double>(quiet) * options.target * pixels >= 5.0 * static_cast<double>(left)) break;
  }
  view_rays_ = nullptr;
}

}  // namespace sightline::methods
