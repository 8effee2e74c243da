// Who is visible in truth, and what an answer lost: one interface for the two oracles, rays and the
// rasteriser.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/triangle_draws.hpp>

#include "workbench/oracle/item_buffer.hpp"
#include "workbench/oracle/loss.hpp"

namespace sightline::device {
class Renderer;
struct Picture;
}  // namespace sightline::device

namespace sightline::oracle {

/// What a method answered for a view.
struct Answer {
  const Frame& frame;
  const TriangleGeometry* geometry = nullptr;  ///< Method::geometry()
  /// The picture that it drew and its depths, where they are to be compared with those of everything; else
  /// null.
  const device::Picture* picture = nullptr;
  const std::vector<float>* depth = nullptr;
};

struct Judgement {
  Loss loss;
  std::size_t truly_visible = 0;       ///< objects with a pixel
  std::uint64_t different_pixels = 0;  ///< of the picture, where one was given
};

class Oracle {
public:
  virtual ~Oracle() = default;
  Oracle() = default;
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;

  /// Who shows in each pixel when everything is drawn and nothing culled. Valid until the next call. Throws
  /// Error for a view that does not pass check(), and where objects or meshes were added to the scene since
  /// the oracle was made, as update() does.
  virtual const ItemBuffer& look(const View& view) = 0;
  /// Holds an answer against the truth: the scene's, or where a method draws triangles of its own, that of
  /// those. Throws Error for an answer that no method may give: an object named twice or not in the scene, a
  /// draw that is no range of the geometry.
  virtual Judgement judge(const View& view, const Answer& answer) = 0;
  /// Told after Scene::move_object of each of `objects`, before the next look; on a device after
  /// Renderer::update, too.
  virtual void update(std::span<const ObjectId> objects) = 0;
};

/// Rays by Embree, losses confirmed in double precision: through pixel centres, or where `samples` is not 0
/// through so many random places of each pixel, the same in every view; then an object is visible that any of
/// them sees, and pixels count once a sample. Of methods that draw triangles of their own centres alone are
/// judged. The scene outlives it.
std::unique_ptr<Oracle> make_ray_oracle(const Scene& scene, std::uint32_t samples = 0);

/// The rasteriser's item buffer, and pictures to compare with; losses confirmed with a depth that is dense
/// wherever the view's own is not. The renderer outlives it.
std::unique_ptr<Oracle> make_raster_oracle(device::Renderer& renderer);

}  // namespace sightline::oracle
