// Occlusion on the CPU, with no GPU: occluders are rasterised into a tiled hierarchical depth buffer, then
// boxes are tested against it. After masked software occlusion culling (Hasselgren, Andersson &
// Akenine-Möller 2016), but with a depth a pixel, and conservative: an occluder counts at a pixel only where
// it surely covers the pixel's centre, with a depth that surely is not nearer than its own; a box is hidden
// only where its nearest depth lies behind every pixel centre of its outward-rounded rectangle.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/result.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

namespace occlusion {
struct DepthTiles;
struct OccluderTopology;
struct TriangleBlock;
}  // namespace occlusion

/// Triangles that occlude. Vertices at one place are joined, and each triangle knows its neighbours, so that
/// the seams between triangles are tight while the outline is drawn a little smaller than it is.
class OccluderMesh {
public:
  /// Three indices a triangle, each below positions.size(); a triangle with an index out of range, or without
  /// area, is left out. Coordinates must be finite. Both faces of a triangle occlude.
  OccluderMesh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);
  ~OccluderMesh();
  OccluderMesh(OccluderMesh&&) noexcept;
  OccluderMesh& operator=(OccluderMesh&&) noexcept;

  [[nodiscard]] std::size_t triangles() const noexcept;
  [[nodiscard]] const occlusion::OccluderTopology& topology() const noexcept { return *topology_; }

private:
  std::unique_ptr<occlusion::OccluderTopology> topology_;
};

/// The triangles of many objects, laid out to be asked for frame after frame: what their boxes and spheres
/// leave, OcclusionBuffer::may_see(const OccludeeTriangles&, …) tests triangle by triangle. Objects are
/// numbered 0 … objects() - 1. Holds 576 bytes for every 16 triangles begun of an object. assign() and set()
/// are for one thread while nobody asks.
class OccludeeTriangles {
public:
  OccludeeTriangles();
  ~OccludeeTriangles();
  OccludeeTriangles(OccludeeTriangles&&) noexcept;
  OccludeeTriangles& operator=(OccludeeTriangles&&) noexcept;

  /// Takes all objects anew: of object o the next triangles_per_object[o] triangles of `corners`, three
  /// finite points each, about the origin of the views that will ask. Refuses, and stays as it is, where
  /// corners.size() is not three times the sum. Costs a copy of the corners; allocates.
  Check assign(std::span<const Vec3> corners, std::span<const std::uint32_t> triangles_per_object);
  /// Gives one object, which has moved, new corners. Refuses, and stays as it is, where there is no such
  /// object or corners.size() is not 3 · triangles(object). Costs a copy; allocates nothing but a refusal.
  Check set(std::uint32_t object, std::span<const Vec3> corners);

  [[nodiscard]] std::uint32_t objects() const noexcept;
  /// 0 where there is no such object.
  [[nodiscard]] std::uint32_t triangles(std::uint32_t object) const noexcept;

private:
  friend class OcclusionBuffer;
  [[nodiscard]] std::span<const occlusion::TriangleBlock> blocks(std::uint32_t object) const noexcept;

  std::vector<occlusion::TriangleBlock> blocks_;  // object by object
  std::vector<std::uint32_t> first_block_;        // one an object, and the end
  std::vector<std::uint32_t> triangles_;
};

/// One view's depth of occluders. Drawing is for one thread, queries for many at once.
class OcclusionBuffer {
public:
  OcclusionBuffer();
  ~OcclusionBuffer();
  OcclusionBuffer(OcclusionBuffer&&) noexcept;
  OcclusionBuffer& operator=(OcclusionBuffer&&) noexcept;

  /// Empties the buffer and takes the view. Allocates where the view is larger than any before. Refuses a
  /// view that culling refuses, and one larger than 8192 pixels a side.
  Check begin(const WorldView& view);

  /// Draws solid boxes, relative to the view's origin; every point inside a box must be solid. Invalid ones
  /// are skipped. Front to back is fastest; the result does not depend on the order.
  void draw_boxes(std::span<const Box> boxes) noexcept;
  void draw_boxes(std::span<const WorldBox> boxes) noexcept;
  /// Draws solid spheres, relative to the view's origin; every point inside a sphere must be solid. Cheaper
  /// than anything else that fills as much of the image. Spheres that reach behind the near plane are left
  /// out; leave out yourself those of things that do, for there the inside is seen.
  void draw_spheres(std::span<const Sphere> spheres) noexcept;
  /// Draws the mesh moved by `transform`, relative to the view's origin. Allocates until it has seen its
  /// largest mesh.
  void draw_mesh(const OccluderMesh& mesh, const Affine& transform);

  /// Whether some pixel centre may see the box, relative to the view's origin. False is certain.
  [[nodiscard]] bool may_see(const Box& box) const noexcept;
  /// The same for many: visible[i] is 1 or 0. The arrays need no padding.
  void may_see(const BoxSpan& boxes, std::span<std::uint8_t> visible) const noexcept;
  /// The same for boxes relative to another origin.
  void may_see(const BoxSpan& boxes, const WorldPoint& origin,
               std::span<std::uint8_t> visible) const noexcept;

  /// Whether some pixel centre may see each sphere, relative to the view's origin; 1 or 0. Of a thing whose
  /// box and sphere are both known, both must say so.
  void may_see(const SphereSpan& spheres, std::span<std::uint8_t> visible) const noexcept;

  /// Whether some pixel centre may see one of the triangles, three corners each, relative to the view's
  /// origin: pixel by pixel, so closer to the truth than a box, and dearer. False is certain.
  [[nodiscard]] bool may_see(std::span<const Vec3> triangles) const noexcept;
  /// The same of one object's triangles; true where there is no such object, false where it has none. As
  /// dear as its triangles are many, until one is seen. Allocates nothing.
  [[nodiscard]] bool may_see(const OccludeeTriangles& triangles, std::uint32_t object) const noexcept;
  /// The same of many objects: keeps in front, in order, those of `objects` that may be seen, and returns how
  /// many; what stands behind them is undefined. Faster than one by one, for the next ones' triangles are
  /// fetched meanwhile. Allocates nothing.
  std::size_t keep_seen(const OccludeeTriangles& triangles, std::span<std::uint32_t> objects) const noexcept;

  [[nodiscard]] std::uint32_t width() const noexcept;
  [[nodiscard]] std::uint32_t height() const noexcept;
  /// 1 / (depth along the view) of the occluder at a pixel (perspective), -depth (orthographic), -infinity
  /// where there is none. Pixels row by row, width × height.
  void read_nearness(std::span<float> pixels) const noexcept;

  [[nodiscard]] const occlusion::DepthTiles& tiles() const noexcept { return *tiles_; }

private:
  std::unique_ptr<occlusion::DepthTiles> tiles_;
};

}  // namespace sightline
