// What rays meet first.
#include <sightline/rays.hpp>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

using LockedBvh = Guarded<BoxBvh>;

void build(LockedBvh& bvh, const py::object& boxes, const py::object& origin) {
  const Boxes given = boxes_of(boxes);
  const WorldPoint about = world_point_of(origin, "origin");
  expect(changing_unlocked(bvh, [&](BoxBvh& b) { return b.build(given.view, about); }));
}

void refit(LockedBvh& bvh, const py::object& boxes) {
  const Boxes given = boxes_of(boxes);
  expect(changing_unlocked(bvh, [&](BoxBvh& b) { return b.refit(given.view); }));
}

std::vector<Ray> rays_of(const py::object& origins, const py::object& directions, const py::object& longest) {
  const std::vector<Vec3> from = points_of(origins, "origins"), along = points_of(directions, "directions");
  if (from.size() != along.size()) refuse("cast: expected as many directions as origins");
  std::vector<Ray> rays(from.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].origin = from[i], rays[i].direction = along[i];
  if (longest.is_none()) return rays;
  using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
  const auto given = made_of<Floats>(longest, "max_distances: expected a number or float32 of shape (n,)");
  const auto count = static_cast<std::size_t>(given.size());
  if (given.ndim() > 0 && count != rays.size()) refuse("max_distances: expected one a ray, or one for all");
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].max_distance = given.data()[given.ndim() > 0 ? i : 0];
  return rays;
}

py::tuple cast(LockedBvh& bvh, const py::object& origins, const py::object& directions,
               const py::object& max_distances) {
  const std::vector<Ray> rays = rays_of(origins, directions, max_distances);
  py::array_t<std::uint32_t> objects = new_array<std::uint32_t>(rays.size());
  py::array_t<float> distances = new_array<float>(rays.size());
  const std::span<std::uint32_t> met = span_of(objects);
  const std::span<float> far = span_of(distances);
  expect(changing_unlocked(bvh, [&](BoxBvh& b) { return b.cast(rays, met, far); }));
  return py::make_tuple(objects, distances);
}

py::object visible_set(LockedBvh& bvh, const WorldView& view, const py::object& columns,
                       const py::object& rows) {
  const std::uint32_t across = whole_number_of(columns, "columns"), down = whole_number_of(rows, "rows");
  std::vector<std::uint32_t> visible;
  const std::size_t count = expect(changing_unlocked(bvh, [&](BoxBvh& b) {
    visible.resize(b.size());
    return b.visible_set(view, across, down, visible);
  }));
  return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(count), visible.data());
}

}  // namespace

void add_rays(py::module_& m) {
  py::class_<LockedBvh>(m, "BoxBvh", "Boxes, as World has them, to cast rays at.")
      .def(py::init<>())
      .def("build", &build,
           "Takes the boxes, rounded outwards to single precision about `origin`. Refused: boxes that are\n"
           "not min <= max or out of reach.",
           py::arg("boxes"), py::arg("origin") = py::make_tuple(0, 0, 0))
      .def("refit", &refit, "Takes over moved boxes, as many as were built with.", py::arg("boxes"))
      .def("__len__",
           [](const LockedBvh& bvh) { return looking(bvh, [](const BoxBvh& b) { return b.size(); }); })
      .def("cast", &cast,
           "(objects, distances) of n rays: the box that each meets first, uint32 (n,), NO_OBJECT for none,\n"
           "and how far along, float32 (n,), in units of its direction, -1 for none. origins, directions:\n"
           "float32 (n, 3), metres about the boxes' origin; max_distances: one a ray, one for all, or None.",
           py::arg("origins"), py::arg("directions"), py::arg("max_distances") = py::none())
      .def("visible_set", &visible_set,
           "The boxes that at least one of columns x rows rays through the view's image meets first, uint32\n"
           "(k,), ascending: an approximation of what is visible. The view's origin is the boxes'.\n"
           "Refused: another, no rays, or more than 2^24.",
           py::arg("view"), py::arg("columns"), py::arg("rows"));
}

}  // namespace sightline::python
