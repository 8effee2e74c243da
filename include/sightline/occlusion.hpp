// Occlusion on the CPU, with no GPU: occluders are rasterised into a tiled hierarchical depth buffer, then
// boxes are tested against it. After masked software occlusion culling (Hasselgren, Andersson &
// Akenine-Möller 2016), but with a depth a pixel, and conservative: an occluder counts at a pixel only where
// it surely covers all of it, with a depth that surely is nowhere nearer than its own; a box is hidden only
// where its nearest depth lies behind every pixel that its outward-rounded rectangle touches. Where centres
// are asked for, the same is said of pixels' centres in place of whole ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/box_view.hpp>
#include <sightline/jobs.hpp>
#include <sightline/occluder.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

/// Which places on the image an OcclusionBuffer answers for.
enum class Coverage : std::uint8_t {
  /// Pixel centres alone, where a rasteriser takes its one sample: for who draws the view's own pixels
  /// without multisampling, jitter or upscaling. Hides more, and meshes cost about half as much to draw.
  centres,
  /// Any place on the image: multisampling, jitter, upscaling, another renderer's pixels. An occluder counts
  /// only in pixels that it covers whole. Triangles of a mesh that share an edge cover a pixel together, but
  /// those that are less than half a pixel wide count as missing.
  area,
};

/// How fine and for which places an OcclusionBuffer answers.
struct OcclusionOptions {
  Coverage coverage = Coverage::area;  ///< which places are answered for
  /// Pixels of the view along a side of one of the buffer's: 1, 2 (half resolution) or 4. Coarser has fewer
  /// tiles and hides less, and meshes are slower to draw; what is promised stays the same.
  std::uint32_t scale = 1;
  /// Whether both say the same.
  bool operator==(const OcclusionOptions&) const noexcept = default;
};

/// The triangles of many objects, laid out to be asked for frame after frame: what their boxes and spheres
/// leave, OcclusionBuffer::may_see(const OccludeeTriangles&, …) tests triangle by triangle. Objects are
/// numbered 0 … objects() - 1. Holds 144 bytes for every four triangles begun of an object.
///
/// A refused call changes nothing. What was moved from may only be destroyed or assigned to. Unless a
/// function says otherwise: Errors: none. Cost: constant. Threads: many may read while nobody changes it.
/// Allocates: nothing.
class OccludeeTriangles {
public:
  /// Without an object.
  OccludeeTriangles();
  ~OccludeeTriangles();
  OccludeeTriangles(OccludeeTriangles&&) noexcept;
  OccludeeTriangles& operator=(OccludeeTriangles&&) noexcept;

  /// Takes all objects anew: of object o the next triangles_per_object[o] triangles of `corners`, three
  /// points each in metres, about the origin of the views that will ask. A triangle with a corner that is not
  /// finite is always seen. `sides` has one entry an object, or one for all of them; without any, both sides
  /// may be seen. Of Sides::front a triangle is never seen from behind, which is the cheapest answer of all,
  /// and the only one for surfaces that meet an outline from behind. Errors: bad_mesh where corners.size() is
  /// not three times the sum, and for another number of sides; bad_argument for sides that are none (index():
  /// which entry); too_many beyond 2³² - 2 objects or blocks. Cost: a copy of the corners. Allocates: for all
  /// objects.
  Status assign(std::span<const Vec3> corners, std::span<const std::uint32_t> triangles_per_object,
                std::span<const Sides> sides = {});
  /// Gives one object, which has moved, new corners: 3 · triangles(object) of them. Its sides stay.
  /// Errors: bad_argument where there is no such object; bad_mesh for another number of corners. Cost: a
  /// copy.
  Status set(std::uint32_t object, std::span<const Vec3> corners);

  /// How many objects there are.
  [[nodiscard]] std::uint32_t objects() const noexcept;
  /// 0 where there is no such object.
  [[nodiscard]] std::uint32_t triangles(std::uint32_t object) const noexcept;

private:
  friend class OcclusionBuffer;
  struct State;
  State* state_;
};

/// One view's depth of occluders. Begin it with a view, draw occluders, ask. What is said of places on
/// the image holds for pixel centres alone where it was begun for those (Coverage::centres). It answers for
/// that view alone: Culler refuses it beside any other. Before the first begin() nothing can be drawn and all
/// may be seen.
///
/// A BoxView says itself where its boxes stand: doubles, or floats about its own origin, which is fastest
/// where it is the view's. All else is in metres about the view's origin.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: drawing is for one, asking for many at once while nobody draws. Allocates:
/// nothing.
class OcclusionBuffer {
public:
  /// Allocates: a little.
  OcclusionBuffer();
  ~OcclusionBuffer();
  OcclusionBuffer(OcclusionBuffer&&) noexcept;
  OcclusionBuffer& operator=(OcclusionBuffer&&) noexcept;

  /// Empties the buffer and takes the view. After a refusal it is as before.
  /// Errors: bad_view for a view that culling refuses, and one of more than 8192 pixels a side; bad_argument
  /// for options that are none. Cost: grows with the image's tiles of 8 × 8 pixels. Allocates: 4 bytes a
  /// pixel and 24 a tile, where the image is larger than any before.
  Status begin(const WorldView& view, const OcclusionOptions& options = {});
  /// The view it was begun with; 1 × 1 pixels wide before.
  [[nodiscard]] const WorldView& view() const noexcept;
  /// What it was begun with.
  [[nodiscard]] const OcclusionOptions& options() const noexcept;
  /// Whether begin() has succeeded.
  [[nodiscard]] bool begun() const noexcept;

  /// Draws solid boxes, rounded inwards; every point inside a box must be solid. Boxes that are not valid,
  /// reach farther than kWorldReach from the eye or have no inside are left out. Front to back is fastest;
  /// the result does not depend on the order. Errors: stale_buffer before begin(); bad_argument for boxes
  /// that are not sound. Cost: linear, 20 ns a box and 1 ns a tile it covers.
  Status draw_boxes(const BoxView& boxes) noexcept;
  /// Draws solid spheres; every point inside a sphere must be solid. Cheaper than anything else that fills as
  /// much of the image. Spheres that are not valid or reach behind the near plane are left out. Leave out,
  /// too, those of things that reach behind it, as their inside shows. Errors, Cost: as draw_boxes.
  Status draw_spheres(const SphereView& spheres) noexcept;
  /// Draws the mesh moved by `transform`, an affine matrix (its last row is 0, 0, 0, 1), seen from where it
  /// stands before it is moved: no corner is rounded. A transform that flattens the mesh, or skews it much
  /// (turned, then scaled to less than a tenth along one axis), draws nothing. The caller's jobs draw bands
  /// of the image at once, to the same bits; bands take about the same time each where the mesh looks much as
  /// it did when it was last drawn into this buffer. Errors: stale_buffer before begin(); bad_argument for a
  /// transform that is not finite or not affine. Cost: linear in the triangles in view, 10 to 20 ns each and
  /// 1 ns a tile. Allocates: until it has seen its largest mesh and image, for each job.
  Status draw_mesh(const OccluderMesh& mesh, const Mat4& transform = {}, const JobSystem& jobs = {});

  /// Whether some place on the image may see the box, about the view's origin. False is certain; of a box
  /// that is not finite, true. Cost: 30 ns.
  [[nodiscard]] bool may_see(const Box& box) const noexcept;
  /// The same for many: visible[i] is 1 or 0, for as many as there are boxes.
  /// Errors: bad_argument for boxes that are not sound; buffer_too_small. Cost: linear, some 10 ns a box; an
  /// array a coordinate (BoxView::arrays) costs least.
  Status may_see(const BoxView& boxes, std::span<std::uint8_t> visible) const noexcept;
  /// Whether some place on the image may see each sphere. A thing whose box and sphere are both known may be
  /// seen only if both may. Errors, Cost: the same.
  Status may_see(const SphereView& spheres, std::span<std::uint8_t> visible) const noexcept;

  /// Whether some place on the image may see one of the triangles, three corners each: pixel by pixel, so
  /// closer to the truth than a box, and dearer. False is certain. A triangle of whose corners two are equal
  /// shows nothing, any other with a corner that is not finite is seen; corners that make no whole triangle
  /// are not looked at. Cost: linear until one is seen.
  [[nodiscard]] bool may_see(std::span<const Vec3> triangles) const noexcept;
  /// The same of one object's triangles; true where there is no such object, false where it has none. Cost:
  /// linear until one is seen.
  [[nodiscard]] bool may_see(const OccludeeTriangles& triangles, std::uint32_t object) const noexcept;
  /// The same of many objects: keeps in front, in order, those of `objects` that may be seen, and returns how
  /// many; what stands behind them is undefined. Cost: faster than one by one, for the next ones' triangles
  /// are fetched meanwhile.
  [[nodiscard]] std::size_t keep_seen(const OccludeeTriangles& triangles,
                                      std::span<std::uint32_t> objects) const noexcept;

  /// Writes 1 / (depth along the view in metres) of the occluder at each pixel (perspective), -depth
  /// (orthographic), -infinity where there is none: row by row from the top, width × height of the view.
  /// Errors: stale_buffer before begin(); buffer_too_small. Cost: linear in the pixels.
  Status read_nearness(std::span<float> pixels) const noexcept;

private:
  friend struct OcclusionAccess;
  struct State;
  State* state_;
};

}  // namespace sightline
