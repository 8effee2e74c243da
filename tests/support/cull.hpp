// Culling as most tests do it: many views at once, and no refusal.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include <sightline/world.hpp>

namespace sightline::test {

/// Each with its occluders, where there are any.
inline std::vector<CullView> cull_views(std::span<const WorldView> views, float min_area = 0,
                                        std::span<const OcclusionBuffer* const> occlusion = {}) {
  std::vector<CullView> out;
  for (std::size_t v = 0; v < views.size(); ++v)
    out.push_back(
        {.view = views[v], .occlusion = occlusion.empty() ? nullptr : occlusion[v], .min_area = min_area});
  return out;
}

/// Fails the test where the call is refused.
inline CullResult cull(Culler& culler, const World& world, std::span<const CullView> views,
                       std::span<ObjectId> visible, std::span<std::uint8_t> masks = {},
                       const CullOptions& options = {}) {
  const Result<CullResult> result = culler.cull(world, views, options, {visible, masks});
  EXPECT_TRUE(result) << result.error().message();
  return result ? *result : CullResult{};
}

/// With a culler that remembers nothing.
inline CullResult cull(const World& world, const WorldView& view, std::span<ObjectId> visible,
                       float min_area = 0) {
  Culler culler;
  return cull(culler, world, cull_views({&view, 1}, min_area), visible);
}

}  // namespace sightline::test
