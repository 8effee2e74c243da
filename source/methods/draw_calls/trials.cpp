#include "methods/draw_calls/trials.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightline::methods {

Trials::Trials(std::uint32_t ways, std::uint32_t first)
    : ways_(ways), round_(ways), sorted_(ways), running_(ways), current_(first) {
  for (std::uint32_t i = 0; i < ways; ++i) ways_[i].id = i;
  std::swap(ways_[0].id, ways_[first].id);
  settled_ = ways == 1;
}

Trials::Way& Trials::turn(std::uint32_t position) noexcept {
  return ways_[rounds_ % 2 == 0 ? position : running_ - 1 - position];
}

void Trials::took(double time) noexcept {
  if (!(time > 0) || !std::isfinite(time)) return;
  if (settled_) {
    watch(time);
    return;
  }
  warm_ = !warm_;
  if (warm_) return;
  round_[position_] = time;
  if (++position_ == running_) end_round();
  current_ = settled_ ? winner() : turn(position_).id;
}

void Trials::end_round() noexcept {
  std::copy_n(round_.begin(), running_, sorted_.begin());
  std::sort(sorted_.begin(), sorted_.begin() + running_);
  const double most = 2 * sorted_[(running_ - 1) / 2];
  for (std::uint32_t p = 0; p < running_; ++p) turn(p).sum += std::min(round_[p], most);
  position_ = 0;
  if (++rounds_ == kRounds[phase_]) end_phase();
}

void Trials::end_phase() noexcept {
  std::sort(ways_.begin(), ways_.begin() + running_,
            [](const Way& a, const Way& b) { return a.sum != b.sum ? a.sum < b.sum : a.id < b.id; });
  rounds_ = 0;
  running_ = std::min(running_, phase_ == 0 ? std::max(kFinalists, (running_ + 1) / 2) : kFinalists);
  settled_ = ++phase_ == kRounds.size();
  if (settled_) {
    const auto alike = std::find_if(ways_.begin(), ways_.begin() + running_,
                                    [&](const Way& way) { return way.sum > kAlike * ways_.front().sum; });
    const auto lowest =
        std::min_element(ways_.begin(), alike, [](const Way& a, const Way& b) { return a.id < b.id; });
    std::rotate(ways_.begin(), lowest, lowest + 1);
  }
  for (Way& way : ways_) way.sum = 0;
}

void Trials::watch(double time) noexcept {
  const auto rivals = static_cast<std::uint32_t>(running_ - 1);
  if (rivals == 0) return;
  if (!trying_) {
    own_ = time;
    if (++since_ < kBetweenTrials - 2) return;
    since_ = 0;
    rival_ = rival_ % rivals + 1;
    trying_ = true;
    current_ = ways_[rival_].id;
    return;
  }
  warm_ = !warm_;
  if (warm_) return;
  trying_ = false;
  Way& rival = ways_[rival_];
  rival.ratios[rival.samples++] = time / own_;
  if (rival.samples == kTrials) {
    std::sort(rival.ratios.begin(), rival.ratios.end());
    if (rival.ratios[kTrials / 2] < kWorthAChange) {
      std::swap(ways_.front().id, rival.id);
      for (Way& way : ways_) way.samples = 0;
    }
    rival.samples = 0;
  }
  current_ = winner();
}

}  // namespace sightline::methods
