// Lists that stay on the device from frame to frame: what has changed is sent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "workbench/device/buffer.hpp"

namespace sightline::device {

/// How many elements from the first on are those of the last list: the comparison with the last frame of Le
/// Hoang Minh et al. 2022, step C5.
template <class T>
[[nodiscard]] std::size_t unchanged(std::span<const T> list, std::span<const T> last) noexcept {
  return static_cast<std::size_t>(std::ranges::mismatch(list, last).in1 - list.begin());
}

template <class T>
class SentList {
public:
  /// Sends the elements from the first that is not the last list's on. Throws Error when memory runs out;
  /// `what` names it. Returns how many were sent.
  std::size_t send(Device& device, std::span<const T> list, std::string_view what) {
    if (buffer_.size() == 0 || buffer_.size() < list.size_bytes()) {
      buffer_ = Buffer(device, list.size_bytes(), Memory::upload, what);
      sent_.clear();
    }
    const std::size_t same = unchanged<T>(list, sent_);
    const std::span<const T> rest = list.subspan(same);
    std::ranges::copy(rest, buffer_.template mapped<T>() + same);
    sent_.resize(same);
    sent_.insert(sent_.end(), rest.begin(), rest.end());
    return rest.size();
  }

  [[nodiscard]] const Buffer& buffer() const noexcept { return buffer_; }

private:
  Buffer buffer_;
  std::vector<T> sent_;  ///< what the buffer holds, which is slow to read
};

}  // namespace sightline::device
