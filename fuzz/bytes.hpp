// The fuzzer's bytes, read as values; zeros when they are used up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace sightline::fuzz {

class Bytes {
public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  [[nodiscard]] bool empty() const { return at_ == end_; }

  template <class T>
  T take() {
    T value{};
    const std::size_t n = std::min(sizeof(T), static_cast<std::size_t>(end_ - at_));
    std::memcpy(&value, at_, n);
    at_ += n;
    return value;
  }
  std::uint8_t byte() { return take<std::uint8_t>(); }

private:
  const std::uint8_t *at_, *end_;
};

}  // namespace sightline::fuzz
