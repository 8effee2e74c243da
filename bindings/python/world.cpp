// Worlds and their culling.
#include <sightline/world.hpp>

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "bindings/python/arrays.hpp"
#include "bindings/python/cull_views.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

// Calls that check the caller's arrays and then rely on them keep the interpreter's lock.

py::object insert(SharedWorld& world, const py::object& boxes, const py::object& handles,
                  const py::object& layers, const py::object& values, const py::object& distances) {
  const Boxes given = boxes_of(boxes);
  py::object written = handles;
  if (handles.is_none())
    written = py::array_t<std::uint32_t>({static_cast<py::ssize_t>(given.view.size()), py::ssize_t{2}});
  const Strided<Handle> out = writable_handles_of(written);
  const ObjectColumns columns{column_of(layers, "layers"), column_of(values, "values"),
                              distances_of(distances)};
  expect(changing(world, [&](World& w) { return w.insert(given.view, out, columns); }));
  return written;
}

void move(SharedWorld& world, const py::object& handles, const py::object& boxes) {
  const Boxes given = boxes_of(boxes);
  const Strided<const Handle> which = handles_of(handles);
  expect(changing(world, [&](World& w) { return w.move(which, given.view); }));
}

void remove(SharedWorld& world, const py::object& handles) {
  const Strided<const Handle> which = handles_of(handles);
  expect(changing(world, [&](World& w) { return w.remove(which); }));
}

void set_layers(SharedWorld& world, const py::object& handles, const py::object& layers) {
  const Strided<const Handle> which = handles_of(handles);
  const Strided<const std::uint32_t> given = column_of(layers, "layers");
  expect(changing(world, [&](World& w) { return w.set_layers(which, given); }));
}

void set_values(SharedWorld& world, const py::object& handles, const py::object& values) {
  const Strided<const Handle> which = handles_of(handles);
  const Strided<const std::uint32_t> given = column_of(values, "values");
  expect(changing(world, [&](World& w) { return w.set_values(which, given); }));
}

void set_distances(SharedWorld& world, const py::object& handles, const py::object& distances) {
  const Strided<const Handle> which = handles_of(handles);
  const Strided<const DistanceRange> given = distances_of(distances);
  expect(changing(world, [&](World& w) { return w.set_distances(which, given); }));
}

std::uint32_t add_levels(SharedWorld& world, const py::object& sizes) {
  constexpr const char* what = "sizes: expected numbers of shape (n,)";
  const auto given = made_of<py::array_t<float, py::array::c_style | py::array::forcecast>>(sizes, what);
  if (given.ndim() != 1) refuse(what);
  const std::span<const float> numbers(given.data(), static_cast<std::size_t>(given.size()));
  return expect(changing(world, [&](World& w) { return w.add_levels(numbers); }));
}

void set_levels(SharedWorld& world, const py::object& handles, const py::object& tables) {
  const Strided<const Handle> which = handles_of(handles);
  const Strided<const std::uint32_t> given = column_of(tables, "tables");
  expect(changing(world, [&](World& w) { return w.set_levels(which, given); }));
}

// Calls read(world, i, handle) for each handle; they may be stale.
template <class Read>
void read_each(const SharedWorld& world, const Strided<const Handle>& handles, Read read) {
  if (!handles.sound()) refuse("handles: their stride is shorter than they are");
  looking(world, [&](const World& w) {
    for (std::size_t i = 0; i < handles.size(); ++i) read(w, i, handles[i]);
  });
}

// One number an object.
template <class T, class Read>
py::array_t<T> numbers(const SharedWorld& world, const py::object& handles, Read read) {
  const Strided<const Handle> given = handles_of(handles);
  py::array_t<T> result = new_array<T>(given.size());
  const std::span<T> out = span_of(result);
  read_each(world, given, [&](const World& w, std::size_t i, Handle h) { out[i] = read(w, h); });
  return result;
}

py::array_t<bool> contains(const SharedWorld& world, const py::object& handles) {
  return numbers<bool>(world, handles, [](const World& w, Handle h) { return w.contains(h); });
}
py::array_t<std::uint32_t> layers(const SharedWorld& world, const py::object& handles) {
  return numbers<std::uint32_t>(world, handles, [](const World& w, Handle h) { return w.layers(h); });
}
py::array_t<std::uint32_t> values(const SharedWorld& world, const py::object& handles) {
  return numbers<std::uint32_t>(world, handles, [](const World& w, Handle h) { return w.value(h); });
}

py::array_t<float> distances(const SharedWorld& world, const py::object& handles) {
  const Strided<const Handle> given = handles_of(handles);
  py::array_t<float> result({static_cast<py::ssize_t>(given.size()), py::ssize_t{2}});
  const std::span<float> out = span_of(result);
  read_each(world, given, [&](const World& w, std::size_t i, Handle h) {
    const DistanceRange range = w.distances(h);
    out[2 * i] = range.min, out[2 * i + 1] = range.max;
  });
  return result;
}

py::array_t<double> boxes(const SharedWorld& world, const py::object& handles) {
  const Strided<const Handle> given = handles_of(handles);
  py::array_t<double> result({static_cast<py::ssize_t>(given.size()), py::ssize_t{2}, py::ssize_t{3}});
  const std::span<double> out = span_of(result);
  static_assert(sizeof(WorldBox) == 6 * sizeof(double));
  read_each(world, given, [&](const World& w, std::size_t i, Handle h) {
    const WorldBox box = w.box(h);
    std::copy_n(&box.min.x, 6, &out[6 * i]);
  });
  return result;
}

py::array_t<std::uint32_t> handles(const SharedWorld& world, const py::object& ids) {
  const std::vector<std::uint32_t> given = numbers_of(ids, "ids");
  py::array_t<std::uint32_t> result({static_cast<py::ssize_t>(given.size()), py::ssize_t{2}});
  const Strided<Handle> out = writable_handles_of(result);
  looking(world, [&](const World& w) {
    for (std::size_t i = 0; i < given.size(); ++i) out.set(i, w.handle(given[i]));
  });
  return result;
}

std::size_t size_of(const SharedWorld& world) {
  return looking(world, [](const World& w) { return w.size(); });
}
std::size_t id_limit_of(const SharedWorld& world) {
  return looking(world, [](const World& w) { return w.id_limit(); });
}

constexpr const char* kNoViews = "cull: expected a View, a CullView, or some of them";

ViewOfWorld view_of(const py::handle& given) {
  if (py::isinstance<WorldView>(given)) return {given.cast<WorldView>()};
  if (!py::isinstance<ViewOfWorld>(given)) refuse(kNoViews);
  return given.cast<ViewOfWorld>();
}

}  // namespace

std::vector<ViewOfWorld> views_of(const py::object& given) {
  if (!py::isinstance<py::sequence>(given)) return {view_of(given)};
  std::vector<ViewOfWorld> views;
  for (const py::handle view : listed(given, kNoViews)) views.push_back(view_of(view));
  if (views.empty() || views.size() > kMaxViews)
    refuse("cull: expected 1 to " + std::to_string(kMaxViews) + " views, got " +
           std::to_string(views.size()));
  return views;
}

std::vector<CullView> cull_views_of(const std::vector<ViewOfWorld>& views) {
  std::vector<CullView> out;
  for (const ViewOfWorld& v : views)
    out.push_back({v.view, v.occlusion ? &v.occlusion->value : nullptr, v.layers, v.min_area,
                   v.distance_scale, v.distance_view.value_or(kOwnView),
                   v.casters ? &v.casters->value : nullptr});
  return out;
}

std::vector<Reading> lock_all(const std::vector<ViewOfWorld>& views,
                              std::vector<std::shared_mutex*> mutexes) {
  for (const ViewOfWorld& v : views) {
    if (v.occlusion) mutexes.push_back(&v.occlusion->mutex);
    if (v.casters) mutexes.push_back(&v.casters->mutex);
  }
  std::sort(mutexes.begin(), mutexes.end());
  mutexes.erase(std::unique(mutexes.begin(), mutexes.end()), mutexes.end());
  std::vector<Reading> locks;
  for (std::shared_mutex* mutex : mutexes) locks.emplace_back(*mutex);
  return locks;
}

namespace {

// Room for what a world holds now.
struct Output {
  py::array_t<std::uint32_t> ids;
  py::array_t<std::uint8_t> masks, levels, fades;

  Output(const SharedWorld& world, const CullOptions& options, bool wants_masks, bool wants_levels) {
    const std::size_t room = looking(world, [&](const World& w) { return cull_capacity(w, options); });
    ids = new_array<std::uint32_t>(room), masks = new_array<std::uint8_t>(wants_masks ? room : 0);
    levels = new_array<std::uint8_t>(wants_levels ? room : 0), fades = new_array<std::uint8_t>(levels.size());
  }

  // The ids alone, or a tuple of all that was wanted.
  [[nodiscard]] py::object first(std::size_t count) const {
    py::list out;
    out.append(first_of(ids, count));
    if (masks.size() > 0) out.append(first_of(masks, count));
    if (levels.size() > 0) out.append(first_of(levels, count)), out.append(first_of(fades, count));
    if (out.size() == 1) return out[0];
    return py::tuple(out);
  }
};

// "none" or "automatic".
sightline::Occlusion occlusion_of(const std::string& name) {
  if (name == "automatic") return sightline::Occlusion::automatic;
  if (name != "none") refuse("occlusion: expected 'none' or 'automatic'");
  return sightline::Occlusion::none;
}

py::object cull(LockedCuller& culler, const SharedWorld& world, const py::object& views, bool masks,
                bool values, const std::string& occlusion, float object_cost, const std::string& coverage,
                const py::object& scale, const std::optional<LevelOptions>& levels) {
  const std::vector<ViewOfWorld> given = views_of(views);
  const std::vector<CullView> seen = cull_views_of(given);
  CullOptions options{{}, values};
  options.occlusion = occlusion_of(occlusion), options.costs.object = object_cost;
  options.buffer = occlusion_options(coverage, scale);
  options.levels = levels.value_or(LevelOptions{});
  for (;;) {
    Output output(world, options, masks, levels.has_value());
    const CullOutput out{span_of(output.ids), span_of(output.masks), span_of(output.levels),
                         span_of(output.fades)};
    const Result<CullResult> result = changing_unlocked(culler, [&](Culler& c) {
      return looking(world, [&](const World& w) {
        const std::vector<Reading> locks = lock_all(given);
        const Result<CullResult> culled = c.cull(w, seen, options, out);
        if (culled && options.occlusion == sightline::Occlusion::automatic) culler.remember(seen);
        return culled;
      });
    });
    // Another thread may have let the world grow meanwhile.
    if (!result && result.error().code() == StatusCode::buffer_too_small) continue;
    return output.first(expect(result).count);
  }
}

void add_constants(py::module_& m) {
  m.attr("ALL_LAYERS") = kAllLayers;
  m.attr("NO_OBJECT") = kNoObject;
  m.attr("NO_OCCLUDER") = kNoOccluder;
  m.attr("MAX_VIEWS") = kMaxViews;
  const auto uint32 = py::dtype::of<std::uint32_t>();
  m.attr("handle_dtype") =
      py::dtype(py::list(py::make_tuple("index", "generation")), py::list(py::make_tuple(uint32, uint32)),
                py::list(py::make_tuple(0, 4)), sizeof(Handle));
}

void add_world_class(py::module_& m) {
  py::class_<SharedWorld> world_class(
      m, "World",
      "Boxes that come, move and go within 1e11 m of 0, by stable handle. Handles are uint32 (n, 2),\n"
      "index and generation, or (n,) of two uint32 fields (handle_dtype); the index is the id that cull()\n"
      "returns.\n"
      "Boxes are a BoxView or an array (n, 2, 3) of minimum and maximum, float32 or float64, in metres.\n"
      "Refused, changing nothing: lengths that differ, boxes that are not min <= max, stale handles.");
  world_class.def(py::init<>())
      .def("insert", &insert,
           "Puts n boxes in and returns their handles: `handles` where it is given, into which they are\n"
           "written, or a new array (n, 2). layers: uint32 (n,), a bit a layer, all unless given; values:\n"
           "uint32 (n,), what cull(values=True) returns, the id unless given; distances: float32 (n, 2),\n"
           "metres from which and below which an object is seen, measured from a view's eye to the centre\n"
           "of its box, any unless given.",
           py::arg("boxes"), py::arg("handles") = py::none(), py::arg("layers") = py::none(),
           py::arg("values") = py::none(), py::arg("distances") = py::none())
      .def(
          "move", &move,
          "Gives each object a new box; one that is listed twice keeps the last. Call it once a frame, with\n"
          "all that moved, or with nothing: what has come to rest is filed again a part a frame. Listing\n"
          "objects in the same order each frame is fastest.",
          py::arg("handles"), py::arg("boxes"))
      .def("remove", &remove, "Takes the objects out.", py::arg("handles"))
      .def("set_layers", &set_layers, "Gives each object new layers, uint32 (n,).", py::arg("handles"),
           py::arg("layers"))
      .def("set_values", &set_values, "Gives each object a new value, uint32 (n,).", py::arg("handles"),
           py::arg("values"))
      .def("set_distances", &set_distances, "Gives each object new distances, float32 (n, 2).",
           py::arg("handles"), py::arg("distances"))
      .def("add_levels", &add_levels,
           "Keeps a table of levels of detail, 1 to 7 sizes in pixels, descending, and returns its name: an\n"
           "object has level i as long as the ball around its box is sizes[i] wide or wider.",
           py::arg("sizes"))
      .def("set_levels", &set_levels, "Gives each object a table of levels, uint32 (n,); 0: none.",
           py::arg("handles"), py::arg("tables"))
      .def("contains", &contains, "bool (n,): whether the object still stands.", py::arg("handles"))
      .def("boxes", &boxes, "float64 (n, 2, 3): the boxes as they are kept; 0 for stale handles.",
           py::arg("handles"))
      .def("layers", &layers, "uint32 (n,); 0 for stale handles.", py::arg("handles"))
      .def("values", &values, "uint32 (n,); NO_OBJECT for stale handles.", py::arg("handles"))
      .def("distances", &distances, "float32 (n, 2); 0 for stale handles.", py::arg("handles"))
      .def("handles", &handles, "uint32 (n, 2): the handles of the objects that have these ids, uint32 (n,).",
           py::arg("ids"))
      .def("__len__", &size_of)
      .def_property_readonly("id_limit", &id_limit_of);
  add_world_occluders(world_class);
  add_snapshots(m, world_class);
}

void add_cull_view(py::module_& m) {
  py::class_<ViewOfWorld>(m, "CullView", "A camera, an eye, a shadow cascade: whatever sees the world.")
      .def(
          py::init([](const WorldView& view, const py::object& layers, float min_area,
                      std::shared_ptr<Occlusion> occlusion, float distance_scale,
                      const py::object& distance_view, std::shared_ptr<Casters> casters) {
            return ViewOfWorld{view,
                               whole_number_of(layers, "layers"),
                               min_area,
                               std::move(occlusion),
                               distance_scale,
                               whole_number_or_none(distance_view, "distance_view"),
                               std::move(casters)};
          }),
          "layers: sees objects whose layers share a bit with these; min_area: drops what covers fewer px2,\n"
          "approximately; occlusion: one that was begun with this same view, or None; distance_scale: times\n"
          "the objects' distances; distance_view: the place of the view from whose eye these are measured,\n"
          "as a shadow cascade takes its camera's, or None: this one's; casters: begun with this same view,\n"
          "leaves only what can throw a shadow on what a camera sees, or None.",
          py::arg("view"), py::arg("layers") = kAllLayers, py::arg("min_area") = 0.0f,
          py::arg("occlusion") = std::shared_ptr<Occlusion>(), py::arg("distance_scale") = 1.0f,
          py::arg("distance_view") = py::none(), py::arg("casters") = std::shared_ptr<Casters>())
      .def_readwrite("view", &ViewOfWorld::view)
      .def_property(
          "layers", [](const ViewOfWorld& v) { return v.layers; },
          [](ViewOfWorld& v, const py::object& given) { v.layers = whole_number_of(given, "layers"); })
      .def_readwrite("min_area", &ViewOfWorld::min_area)
      .def_readwrite("occlusion", &ViewOfWorld::occlusion)
      .def_readwrite("distance_scale", &ViewOfWorld::distance_scale)
      .def_property(
          "distance_view", [](const ViewOfWorld& v) { return v.distance_view; },
          [](ViewOfWorld& v, const py::object& given) {
            v.distance_view = whole_number_or_none(given, "distance_view");
          })
      .def_readwrite("casters", &ViewOfWorld::casters);
}

void add_levels_options(py::module_& m) {
  py::class_<LevelOptions>(m, "Levels", "How a cull chooses levels of detail, for all its views.")
      .def(py::init([](const py::object& view, const py::object& key, float hysteresis, float fade,
                       float scale, bool cut) {
             return LevelOptions{
                 whole_number_of(view, "view"), whole_number_of(key, "key"), hysteresis, fade, scale, cut};
           }),
           "view: the place of the view by whose image objects have their sizes; key: whose memory, 0 to\n"
           "7, of cameras that take turns; hysteresis: how far beyond a limit a level is kept, as a share\n"
           "of it; fade: how far above its lower limit a level begins to fade; scale: times the sizes; cut:\n"
           "nothing is remembered from before.",
           py::arg("view") = 0, py::arg("key") = 0, py::arg("hysteresis") = 0.0f, py::arg("fade") = 0.0f,
           py::arg("scale") = 1.0f, py::arg("cut") = false);
}

void add_culler(py::module_& m) {
  py::class_<LockedCuller>(m, "Culler", "Remembers from frame to frame what helps the next.")
      .def(py::init<>())
      .def("cull", &cull,
           "The ids of what at least one of 1 to MAX_VIEWS views may see, uint32 (k,), in an order that\n"
           "depends on the calls so far alone, culls between moves among them; with masks=True also which\n"
           "views see each, uint8 (k,), bit v for view v; with values=True the objects' values instead of\n"
           "their ids. views: a View, a CullView, or a sequence of them. Refused: no or too many views, one\n"
           "that is no camera, an occlusion that was not begun with its view.\n"
           "occlusion='automatic': what the objects carry is drawn as far as that pays, and what it hides\n"
           "left out; culling and drawing cost at most 1.02 x those by frustum alone over all frames, in\n"
           "counted work. object_cost: ns that drawing an object costs; 0: what report_frame_time() taught.\n"
           "coverage, scale: as Occlusion.begin has them. levels=Levels(...): also each object's level of\n"
           "detail and, of 255, the share of the next coarser one that it fades into, uint8 (k,) each.",
           py::arg("world"), py::arg("views"), py::arg("masks") = false, py::arg("values") = false,
           py::arg("occlusion") = "none", py::arg("object_cost") = 0.0f, py::arg("coverage") = "area",
           py::arg("scale") = 1, py::arg("levels") = py::none())
      .def(
          "report_frame_time",
          [](LockedCuller& culler, double seconds) {
            expect(changing(culler, [&](Culler& c) { return c.report_frame_time(1e9 * seconds); }));
          },
          "Teaches what an object costs: how many seconds the frame took to draw what the last cull left,\n"
          "without any wait for the display (C++, C and JavaScript take nanoseconds).",
          py::arg("seconds"));
}

}  // namespace

void add_world(py::module_& m) {
  add_constants(m);
  add_world_class(m);
}

void add_culling(py::module_& m) {
  add_cull_view(m);
  add_levels_options(m);
  add_culler(m);
}

}  // namespace sightline::python
