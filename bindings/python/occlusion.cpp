// Occluders, occludees, and the depth of one view.
#include <sightline/occlusion.hpp>

#include <algorithm>
#include <optional>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

using SharedTriangles = Guarded<OccludeeTriangles>;

OccluderMesh make_mesh(const py::object& positions, const py::object& indices, const py::object& sides) {
  const std::vector<Vec3> points = points_of(positions, "positions");
  const std::vector<std::uint32_t> corners = numbers_of(indices, "indices");
  const std::vector<Sides> drawn = sides_of(sides);
  return expect([&] {
    const Unlocked unlocked;
    return OccluderMesh::make(points, corners, drawn);
  }());
}

Occluder make(const py::object& positions, const py::object& indices, const py::object& sides,
              const py::object& most_triangles, const py::object& most_boxes) {
  const std::vector<Vec3> points = points_of(positions, "positions");
  const std::vector<std::uint32_t> corners = numbers_of(indices, "indices");
  const std::vector<Sides> drawn = sides_of(sides);
  const std::uint32_t triangles = whole_number_of(most_triangles, "most_triangles"),
                      boxes = whole_number_of(most_boxes, "most_boxes");
  return expect([&] {
    const Unlocked unlocked;
    return make_occluder(points, corners, drawn, {triangles, boxes});
  }());
}

// A copy of numbers as an array of that shape.
template <class T>
py::array_t<T> copied(const T* first, std::vector<py::ssize_t> shape) {
  return py::array_t<T>(std::move(shape), first);
}
py::ssize_t length(std::size_t count) {
  return static_cast<py::ssize_t>(count);
}

void assign(SharedTriangles& triangles, const py::object& corners, const py::object& per_object) {
  const std::vector<Vec3> points = points_of(corners, "corners");
  const std::vector<std::uint32_t> counts = numbers_of(per_object, "triangles_per_object");
  expect(changing_unlocked(triangles, [&](OccludeeTriangles& t) { return t.assign(points, counts); }));
}

void set(SharedTriangles& triangles, const py::object& object, const py::object& corners) {
  const std::uint32_t which = whole_number_of(object, "object");
  const std::vector<Vec3> points = points_of(corners, "corners");
  expect(changing_unlocked(triangles, [&](OccludeeTriangles& t) { return t.set(which, points); }));
}

void begin(Occlusion& occlusion, const WorldView& view, const std::string& coverage,
           const py::object& scale) {
  const OcclusionOptions options = occlusion_options(coverage, scale);
  expect(changing_unlocked(occlusion, [&](OcclusionBuffer& b) { return b.begin(view, options); }));
}

// Drawing checks the caller's arrays and then relies on them, so it keeps the interpreter's lock.
void draw_boxes(Occlusion& occlusion, const py::object& boxes) {
  const Boxes given = boxes_of(boxes);
  expect(changing(occlusion, [&](OcclusionBuffer& b) { return b.draw_boxes(given.view); }));
}

void draw_spheres(Occlusion& occlusion, const py::object& spheres) {
  const Spheres given = spheres_of(spheres);
  expect(changing(occlusion, [&](OcclusionBuffer& b) { return b.draw_spheres(given.view); }));
}

void draw_mesh(Occlusion& occlusion, const OccluderMesh& mesh, const py::object& transform) {
  const Mat4 matrix = transform.is_none() ? Mat4{} : matrix_of(transform, "transform");
  expect(changing_unlocked(occlusion, [&](OcclusionBuffer& b) { return b.draw_mesh(mesh, matrix); }));
}

// bool (n,) of what the library writes as bytes.
template <class View>
py::object may_see(const Occlusion& occlusion, const View& things) {
  py::array_t<std::uint8_t> visible = new_array<std::uint8_t>(things.size());
  const std::span<std::uint8_t> out = span_of(visible);
  expect(looking_unlocked(occlusion, [&](const OcclusionBuffer& b) { return b.may_see(things, out); }));
  return visible.attr("view")("bool");
}

py::object may_see_boxes(const Occlusion& occlusion, const py::object& boxes) {
  const Boxes given = boxes_of(boxes);
  return may_see(occlusion, given.view);
}
py::object may_see_spheres(const Occlusion& occlusion, const py::object& spheres) {
  const Spheres given = spheres_of(spheres);
  return may_see(occlusion, given.view);
}

bool may_see_triangles(const Occlusion& occlusion, const py::object& corners) {
  const std::vector<Vec3> points = points_of(corners, "corners");
  return looking_unlocked(occlusion,
                          [&](const OcclusionBuffer& b) { return b.may_see(std::span<const Vec3>(points)); });
}

py::object keep_seen(const Occlusion& occlusion, const SharedTriangles& triangles,
                     const py::object& objects) {
  const std::vector<std::uint32_t> given = numbers_of(objects, "objects");
  py::array_t<std::uint32_t> kept = new_array<std::uint32_t>(given.size());
  const std::span<std::uint32_t> out = span_of(kept);
  std::copy(given.begin(), given.end(), out.begin());
  const std::size_t count = looking_unlocked(occlusion, [&](const OcclusionBuffer& depths) {
    return looking(triangles, [&](const OccludeeTriangles& t) { return depths.keep_seen(t, out); });
  });
  return first_of(kept, count);
}

py::array_t<float> read_nearness(const Occlusion& occlusion) {
  const View view = looking(occlusion, [](const OcclusionBuffer& b) { return b.view().view; });
  py::array_t<float> pixels({py::ssize_t{view.height}, py::ssize_t{view.width}});
  const std::span<float> out = span_of(pixels);
  expect(looking_unlocked(occlusion, [&](const OcclusionBuffer& b) { return b.read_nearness(out); }));
  return pixels;
}

py::object begun_view(const Occlusion& occlusion) {
  const auto view = looking(
      occlusion, [](const OcclusionBuffer& b) { return b.begun() ? std::optional(b.view()) : std::nullopt; });
  return view ? py::cast(*view) : py::none();
}

std::uint32_t triangles_of(const SharedTriangles& triangles, const py::object& object) {
  const std::uint32_t which = whole_number_of(object, "object");
  return looking(triangles, [&](const OccludeeTriangles& t) { return t.triangles(which); });
}
std::uint32_t objects_of(const SharedTriangles& triangles) {
  return looking(triangles, [](const OccludeeTriangles& t) { return t.objects(); });
}

void add_occluder(py::module_& m) {
  py::class_<Occluder>(
      m, "Occluder",
      "What occludes in a mesh's place, made of any mesh, closed or not: flat pieces merged, and of closed\n"
      "parts what lies inside them. It covers no point that the mesh does not cover as near.")
      .def(py::init(&make),
           "The mesh as OccluderMesh takes it; at most 4096 triangles and boxes, 0 for none.",
           py::arg("positions"), py::arg("indices"), py::arg("sides") = "both",
           py::arg("most_triangles") = 64, py::arg("most_boxes") = 8)
      .def(
          "mesh",
          [](const Occluder& o) { return expect(OccluderMesh::make(o.positions, o.indices, o.sides)); },
          "Its triangles, ready to be drawn.")
      .def_property_readonly(
          "positions",
          [](const Occluder& o) {
            return copied(&o.positions.data()->x, {length(o.positions.size()), 3});
          },
          "float32 (n, 3)")
      .def_property_readonly(
          "indices",
          [](const Occluder& o) {
            return copied(o.indices.data(), {length(o.sides.size()), 3});
          },
          "uint32 (m, 3)")
      .def_property_readonly(
          "front_only",
          [](const Occluder& o) {
            py::array_t<bool> out(length(o.sides.size()));
            std::ranges::transform(o.sides, out.mutable_data(), [](Sides s) { return s == Sides::front; });
            return out;
          },
          "bool (m,): whether only the triangle's front occludes")
      .def_readonly(
          "solid_triangles", &Occluder::solid_triangles,
          "So many triangles, the first, lie inside the mesh: for eyes and near planes outside of it.")
      .def_property_readonly(
          "boxes",
          [](const Occluder& o) {
            return copied(&o.boxes.data()->min.x, {length(o.boxes.size()), 2, 3});
          },
          "float32 (k, 2, 3): solid boxes inside the mesh, for the same eyes")
      .def_property_readonly(
          "yields", [](const Occluder& o) { return to_string(o.yield); },
          "A sentence: what was found, and why nothing was.");
}

void add_triangles(py::module_& m) {
  py::class_<OccluderMesh>(m, "OccluderMesh",
                           "Triangles that occlude: what can be looked through must not be among them.")
      .def(
          py::init(&make_mesh),
          "positions: float32 (n, 3), metres; indices: uint32, (m, 3) or flat; sides: 'both', 'front', from\n"
          "where corners turn counter-clockwise, or (m,) whether only a triangle's front is drawn and so\n"
          "occludes. Refused: positions that are not finite, indices that are out of range or no multiple\n"
          "of three, another number of sides.",
          py::arg("positions"), py::arg("indices"), py::arg("sides") = "both")
      .def_property_readonly("triangles", &OccluderMesh::triangles);

  add_occluder(m);
  py::class_<SharedTriangles>(m, "OccludeeTriangles",
                              "The triangles of many objects, laid out to be asked for frame after frame.")
      .def(py::init<>())
      .def("assign", &assign,
           "Takes all objects anew: of object o the next triangles_per_object[o] of the triangles whose\n"
           "corners are float32 (..., 3), about the origin of the views that will ask.",
           py::arg("corners"), py::arg("triangles_per_object"))
      .def("set", &set, "Gives one object, which has moved, new corners, as many as before.",
           py::arg("object"), py::arg("corners"))
      .def("triangles", &triangles_of, "Of one object; 0 where there is no such object.", py::arg("object"))
      .def("__len__", &objects_of);
}

}  // namespace

OcclusionOptions occlusion_options(const std::string& coverage, const py::object& scale) {
  if (coverage != "centres" && coverage != "area") refuse("coverage: expected 'centres' or 'area'");
  return {coverage == "area" ? Coverage::area : Coverage::centres, whole_number_of(scale, "scale")};
}

void add_occlusion(py::module_& m) {
  add_triangles(m);
  py::class_<Occlusion, std::shared_ptr<Occlusion>>(
      m, "Occlusion",
      "One view's depth of occluders: begin it with a view, draw, ask. It answers for that view alone.\n"
      "Boxes are as World has them; spheres a SphereView or float32 (n, 4). Spheres, meshes and triangles\n"
      "are in metres about the view's origin. Refused: drawing and reading before begin().")
      .def(py::init<>())
      .def("begin", &begin,
           "Empties it and takes the view, of at most 8192 pixels a side. It answers for any place on\n"
           "the image ('area'), or for pixel 'centres' alone, in pixels 1, 2 or 4 times as wide as the "
           "view's.",
           py::arg("view"), py::arg("coverage") = "area", py::arg("scale") = 1)
      .def_property_readonly("view", &begun_view, "The view it was begun with, or None.")
      .def("draw_boxes", &draw_boxes,
           "Draws solid boxes: every point inside one must be solid. Those that are not valid or reach\n"
           "farther than 1e11 m from the eye are left out.",
           py::arg("boxes"))
      .def("draw_spheres", &draw_spheres,
           "Draws solid spheres. Those that are not valid or reach behind the near plane are left out.",
           py::arg("spheres"))
      .def("draw_mesh", &draw_mesh, "Draws a mesh moved by an affine matrix (4, 4), or where it stands.",
           py::arg("mesh"), py::arg("transform") = py::none())
      .def("may_see_boxes", &may_see_boxes,
           "bool (n,): whether some place on the image may see the box; False is certain. All True before\n"
           "begin().",
           py::arg("boxes"))
      .def("may_see_spheres", &may_see_spheres, "The same of spheres.", py::arg("spheres"))
      .def("may_see_triangles", &may_see_triangles,
           "Whether some place on the image may see one of the triangles; corners are float32 (..., 3).",
           py::arg("corners"))
      .def("keep_seen", &keep_seen,
           "Those of `objects`, uint32 (n,), of which a triangle may be seen, in order.",
           py::arg("triangles"), py::arg("objects"))
      .def("read_nearness", &read_nearness,
           "float32 (height, width): 1 / (depth in metres) of the occluder at each pixel (perspective),\n"
           "-depth (orthographic), -inf where there is none; rows from the top.");
}

}  // namespace sightline::python
