// Flat culling of arrays by a view frustum.
#include <sightline/frustum.hpp>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

// What cull(things, visible) writes into an array with room for it.
template <class Cull, class View>
py::object indices_of(const Frustum& frustum, const View& things, Cull cull) {
  py::array_t<std::uint32_t> visible = new_array<std::uint32_t>(things.size() + kCullPadding);
  const std::span<std::uint32_t> out = span_of(visible);
  const Result<std::size_t> count = [&] {
    const Unlocked unlocked;
    return cull(frustum, things, out);
  }();
  return first_of(visible, expect(count));
}

py::object boxes_in(const Frustum& frustum, const py::object& boxes) {
  const Boxes given = boxes_of(boxes);
  return indices_of(frustum, given.view, &cull_boxes);
}
py::object spheres_in(const Frustum& frustum, const py::object& spheres) {
  const Spheres given = spheres_of(spheres);
  return indices_of(frustum, given.view, &cull_spheres);
}

py::array_t<float> planes_of(const Frustum& frustum) {
  static_assert(sizeof(Plane) == 4 * sizeof(float));
  return py::array_t<float>({6, 4}, &frustum.planes[0].normal.x);
}

}  // namespace

void add_frustum(py::module_& m) {
  py::class_<Frustum>(m, "Frustum", "A view's frustum, for culling arrays without a World.")
      .def(py::init([](const WorldView& view) { return make_frustum(view); }),
           "Its planes are moved outwards by the rounding error of a test.", py::arg("view"))
      .def_property_readonly(
          "planes", &planes_of,
          "float32 (6, 4): left, right, bottom, top, near, far; inward normal and distance.")
      .def("cull_boxes", &boxes_in, "The indices of the boxes that overlap it, uint32 (k,), ascending.",
           py::arg("boxes"))
      .def("cull_spheres", &spheres_in, "The same of spheres, about the view's origin.", py::arg("spheres"));
}

}  // namespace sightline::python
