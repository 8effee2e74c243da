// The judge: the item buffer by Embree rays through pixel centres, or other places of pixels. It sees meshes
// and matrices, and knows none of the culling code that it judges.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/scene.hpp>

#include "workbench/oracle/item_buffer.hpp"
#include "workbench/oracle/object_triangles.hpp"

namespace sightline::oracle {

class EmbreeJudge {
public:
  /// Builds acceleration structures over all triangles. The scene outlives the judge. Throws Error where
  /// Embree cannot be started or runs out of memory.
  explicit EmbreeJudge(const Scene& scene);
  ~EmbreeJudge();
  EmbreeJudge(const EmbreeJudge&) = delete;
  EmbreeJudge& operator=(const EmbreeJudge&) = delete;

  /// Throws Error for a view that does not pass check(). Same scene and view, same answer for any number of
  /// threads. Which of a pixel's places the rays go through, `sample` says, as for PixelRays.
  [[nodiscard]] ItemBuffer render(const View& view, std::uint32_t sample = 0) const;

  /// Told after Scene::move_object of each of `objects`.
  void move(std::span<const ObjectId> objects);

  /// For each of `objects`: of the pixels in which `truth` sees it, those whose ray meets one of its
  /// triangles in double precision too. Embree works in single: what it sees on a silhouette alone may be its
  /// own rounding, and nobody is accused on that.
  [[nodiscard]] std::vector<std::uint32_t> confirmed_pixels(const View& view, const ItemBuffer& truth,
                                                            std::span<const ObjectId> objects) const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sightline::oracle
