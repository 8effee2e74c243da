// The bounding volumes that object tests look at, in the order a method wants them in.
#pragma once

#include <vector>

#include <sightline/frustum.hpp>
#include <sightline/workbench/parameters.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::submission {

enum class Volume : std::uint8_t { sphere, box };

/// The parameter `bounds`, for the tables of methods that have it.
inline constexpr ParameterInfo kBoundsParameter{
    "bounds", "the bounding volume that is tested", "sphere", 0, 0, false, "sphere|box"};
Volume volume_from(const Parameters& parameters) noexcept;

/// Copies of the objects' bounding spheres or boxes, each beside its object's id.
class ObjectBounds {
public:
  explicit ObjectBounds(Volume volume) : volume_(volume) {}

  /// Takes the objects in the given order.
  void assign(const Scene& scene, std::span<const ObjectId> order);
  /// Reads one object's volume anew.
  void refresh(const Scene& scene, std::size_t slot) noexcept;
  /// The axis-aligned box of the volume in a slot.
  [[nodiscard]] Box box(std::size_t slot) const noexcept;
  [[nodiscard]] std::span<const ObjectId> ids() const noexcept { return ids_; }

  /// Tests slots [first, first + count) against the frustum; writes the ids that overlap, and returns how
  /// many. `out` has room for count + kCullPadding.
  std::size_t cull(const Frustum& frustum, std::size_t first, std::size_t count,
                   std::span<ObjectId> out) const noexcept;

private:
  Volume volume_;
  std::vector<ObjectId> ids_;
  Boxes boxes_;                       // Volume::box
  std::vector<float> x_, y_, z_, r_;  // Volume::sphere
};

/// The box that holds the scene's objects' volumes of either kind, and cells around them that are rounded
/// outwards a little.
Box volume_extent(const Scene& scene) noexcept;

}  // namespace sightline::submission
