// What sees worlds, as Python holds it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <vector>

#include "bindings/python/objects.hpp"

namespace sightline::python {

using SharedWorld = Guarded<World>;
using Reading = std::shared_lock<std::shared_mutex>;

/// A culler, and the images of the views that it last culled with automatic occlusion, by their places.
struct LockedCuller : Guarded<Culler> {
  struct Image {
    std::uint32_t width = 0, height = 0;
  };
  std::array<Image, kMaxViews> images = {};

  void remember(std::span<const CullView> views) {
    for (std::size_t i = 0; i < views.size(); ++i)
      images[i] = {views[i].view.view.width, views[i].view.view.height};
  }
};

struct ViewOfWorld {
  WorldView view;
  std::uint32_t layers = kAllLayers;
  float min_area = 0;
  std::shared_ptr<Occlusion> occlusion = nullptr;
  float distance_scale = 1;
  std::optional<std::uint32_t> distance_view = {};
  std::shared_ptr<Casters> casters = nullptr;
};

/// A View, a CullView, or a sequence of them.
std::vector<ViewOfWorld> views_of(const pybind11::object& given);
/// The same for the library; the views must live as long.
std::vector<CullView> cull_views_of(const std::vector<ViewOfWorld>& views);
/// Locks all that a cull reads besides what it culls, and others, each once and always in the same order.
std::vector<Reading> lock_all(const std::vector<ViewOfWorld>& views,
                              std::vector<std::shared_mutex*> mutexes = {});

}  // namespace sightline::python
