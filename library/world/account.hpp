// What automatic occlusion may spend, so that it is never slower: counted work × costs, never a clock's
// reading.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "library/geometry/mutant.h"

namespace sightline::world {

/// Tries of what may not pay: each that did not makes the next one rarer, at the worst one time in 32 alike,
/// or in so many and one.
class Tries {
public:
  explicit Tries(std::uint32_t longest_pause = 31) noexcept : longest_pause_(longest_pause) {}
  /// Whether to try this time; counts the times that wait. What is far larger than what failed is no like of
  /// it: the camera turned, or a door opened.
  [[nodiscard]] bool begin(double size) noexcept {
    constexpr double kUnlike = 8;
    if (waits_ == 0 || size > kUnlike * failed_) return true;
    --waits_;
    return false;
  }
  void failed(double size) noexcept {
    pause_ = waits_ = std::min(2 * pause_ + 1, longest_pause_);
    failed_ = size;
  }
  void paid() noexcept { pause_ = waits_ = 0; }

private:
  std::uint32_t longest_pause_, pause_ = 0, waits_ = 0;
  double failed_ = 0;  // how large the last one was that did not pay
};

/// The sum over all frames: what they cost, and what culling by frustum alone would have.
class Account {
public:
  /// What a frame that costs so much by frustum alone may cost more, before it has saved anything. By 1/1000
  /// less than is promised, which leaves room for rounding.
  [[nodiscard]] double allowance(double frustum_cost) const noexcept {
    return std::max(0.0, std::min(0.04995 * frustum_cost, 0.01998 * frustum_cost + credit_));
  }
  void close_frame(double cost, double frustum_cost) noexcept {
    credit_ += 1.01998 * frustum_cost - cost;
    // To look and find that nothing is affordable is no try.
    if (cost > 1.001 * frustum_cost) tries_.failed(frustum_cost);
    if (cost < frustum_cost) tries_.paid();
  }
  /// Whether a frame may try at all; counts the frames that may not.
  [[nodiscard]] bool begins_try(double frustum_cost) noexcept { return tries_.begin(frustum_cost); }

private:
  double credit_ = 0;
  Tries tries_;
};

/// What a frame has to spend: its allowance and what it has saved for certain, less what it spent.
class Purse {
public:
  explicit Purse(double allowance) noexcept : left_(allowance) {}
  [[nodiscard]] double left() const noexcept { return left_; }
  [[nodiscard]] double spent() const noexcept { return spent_; }
  [[nodiscard]] bool affords(double cost) const noexcept {
    return cost <= left_ || SIGHTLINE_MUTANT(purse_without_a_bottom);
  }
  void pay(double cost) noexcept { left_ -= cost, spent_ += cost; }
  void earn(double saved) noexcept { left_ += saved; }

private:
  double left_, spent_ = 0;
};

/// What an object costs: the slope of frame times over objects drawn, older frames counting less and less.
/// Nothing is learned from times that hardly depend on what is drawn: such frames wait for something else, as
/// for the display.
class ObjectCost {
public:
  void drew(std::size_t objects) noexcept { objects_ = static_cast<double>(objects); }
  void took(double time) noexcept {
    constexpr double kForget = 63.0 / 64;
    for (double* sum : {&n_, &x_, &t_, &xx_, &xt_, &tt_}) *sum *= kForget;
    n_ += 1, x_ += objects_, t_ += time;
    xx_ += objects_ * objects_, xt_ += objects_ * time, tt_ += time * time;
    // Frames that all draw about as much say nothing of one object.
    const double spread = n_ * xx_ - x_ * x_;
    if (n_ < 8 || spread < 1e-3 * x_ * x_ || !(x_ > 0)) return;
    const double together = n_ * xt_ - x_ * t_, slope = together / spread;
    // The square of the slope's error, by how far the times lie from the line.
    const double error = (n_ * tt_ - t_ * t_ - slope * together) / (spread * (n_ - 2));
    constexpr double kSure = 3;  // errors
    // Of the time: less is what rounding leaves of times that are all the same.
    constexpr double kLeast = 1e-3;
    if (slope * x_ > kLeast * t_ && slope * slope > kSure * kSure * error) learned_ = slope;
  }
  /// `otherwise` as long as nothing was learned.
  [[nodiscard]] double value(double otherwise) const noexcept { return learned_ < 0 ? otherwise : learned_; }

private:
  double objects_ = 0, n_ = 0, x_ = 0, t_ = 0, xx_ = 0, xt_ = 0, tt_ = 0, learned_ = -1;
};

}  // namespace sightline::world
