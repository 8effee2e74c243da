// Views: of boxes and spheres in arrays, and of cameras.
#include <tuple>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

// Three numbers a row, one array beside another: where they start, and their one stride.
template <class T>
struct Pair {
  const T *first, *second;
  std::size_t stride, count;
};

template <class T>
bool is_rows(const py::object& given, py::ssize_t columns) {
  if (!py::isinstance<py::array_t<T>>(given)) return false;
  const auto array = py::reinterpret_borrow<py::array>(given);
  if (columns == 1) return array.ndim() == 1;
  return array.ndim() == 2 && array.shape(1) == columns &&
         (array.strides(1) == sizeof(T) || array.size() == 0);
}

template <class T>
Pair<T> pair_of(const py::array& first, const py::array& second, py::ssize_t columns, const char* what) {
  const auto count = first.shape(0);
  if (second.shape(0) != count || (count > 1 && first.strides(0) != second.strides(0)))
    refuse(std::string(what) + ", both of one length and one stride");
  if (count > 1 && first.strides(0) < 0)
    refuse(std::string(what) + " in ascending order in memory, got a negative stride");
  const auto natural = sizeof(T) * static_cast<std::size_t>(columns);
  return {static_cast<const T*>(first.data()), static_cast<const T*>(second.data()),
          count > 1 ? static_cast<std::size_t>(first.strides(0)) : natural, static_cast<std::size_t>(count)};
}

// Minimum and maximum, or centre and half size, as a BoxView's static function wants them.
template <class Float, class Double>
Boxes boxes_of_pair(const py::object& first, const py::object& second, const py::object& origin,
                    const char* what, Float of_floats, Double of_doubles) {
  const auto a = py::reinterpret_borrow<py::array>(first), b = py::reinterpret_borrow<py::array>(second);
  if (is_rows<float>(first, 3) && is_rows<float>(second, 3)) {
    const auto p = pair_of<float>(a, b, 3, what);
    const WorldPoint about = origin.is_none() ? WorldPoint{} : world_point_of(origin, "origin");
    return {of_floats(p.first, p.second, p.stride, p.count, about), {first, second}};
  }
  if (!is_rows<double>(first, 3) || !is_rows<double>(second, 3)) refuse(what);
  if (!origin.is_none()) refuse("origin: only boxes in float32 have one");
  const auto p = pair_of<double>(a, b, 3, what);
  return {of_doubles(p.first, p.second, p.stride, p.count), {first, second}};
}

Boxes min_max(const py::object& boxes, const py::object& maximum, const py::object& origin) {
  if (!maximum.is_none()) {
    const auto of = [](auto... given) { return BoxView::min_max(given...); };
    return boxes_of_pair(boxes, maximum, origin,
                         "boxes: expected minimum and maximum, float32 or float64 of shape (n, 3)", of, of);
  }
  const Boxes whole = boxes_of(boxes);
  if (origin.is_none()) return whole;
  // The others have one already, or do not say what their arrays are.
  if (whole.arrays.size() != 1)
    refuse("origin: expected an array or two of boxes beside it, got a BoxView of several arrays");
  if (!py::isinstance<py::array_t<float>>(whole.arrays[0])) refuse("origin: only boxes in float32 have one");
  const auto all = py::reinterpret_borrow<py::array>(whole.arrays[0]);
  const auto part = [&](int index) -> py::object {
    if (all.ndim() == 3) return all[py::make_tuple(py::slice(py::none(), py::none(), py::none()), index)];
    return all[py::make_tuple(py::slice(py::none(), py::none(), py::none()),
                              py::slice(3 * index, 3 * index + 3, 1))];
  };
  return min_max(part(0), part(1), origin);
}

Boxes centre_half(const py::object& centre, const py::object& half, const py::object& origin) {
  const auto of = [](auto... given) { return BoxView::centre_half(given...); };
  return boxes_of_pair(centre, half, origin,
                       "boxes: expected centre and half size, float32 or float64 of shape (n, 3)", of, of);
}

// Arrays of one coordinate each, side by side in memory, of one length.
template <std::size_t count>
std::size_t check_coordinates(const py::object (&arrays)[count], const float* (&first)[count]) {
  py::ssize_t length = -1;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_rows<float>(arrays[i], 1)) refuse("arrays: expected float32 of shape (n,)");
    const auto array = py::reinterpret_borrow<py::array>(arrays[i]);
    if (length < 0) length = array.shape(0);
    if (array.shape(0) != length || (length > 1 && array.strides(0) != sizeof(float)))
      refuse("arrays: expected contiguous ones of one length");
    first[i] = static_cast<const float*>(array.data());
  }
  return static_cast<std::size_t>(length);
}

Boxes box_arrays(const py::object& min_x, const py::object& min_y, const py::object& min_z,
                 const py::object& max_x, const py::object& max_y, const py::object& max_z) {
  const py::object arrays[] = {min_x, min_y, min_z, max_x, max_y, max_z};
  const float* first[6];
  const std::size_t count = check_coordinates(arrays, first);
  return {BoxView::arrays(first[0], first[1], first[2], first[3], first[4], first[5], count),
          {std::begin(arrays), std::end(arrays)}};
}

Spheres sphere_arrays(const py::object& x, const py::object& y, const py::object& z,
                      const py::object& radius) {
  const py::object arrays[] = {x, y, z, radius};
  const float* first[4];
  const std::size_t count = check_coordinates(arrays, first);
  return {SphereView::arrays(first[0], first[1], first[2], first[3], count),
          {std::begin(arrays), std::end(arrays)}};
}

Spheres spheres(const py::object& centre, const py::object& radius) {
  if (radius.is_none()) return spheres_of(centre);
  constexpr const char* what = "spheres: expected centres and radii, float32 of shape (n, 3) and (n,)";
  if (!is_rows<float>(centre, 3) || !is_rows<float>(radius, 1)) refuse(what);
  const auto a = py::reinterpret_borrow<py::array>(centre), b = py::reinterpret_borrow<py::array>(radius);
  const auto p = pair_of<float>(a, b, 3, what);
  return {SphereView(p.first, p.second, p.stride, p.count), {centre, radius}};
}

std::uint32_t pixels(long long given) {
  return given < 0 || given > 0xffffffffll ? 0 : static_cast<std::uint32_t>(given);  // 0 is refused
}

WorldView view(const py::object& world_to_eye, const py::object& eye_to_clip, long long width,
               long long height, const py::object& origin) {
  WorldView made{{matrix_of(world_to_eye, "world_to_eye"), matrix_of(eye_to_clip, "eye_to_clip"),
                  pixels(width), pixels(height)},
                 world_point_of(origin, "origin")};
  expect(check(made));
  return made;
}

WorldView camera(const py::object& eye, const py::object& forward, const py::object& up, double fov,
                 double near, double far, long long width, long long height, double orthographic_height,
                 const py::object& shift, bool reversed_depth, const py::object& origin) {
  const auto vector = [](const WorldPoint& p) {
    return Vec3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  const WorldPoint from = world_point_of(eye, "eye"), about = world_point_of(origin, "origin");
  Camera camera;
  camera.eye = vector({from.x - about.x, from.y - about.y, from.z - about.z});
  camera.forward = vector(world_point_of(forward, "forward"));
  camera.up = vector(world_point_of(up, "up"));
  camera.vertical_fov = static_cast<float>(fov);
  camera.orthographic_height = static_cast<float>(orthographic_height);
  camera.near_plane = static_cast<float>(near), camera.far_plane = static_cast<float>(far);
  std::tie(camera.shift_x, camera.shift_y) = two_numbers_of(shift, "shift");
  camera.depth = reversed_depth ? Depth::reversed : Depth::standard;
  const WorldView made{expect(make_view(camera, pixels(width), pixels(height))), about};
  expect(check(made));
  return made;
}

void add_box_views(py::module_& m) {
  py::class_<Boxes>(
      m, "BoxView",
      "Boxes in your own arrays, which are read where they lie. Wherever boxes are asked for, an\n"
      "array of shape (n, 2, 3) or (n, 6), minimum and maximum, does as well.")
      .def_static(
          "min_max", &min_max,
          "Of one array (n, 2, 3) or (n, 6), or of two, minimum and maximum, (n, 3) each: float32 or\n"
          "float64, metres, rows at any one ascending stride. `origin`: added to float32, of arrays alone.",
          py::arg("minimum"), py::arg("maximum") = py::none(), py::kw_only(), py::arg("origin") = py::none())
      .def_static("centre_half", &centre_half,
                  "Of centres and half sizes, (n, 3) each: float32 or float64, metres, rows at any one\n"
                  "ascending stride, such as two fields of a structured array. Half sizes are not negative.",
                  py::arg("centre"), py::arg("half"), py::kw_only(), py::arg("origin") = py::none())
      .def_static("arrays", &box_arrays, "An array a coordinate, float32 (n,): the fastest to cull flat.",
                  py::arg("min_x"), py::arg("min_y"), py::arg("min_z"), py::arg("max_x"), py::arg("max_y"),
                  py::arg("max_z"))
      .def("__len__", [](const Boxes& boxes) { return boxes.view.size(); });
  py::class_<Spheres>(
      m, "SphereView",
      "Spheres in your own arrays. Wherever spheres are asked for, an array of shape (n, 4),\n"
      "centre and radius, does as well.")
      .def(py::init(&spheres),
           "Of one array (n, 4), or of centres (n, 3) and radii (n,): float32, metres, rows at one stride.",
           py::arg("centre"), py::arg("radius") = py::none())
      .def_static("arrays", &sphere_arrays, "An array a coordinate, float32 (n,): the fastest to cull flat.",
                  py::arg("x"), py::arg("y"), py::arg("z"), py::arg("radius"))
      .def("__len__", [](const Spheres& spheres) { return spheres.view.size(); });
}

}  // namespace

void add_views(py::module_& m) {
  add_box_views(m);
  const auto nowhere = py::make_tuple(0, 0, 0);
  py::class_<WorldView>(m, "View", "A camera's matrices, its image size, and what the matrices are about.")
      .def(py::init(&view),
           "Of matrices (4, 4): world_to_eye rigid, the eye looking down its own -z with y up; clip depth 0\n"
           "to 1. The world is seen moved by -origin. Refused: what is not finite or not invertible, and\n"
           "images of no pixels or of more than 16384 a side.",
           py::arg("world_to_eye"), py::arg("eye_to_clip"), py::arg("width"), py::arg("height"),
           py::arg("origin") = nowhere)
      .def_property_readonly("world_to_eye", [](const WorldView& v) { return array_of(v.view.world_to_eye); })
      .def_property_readonly("eye_to_clip", [](const WorldView& v) { return array_of(v.view.eye_to_clip); })
      .def_property_readonly("width", [](const WorldView& v) { return v.view.width; })
      .def_property_readonly("height", [](const WorldView& v) { return v.view.height; })
      .def_property_readonly(
          "origin", [](const WorldView& v) { return py::make_tuple(v.origin.x, v.origin.y, v.origin.z); });
  const Camera usual;
  m.def("camera", &camera,
        "A perspective View, or an orthographic one where orthographic_height (metres) is above 0. eye,\n"
        "near, far in metres; fov: vertical, radians; shift: off-centre, in half image sizes; origin: give\n"
        "one near the eye, where that is many kilometres from 0. Refused: what makes no camera.",
        py::arg("eye") = nowhere, py::arg("forward") = py::make_tuple(0, 0, -1),
        py::arg("up") = py::make_tuple(0, 1, 0), py::arg("fov") = usual.vertical_fov,
        py::arg("near") = usual.near_plane, py::arg("far") = usual.far_plane, py::arg("width") = 1280,
        py::arg("height") = 720, py::arg("orthographic_height") = 0.0,
        py::arg("shift") = py::make_tuple(0, 0), py::arg("reversed_depth") = false,
        py::arg("origin") = nowhere);
}

}  // namespace sightline::python
