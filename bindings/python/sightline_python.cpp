// The Python module. Arrays of the right type and layout are read where they lie; results are written
// straight into the arrays that are returned.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include <sightline/occlusion.hpp>
#include <sightline/version.hpp>
#include <sightline/world.hpp>

namespace py = pybind11;
using namespace sightline;

namespace {

// float64 (n, 2, 3): minimum and maximum; uint32 (n, 2): index and generation.
using BoxArray = py::array_t<double, py::array::c_style | py::array::forcecast>;
using HandleArray = py::array_t<std::uint32_t, py::array::c_style>;
static_assert(sizeof(WorldBox) == 6 * sizeof(double) && sizeof(Handle) == 2 * sizeof(std::uint32_t));

void refuse(const Check& bad) {
  if (bad) throw py::value_error(bad->message);
}

std::span<const WorldBox> boxes_of(const BoxArray& array) {
  if (array.ndim() != 3 || array.shape(1) != 2 || array.shape(2) != 3) {
    throw py::value_error("boxes: expected an array of shape (n, 2, 3): minimum and maximum");
  }
  return {reinterpret_cast<const WorldBox*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

// Of occluders; World says the same of its own boxes.
void refuse_invalid(std::span<const WorldBox> boxes) {
  const auto in_reach = [](double low, double high) {  // false for NaN, too
    return low >= -kWorldReach && high <= kWorldReach && low <= high;
  };
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const WorldBox& b = boxes[i];
    if (in_reach(b.min.x, b.max.x) && in_reach(b.min.y, b.max.y) && in_reach(b.min.z, b.max.z)) continue;
    throw py::value_error("occlusion: box " + std::to_string(i) + " of " + std::to_string(boxes.size()) +
                          " is not valid, expected min <= max within 1e11 m of 0");
  }
}

std::span<const Handle> handles_of(const HandleArray& array) {
  if (array.ndim() != 2 || array.shape(1) != 2) {
    throw py::value_error("handles: expected a uint32 array of shape (n, 2), as insert() returns");
  }
  return {reinterpret_cast<const Handle*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

using Point = std::array<double, 3>;

WorldView camera(const Point& eye, const Point& forward, const Point& up, double fov, double near, double far,
                 std::uint32_t width, std::uint32_t height, double orthographic_height) {
  const auto single = [](const Point& p) {
    return Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  };
  Camera camera;
  camera.forward = single(forward), camera.up = single(up);
  camera.vertical_fov = static_cast<float>(fov);
  camera.orthographic_height = static_cast<float>(orthographic_height);
  camera.near_plane = static_cast<float>(near), camera.far_plane = static_cast<float>(far);
  const Result<View> view = make_view(camera, width, height);
  if (!view) throw py::value_error(view.failure().message);
  return {*view, {eye[0], eye[1], eye[2]}};
}

py::object cull_world(Culler& culler, const World& world, const std::vector<WorldView>& views, float min_area,
                      const std::vector<const OcclusionBuffer*>& occlusion, bool masks) {
  const CullOptions options{.min_area = min_area, .occlusion = occlusion};
  const auto room = static_cast<py::ssize_t>(cull_capacity(world, options));
  py::array_t<std::uint32_t> ids(room);
  py::array_t<std::uint8_t> seen(masks ? room : 0);
  const CullResult result =
      culler.cull(world, views, options, {ids.mutable_data(), static_cast<std::size_t>(room)},
                  {seen.mutable_data(), static_cast<std::size_t>(seen.size())});
  switch (result.error) {
    case CullError::none:
      break;
    case CullError::views:
      throw py::value_error("cull: expected 1 to 8 views");
    case CullError::view:
      throw py::value_error("cull: a view is not finite or not invertible");
    default:
      throw py::value_error("cull: an option is out of range, or not one occlusion a view");
  }
  const py::slice written(0, static_cast<py::ssize_t>(result.count), 1);
  if (!masks) return ids[written];
  return py::make_tuple(ids[written], seen[written]);
}

}  // namespace

PYBIND11_MODULE(sightline, m) {
  m.doc() = "Visibility culling: a world of boxes that move, and what of it a camera may see.";
  m.attr("__version__") = std::string(kVersion);

  py::class_<WorldView>(m, "View", "A camera with its image size.");
  m.def("camera", &camera, "A perspective view, or an orthographic one where orthographic_height > 0.",
        py::arg("eye"), py::arg("forward") = Point{0, 0, -1}, py::arg("up") = Point{0, 1, 0},
        py::arg("fov") = 1.0, py::arg("near") = 0.1, py::arg("far") = std::numeric_limits<double>::infinity(),
        py::arg("width") = 1280, py::arg("height") = 720, py::arg("orthographic_height") = 0.0);

  py::class_<World>(m, "World", "Boxes that come, move and go, by stable handle.")
      .def(py::init<>())
      .def(
          "insert",
          [](World& world, const BoxArray& boxes) {
            const auto given = boxes_of(boxes);
            HandleArray handles({static_cast<py::ssize_t>(given.size()), py::ssize_t{2}});
            refuse(world.insert(given, {reinterpret_cast<Handle*>(handles.mutable_data()), given.size()}));
            return handles;
          },
          "boxes (n, 2, 3) -> handles (n, 2); the first column is the id that cull() returns.",
          py::arg("boxes"))
      .def(
          "move",
          [](World& world, const HandleArray& handles, const BoxArray& boxes) {
            refuse(world.move(handles_of(handles), boxes_of(boxes)));
          },
          py::arg("handles"), py::arg("boxes"))
      .def(
          "remove",
          [](World& world, const HandleArray& handles) { refuse(world.remove(handles_of(handles))); },
          py::arg("handles"))
      .def("__len__", &World::size)
      .def_property_readonly("id_limit", &World::id_limit);

  py::class_<OcclusionBuffer>(m, "Occlusion", "Occluders as one view sees them.")
      .def(py::init<>())
      .def(
          "begin", [](OcclusionBuffer& buffer, const WorldView& view) { refuse(buffer.begin(view)); },
          "Empties it and takes the view.", py::arg("view"))
      .def(
          "draw_boxes",
          [](OcclusionBuffer& buffer, const BoxArray& boxes) {
            if (buffer.width() == 0) throw py::value_error("occlusion: draw before begin");
            const auto given = boxes_of(boxes);
            refuse_invalid(given);
            buffer.draw_boxes(given);
          },
          "Solid boxes (n, 2, 3); nothing is drawn where one of them is not valid.", py::arg("boxes"));

  py::class_<Culler>(m, "Culler", "Remembers from frame to frame what helps the next.")
      .def(py::init<>())
      .def("cull", &cull_world,
           "The ids of what at least one of 1 to 8 views may see, uint32; with masks=True also which views, "
           "a bit each.",
           py::arg("world"), py::arg("views"), py::arg("min_area") = 0.0f,
           py::arg("occlusion") = std::vector<const OcclusionBuffer*>(), py::arg("masks") = false);
}
