// What culls did, and shapes to be drawn.
#include <sightline/inspect.hpp>

#include <array>
#include <utility>

#include "bindings/python/arrays.hpp"
#include "bindings/python/cull_views.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

using LockedInspector = Guarded<CullInspector>;

py::dict dict_of(const ViewStats& s) {
  py::dict out;
  const std::pair<const char*, std::uint64_t> numbers[] = {{"sectors", s.sectors},
                                                           {"sectors_in_view", s.sectors_in_view},
                                                           {"groups", s.groups},
                                                           {"chunks", s.chunks},
                                                           {"chunks_outside", s.chunks_outside},
                                                           {"chunks_dropped", s.chunks_dropped},
                                                           {"chunks_hidden", s.chunks_hidden},
                                                           {"chunks_whole", s.chunks_whole},
                                                           {"chunks_opened", s.chunks_opened},
                                                           {"objects_tested", s.objects_tested},
                                                           {"objects", s.objects},
                                                           {"outside", s.outside},
                                                           {"by_layers", s.by_layers},
                                                           {"by_distances", s.by_distances},
                                                           {"by_casters", s.by_casters},
                                                           {"by_area", s.by_area},
                                                           {"hidden", s.hidden},
                                                           {"visible", s.visible}};
  for (const auto& [name, number] : numbers) out[name] = number;
  return out;
}

py::dtype box_dtype() {
  py::list names, formats, offsets;
  const auto add = [&](const char* name, const char* format, std::size_t offset) {
    names.append(name), formats.append(format), offsets.append(offset);
  };
  add("box", "(2,3)f8", offsetof(DebugBox, box)), add("kind", "u1", offsetof(DebugBox, kind));
  add("seen", "u1", offsetof(DebugBox, seen)), add("whole", "u1", offsetof(DebugBox, whole));
  add("objects", "u4", offsetof(DebugBox, objects));
  return py::dtype(names, formats, offsets, sizeof(DebugBox));
}

py::object inspect(LockedInspector& inspector, const SharedWorld& world, const py::object& views,
                   const py::object& culler) {
  const std::vector<ViewOfWorld> given = views_of(views);
  const std::vector<CullView> seeing = cull_views_of(given);
  if (!culler.is_none() && !py::isinstance<LockedCuller>(culler)) refuse("culler: expected a Culler or None");
  const auto* theirs = culler.is_none() ? nullptr : &culler.cast<const LockedCuller&>();
  std::vector<ViewStats> stats;
  std::vector<DebugBox> boxes;
  expect(changing_unlocked(inspector, [&](CullInspector& c) {
    std::unique_lock<std::shared_mutex> beside;
    if (theirs) beside = std::unique_lock(theirs->mutex);
    const std::vector<Reading> locks = lock_all(given, {&world.mutex});
    const auto looked = c.inspect(world.value, seeing, theirs ? &theirs->value : nullptr);
    if (!looked) return looked.error();
    stats.assign(looked->views.begin(), looked->views.end());
    boxes.assign(looked->boxes.begin(), looked->boxes.end());
    return Status();
  }));
  py::list of_views;
  for (const ViewStats& s : stats) of_views.append(dict_of(s));
  return py::make_tuple(of_views,
                        py::array(box_dtype(), {static_cast<py::ssize_t>(boxes.size())}, boxes.data()));
}

py::array_t<double> corners_of(const WorldView& view, double farthest) {
  const std::array<WorldPoint, 8> corners = expect(view_corners(view, farthest));
  py::array_t<double> out({py::ssize_t{8}, py::ssize_t{3}});
  double* to = out.mutable_data();
  for (const WorldPoint& p : corners) *to++ = p.x, *to++ = p.y, *to++ = p.z;
  return out;
}

py::array_t<std::uint8_t> image_of(const Occlusion& occlusion) {
  const View view = looking(occlusion, [](const OcclusionBuffer& b) { return b.view().view; });
  py::array_t<std::uint8_t> pixels({py::ssize_t{view.height}, py::ssize_t{view.width}});
  const std::span<std::uint8_t> out = span_of(pixels);
  expect(looking_unlocked(occlusion, [&](const OcclusionBuffer& b) { return depth_image(b, out); }));
  return pixels;
}

// Refuses another size than the image's, and takes None.
void check_size(const py::object& size, const LockedCuller::Image& image) {
  if (size.is_none()) return;
  const auto [width, height] = two_numbers_of(size, "size");
  if (width != static_cast<float>(image.width) || height != static_cast<float>(image.height))
    refuse("size: expected (" + std::to_string(image.width) + ", " + std::to_string(image.height) +
           "), width and height of the view's image");
}

py::array_t<std::uint8_t> image_of_culler(const LockedCuller& culler, const py::object& place,
                                          const py::object& size) {
  const auto at = whole_number_of(place, "place");
  const LockedCuller::Image image = looking(culler, [&](const Culler&) {
    return at < culler.images.size() ? culler.images[at] : LockedCuller::Image{};
  });
  // Of no image nothing was drawn, and the library says so.
  if (image.width > 0) check_size(size, image);
  py::array_t<std::uint8_t> pixels({py::ssize_t{image.height}, py::ssize_t{image.width}});
  const std::span<std::uint8_t> out = span_of(pixels);
  expect(looking_unlocked(culler, [&](const Culler& c) {
    // What fits into fewer pixels was drawn for an earlier view of this place.
    if (!out.empty() && depth_image(c, at, out.first(out.size() - 1)))
      return Status(StatusCode::stale_buffer,
                    "depth image: the culler has drawn no occluders for that view since its size changed");
    return depth_image(c, at, out);
  }));
  return pixels;
}

}  // namespace

void add_inspect(py::module_& m) {
  m.attr("DEBUG_SECTOR") = static_cast<int>(DebugBoxKind::sector);
  m.attr("DEBUG_CHUNK") = static_cast<int>(DebugBoxKind::chunk);
  m.attr("DEBUG_OCCLUDER") = static_cast<int>(DebugBoxKind::occluder);
  py::class_<LockedInspector>(m, "CullInspector",
                              "What a cull did and why: numbers a view, and boxes to be drawn.")
      .def(py::init<>())
      .def(
          "inspect", &inspect,
          "(views, boxes): a dict of numbers a view, and an array of fields box (2, 3), metres; kind,\n"
          "DEBUG_SECTOR, DEBUG_CHUNK or DEBUG_OCCLUDER; seen and whole, a bit a view; and objects, how\n"
          "many, or of an occluder whose. culler: one that has culled these views with automatic occlusion;\n"
          "what it drew hides, too.",
          py::arg("world"), py::arg("views"), py::arg("culler") = py::none());
  m.def("view_corners", &corners_of,
        "The corners of what a view sees, float64 (8, 3): of the near plane, bottom left, bottom right, top\n"
        "left, top right; then of the far plane, or of `farthest` metres along the view.",
        py::arg("view"), py::arg("farthest"));
  m.def("depth_image", &image_of,
        "A buffer's depth as a picture, uint8 (height, width), rows from the top: 255 for the nearest\n"
        "occluder to 55 for the farthest, 0 where there is none.",
        py::arg("occlusion"));
  m.def(
      "culler_depth_image", &image_of_culler,
      "The same of what automatic occlusion drew for the view at `place` in the culler's calls, whose image\n"
      "is `size`, width and height, as it was culled the last time; any other is refused, None stands for\n"
      "it.",
      py::arg("culler"), py::arg("place"), py::arg("size") = py::none());
}

}  // namespace sightline::python
