#include "workbench/methods/draw_calls/trials.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace sightline::methods {

namespace {

constexpr std::uint32_t kFirstPairs = 8, kBetweenPairs = 4;  // before ways are compared, and compared again
constexpr std::uint32_t kPairsBeforeCut = 32, kWaysAfterCut = 8, kPairsBeforeSecondCut = 64,
                        kWaysAfterSecondCut = 4;          // so many stay at most from then on
constexpr double kErrorsToDrop = 3, kErrorsToSettle = 2;  // standard errors
constexpr double kAlike = 0.005, kNearlyAlike = 0.015;    // shares of the leader's time

constexpr std::uint32_t kRivals = 3, kBetweenTrials = 128;
constexpr double kFade = 0.98, kLeastWeight = 6;  // of what 50 trials tell, old ones count little
constexpr double kWorthAChange = -0.03, kLeastScatter = 0.03;

}  // namespace

Trials::Trials(std::uint32_t ways, std::uint32_t first)
    : ways_(ways),
      order_(ways),
      round_(ways),
      sorted_(ways),
      pairs_(std::size_t{kMostPairs} * ways),
      running_(ways),
      current_(first),
      settled_(ways == 1),
      records_(std::min(ways - 1, kRivals)) {
  for (std::uint32_t i = 0; i < ways; ++i) ways_[i].id = order_[i] = i;
  std::swap(ways_[0].id, ways_[first].id);
  std::swap(order_[0], order_[first]);
}

void Trials::report_frame_time(double time) noexcept {
  if (!(time > 0) || !std::isfinite(time)) return;
  if (settled_) {
    watch(time);
    return;
  }
  warm_ = !warm_;
  if (warm_) return;
  round_[position_] = time;
  if (++position_ == running_) end_round();
  current_ = settled_ ? winner() : order_[position_];
}

void Trials::end_round() noexcept {
  std::copy_n(round_.begin(), running_, sorted_.begin());
  std::sort(sorted_.begin(), sorted_.begin() + running_);
  const double most = 2 * sorted_[(running_ - 1) / 2];
  double* pair = pairs_.data() + std::size_t{rounds_ / 2} * ways_.size();
  for (std::uint32_t p = 0; p < running_; ++p) pair[order_[p]] += std::min(round_[p], most);
  position_ = 0;
  if (++rounds_ % 2 != 0) {
    std::reverse(order_.begin(), order_.begin() + running_);
    return;
  }
  const std::uint32_t pairs = rounds_ / 2;
  if (pairs >= kFirstPairs && pairs % kBetweenPairs == 0) compare();
  for (std::uint32_t p = 0; p < running_; ++p) order_[p] = ways_[p].id;
  for (std::uint32_t p = 0; p + 1 < running_; ++p)
    std::swap(order_[p], order_[p + random_.below(running_ - p)]);
}

void Trials::compare() noexcept {
  const std::uint32_t pairs = rounds_ / 2;
  const auto time = [&](std::uint32_t pair, std::uint32_t id) { return pairs_[pair * ways_.size() + id]; };
  const std::span running(ways_.data(), running_);
  for (Way& way : running) {
    way.mean = 0;
    for (std::uint32_t p = 0; p < pairs; ++p) way.mean += time(p, way.id) / pairs;
  }
  const auto quicker = [](const Way& a, const Way& b) {
    return a.mean != b.mean ? a.mean < b.mean : a.id < b.id;
  };
  std::ranges::sort(running, quicker);
  const Way leader = running.front();
  for (Way& way : running) {
    way.slower = way.mean - leader.mean;
    double squares = 0;
    for (std::uint32_t p = 0; p < pairs; ++p) {
      const double off = time(p, way.id) - time(p, leader.id) - way.slower;
      squares += off * off;
    }
    way.error = std::sqrt(squares / pairs / (pairs - 1));
  }
  const std::size_t most = pairs >= kPairsBeforeSecondCut ? kWaysAfterSecondCut
                           : pairs >= kPairsBeforeCut     ? kWaysAfterCut
                                                          : running.size();
  const double worst = running[std::min(most, running.size()) - 1].mean;
  const auto left = std::partition(running.begin(), running.end(), [&](const Way& way) {
    return way.mean <= worst && way.slower <= kAlike * leader.mean + kErrorsToDrop * way.error;
  });
  std::sort(running.begin(), left, quicker);
  std::sort(left, running.end(), quicker);
  running_ = static_cast<std::uint32_t>(left - running.begin());
  const bool alike = std::all_of(running.begin(), left, [&](const Way& way) {
    return way.slower + kErrorsToSettle * way.error <= kNearlyAlike * leader.mean;
  });
  if (alike || pairs == kMostPairs) settle();
}

void Trials::settle() noexcept {
  settled_ = true;
  const double best = ways_.front().mean;
  const auto alike = std::find_if(ways_.begin(), ways_.begin() + running_,
                                  [&](const Way& way) { return way.mean > (1 + kAlike) * best; });
  const auto lowest =
      std::min_element(ways_.begin(), alike, [](const Way& a, const Way& b) { return a.id < b.id; });
  std::rotate(ways_.begin(), lowest, lowest + 1);
}

void Trials::watch(double time) noexcept {
  if (records_.empty()) return;
  if (!trying_) {
    own_ = time;
    if (++since_ < kBetweenTrials - 2) return;
    since_ = 0;
    rival_ = static_cast<std::uint32_t>((rival_ + 1) % records_.size());
    trying_ = true;
    current_ = ways_[1 + rival_].id;
    return;
  }
  warm_ = !warm_;
  if (warm_) return;
  trying_ = false;
  Record& record = records_[rival_];
  const double ratio = std::clamp(std::log(time / own_), -0.7, 0.7);
  record.weight = kFade * record.weight + 1;
  record.sum = kFade * record.sum + ratio;
  record.squares = kFade * record.squares + ratio * ratio;
  const double mean = record.sum / record.weight;
  const double scatter = std::sqrt(std::max(0.0, record.squares / record.weight - mean * mean));
  const double error = std::max(scatter, kLeastScatter) / std::sqrt(record.weight);
  if (record.weight > kLeastWeight - 0.5 && mean + kErrorsToDrop * error < kWorthAChange) {
    std::swap(ways_.front().id, ways_[1 + rival_].id);
    std::ranges::fill(records_, Record{});
  }
  current_ = winner();
}

}  // namespace sightline::methods
