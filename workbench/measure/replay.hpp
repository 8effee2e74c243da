// A view in which a method lost something, as a small file that shows the loss again.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "workbench/measure/verify.hpp"

namespace sightline::measure {

/// What it takes to look once more.
struct Replay {
  std::string scene, pvs;  ///< as the scene and the baked sets were asked for
  std::string method, device = "cpu";
  RasterState raster_state = RasterState::materials;
  double moving = 0;          ///< share of the objects that move before every look
  std::uint32_t samples = 0;  ///< random places of each pixel that are judged; 0: its centre
  LostObject lost;            ///< the view, what was drawn before it, and what was lost
};

/// {"scene": …, "pvs": …, "method": …, "device": …, "faces": "materials", "moving": 0, "samples": 0, "moves":
/// 0, "size": [w, h], "lost": {"object": …, "pixels": …}, "views": […]}: the views as in a path file, the
/// last is the one that lost.
void save_replay(const std::filesystem::path& file, const Replay& replay);
/// Throws Error for a file that cannot be read, is larger than a megabyte, or is no replay. `origin_of` gives
/// the origin of the scene named, which cameras count from.
Replay load_replay(const std::filesystem::path& file,
                   const std::function<WorldPoint(const Replay&)>& origin_of);

/// Looks again, on a bench of the replay's scene and method alone. What is lost now is in the verdict.
MethodVerdict look_again(Bench& bench, const Replay& replay);

}  // namespace sightline::measure
