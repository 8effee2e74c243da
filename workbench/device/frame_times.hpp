// What drawing a frame took and gave: for those who draw by a renderer's owner and need nothing of Vulkan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sightline::device {

class Device;
class Renderer;

enum class PassKind : std::uint8_t {
  occluders,  ///< depth that nothing but culling reads
  cull,
  draw,
};

struct PassTime {
  std::string name;
  PassKind kind;
  double milliseconds;
};

/// What is timed besides the whole frame. On llvmpipe each timestamp is a round through all its threads, a
/// tenth of a short frame, so that a frame tells its own time best without.
enum class Timed : std::uint8_t { frame, passes };

struct FrameTimes {
  std::vector<PassTime> passes;  ///< GPU, in order; none where they were not asked for
  double record_ms = 0;          ///< CPU, what the recording function took: culling on the CPU stands in it
  double frame_ms = 0;           ///< from the beginning of recording to the finished picture

  [[nodiscard]] double gpu_ms(PassKind kind) const noexcept;
};

/// The red, green, blue and alpha bytes of a picture, row 0 first, red lowest.
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> pixels;
  bool operator==(const Picture&) const = default;
};

}  // namespace sightline::device
