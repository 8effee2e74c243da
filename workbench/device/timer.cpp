#include "workbench/device/timer.hpp"

namespace sightline::device {

Timer::Timer(const Device& device)
    : device_(device),
      pool_(device.handle(), vk::QueryPoolCreateInfo{{}, vk::QueryType::eTimestamp, 2 * kMostPasses}) {}

void Timer::reset(const vk::raii::CommandBuffer& commands, bool on) {
  passes_.clear();
  on_ = on;
  if (!on_) return;
  commands.resetQueryPool(*pool_, 0, 2 * kMostPasses);
}

void Timer::begin(const vk::raii::CommandBuffer& commands, std::string_view name, PassKind kind) {
  if (!on_) return;
  passes_.push_back({std::string(name), kind, 0});
  if (!device_.has_timestamps() || passes_.size() > kMostPasses) return;
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_,
                           2 * static_cast<std::uint32_t>(passes_.size() - 1));
}

void Timer::end(const vk::raii::CommandBuffer& commands) {
  if (!on_ || !device_.has_timestamps() || passes_.size() > kMostPasses) return;
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_,
                           2 * static_cast<std::uint32_t>(passes_.size() - 1) + 1);
}

std::vector<PassTime> Timer::read() const {
  std::vector<PassTime> out = passes_;
  if (!device_.has_timestamps() || out.empty()) return out;
  const auto timed = std::min<std::uint32_t>(kMostPasses, static_cast<std::uint32_t>(out.size()));
  const auto [result, ticks] =
      pool_.getResults<std::uint64_t>(0, 2 * timed, 2 * timed * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                      vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  if (result != vk::Result::eSuccess) return out;
  for (std::uint32_t i = 0; i < timed; ++i) {
    out[i].milliseconds =
        static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]) * device_.limits().timestampPeriod * 1e-6;
  }
  return out;
}

}  // namespace sightline::device
