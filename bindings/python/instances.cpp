// Instances of worlds, and their culling.
#include <sightline/instances.hpp>

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

#include "bindings/python/arrays.hpp"
#include "bindings/python/cull_views.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

// Instances, and by name the worlds that they show; null where a name is free.
struct Placed {
  Instances all;
  std::vector<const SharedWorld*> worlds;

  // What a call that looks at the worlds locks.
  [[nodiscard]] std::vector<std::shared_mutex*> mutexes() const {
    std::vector<std::shared_mutex*> out;
    for (const SharedWorld* world : worlds)
      if (world) out.push_back(&world->mutex);
    return out;
  }
};
struct PlacedWorlds {
  Guarded<Placed> instances;
  std::vector<py::object> alive;  // the worlds
};
using LockedInstanceCuller = Guarded<InstanceCuller>;

std::uint32_t add_placed_world(PlacedWorlds& placed, const py::object& world) {
  if (!py::isinstance<SharedWorld>(world)) refuse("instances: expected a World");
  const auto& shared = world.cast<const SharedWorld&>();
  const PlacedWorldId name = expect(changing(placed.instances, [&](Placed& p) {
    const Result<PlacedWorldId> added = looking(shared, [&](const World& w) { return p.all.add_world(w); });
    if (added && p.worlds.size() <= *added) p.worlds.resize(*added + 1);
    if (added) p.worlds[*added] = &shared;
    return added;
  }));
  if (placed.alive.size() <= name) placed.alive.resize(name + 1, py::none());
  placed.alive[name] = world;
  return name;
}

void remove_placed_world(PlacedWorlds& placed, const py::object& given) {
  const PlacedWorldId name = whole_number_of(given, "name");
  expect(changing(placed.instances, [&](Placed& p) {
    const Status gone = p.all.remove_world(name);
    if (gone) p.worlds[name] = nullptr;
    return gone;
  }));
  placed.alive[name] = py::none();
}

void update_instances(PlacedWorlds& placed) {
  expect(changing(placed.instances, [&](Placed& p) {
    const std::vector<Reading> locks = lock_all({}, p.mutexes());
    return p.all.update();
  }));
}

// Names (n,), matrices (n, 4, 4) and origins (n, 3) or None.
std::vector<InstancePlacement> placements_of(const py::object& worlds, const py::object& transforms,
                                             const py::object& origins) {
  const std::vector<std::uint32_t> names = numbers_of(worlds, "worlds");
  const std::vector<Mat4> matrices = matrices_of(transforms, "transforms");
  if (matrices.size() != names.size()) refuse("transforms: expected one for each of the worlds");
  std::vector<InstancePlacement> out;
  for (std::size_t i = 0; i < names.size(); ++i) out.push_back({names[i], matrices[i], {}});
  if (origins.is_none()) return out;
  constexpr const char* what = "origins: expected numbers of shape (n, 3), one point for each of the worlds";
  const auto points = made_of<py::array_t<double, py::array::c_style | py::array::forcecast>>(origins, what);
  if (points.ndim() != 2 || points.shape(1) != 3 || static_cast<std::size_t>(points.shape(0)) != names.size())
    refuse(what);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double* p = points.data(static_cast<py::ssize_t>(i), 0);
    out[i].origin = {p[0], p[1], p[2]};
  }
  return out;
}

py::object insert_instances(PlacedWorlds& placed, const py::object& worlds, const py::object& transforms,
                            const py::object& origins, const py::object& layers) {
  const std::vector<InstancePlacement> given = placements_of(worlds, transforms, origins);
  const Strided<const std::uint32_t> in = column_of(layers, "layers");
  py::array_t<std::uint32_t> written({static_cast<py::ssize_t>(given.size()), py::ssize_t{2}});
  const Strided<Handle> out = writable_handles_of(written);
  expect(changing(placed.instances, [&](Placed& p) { return p.all.insert(given, out, in); }));
  return written;
}

void move_instances(PlacedWorlds& placed, const py::object& handles, const py::object& worlds,
                    const py::object& transforms, const py::object& origins) {
  const std::vector<InstancePlacement> given = placements_of(worlds, transforms, origins);
  const Strided<const Handle> which = handles_of(handles);
  expect(changing(placed.instances, [&](Placed& p) { return p.all.move(which, given); }));
}

void remove_instances(PlacedWorlds& placed, const py::object& handles) {
  const Strided<const Handle> which = handles_of(handles);
  expect(changing(placed.instances, [&](Placed& p) { return p.all.remove(which); }));
}

void set_instance_layers(PlacedWorlds& placed, const py::object& handles, const py::object& layers) {
  const Strided<const Handle> which = handles_of(handles);
  const Strided<const std::uint32_t> given = column_of(layers, "layers");
  expect(changing(placed.instances, [&](Placed& p) { return p.all.set_layers(which, given); }));
}

// What a cull saw, for the culler's memory changes with its next one.
struct SeenInstances {
  std::vector<InstanceRange> ranges;
  std::vector<std::uint32_t> ids;
  std::vector<std::uint8_t> masks, levels, fades;
};

py::tuple cull_instances(LockedInstanceCuller& culler, const PlacedWorlds& placed, const py::object& views,
                         bool masks, bool values, const std::optional<LevelOptions>& levels,
                         const py::object& most_objects) {
  const std::vector<ViewOfWorld> given = views_of(views);
  const std::vector<CullView> seeing = cull_views_of(given);
  InstanceCullOptions options;
  options.masks = masks, options.values_for_ids = values, options.levels = levels.has_value();
  options.level_options = levels.value_or(LevelOptions{}),
  options.most_objects = whole_number_of<std::size_t>(most_objects, "most_objects");
  SeenInstances seen;
  const auto keep = [](const auto& from, auto& to) { to.assign(from.begin(), from.end()); };
  expect(changing_unlocked(culler, [&](InstanceCuller& c) {
    return looking(placed.instances, [&](const Placed& p) {
      const std::vector<Reading> locks = lock_all(given, p.mutexes());
      const Result<InstanceCullResult> result = c.cull(p.all, seeing, options);
      if (!result) return result.error();
      keep(result->ranges, seen.ranges), keep(result->ids, seen.ids), keep(result->masks, seen.masks);
      keep(result->levels, seen.levels), keep(result->fades, seen.fades);
      return Status();
    });
  }));
  static_assert(sizeof(InstanceRange) == 3 * sizeof(std::uint32_t));
  py::array_t<std::uint32_t> ranges({static_cast<py::ssize_t>(seen.ranges.size()), py::ssize_t{3}});
  std::uint32_t* to = ranges.mutable_data();
  for (const InstanceRange& r : seen.ranges) *to++ = r.instance, *to++ = r.first, *to++ = r.count;
  py::list out;
  out.append(ranges), out.append(array_of(seen.ids));
  if (masks) out.append(array_of(seen.masks));
  if (levels) out.append(array_of(seen.levels)), out.append(array_of(seen.fades));
  return py::tuple(out);
}

}  // namespace

void add_instances(py::module_& m) {
  py::class_<PlacedWorlds>(
      m, "Instances",
      "Worlds in many places: each is kept once, and placed by a rotation, a uniform scale and a\n"
      "translation. Placements are worlds, uint32 (n,), as add_world named them; transforms, (n, 4, 4),\n"
      "[row, column], from the world's metres to metres about an origin; and origins, (n, 3), 0 unless\n"
      "given.")
      .def(py::init<>())
      .def("add_world", &add_placed_world,
           "Keeps a World for instances to show, and returns its name. It may change between culls: then\n"
           "call update().",
           py::arg("world"))
      .def("remove_world", &remove_placed_world, "Forgets a world that no instance shows.", py::arg("name"))
      .def("update", &update_instances, "Gives instances of worlds that reach elsewhere now new boxes.")
      .def("insert", &insert_instances,
           "Puts n instances in and returns their handles, uint32 (n, 2). layers: uint32 (n,); a view sees\n"
           "an object iff it shares a layer with the instance and one with the object.",
           py::arg("worlds"), py::arg("transforms"), py::arg("origins") = py::none(),
           py::arg("layers") = py::none())
      .def("move", &move_instances, "Gives each instance a new placement.", py::arg("handles"),
           py::arg("worlds"), py::arg("transforms"), py::arg("origins") = py::none())
      .def("remove", &remove_instances, "Takes the instances out.", py::arg("handles"))
      .def("set_layers", &set_instance_layers, "Gives each instance new layers, uint32 (n,).",
           py::arg("handles"), py::arg("layers"))
      .def_property_readonly(
          "objects",
          [](const PlacedWorlds& placed) {
            return looking(placed.instances, [](const Placed& p) {
              const std::vector<Reading> locks = lock_all({}, p.mutexes());
              return p.all.objects();
            });
          },
          "How many objects all instances show together.")
      .def_property_readonly("id_limit",
                             [](const PlacedWorlds& placed) {
                               return looking(placed.instances,
                                              [](const Placed& p) { return p.all.id_limit(); });
                             })
      .def("__len__", [](const PlacedWorlds& placed) {
        return looking(placed.instances, [](const Placed& p) { return p.all.size(); });
      });

  py::class_<LockedInstanceCuller>(m, "InstanceCuller", "Culls instances of worlds.")
      .def(py::init<>())
      .def("cull", &cull_instances,
           "(ranges, ids): of each instance of which something may be seen, uint32 (k, 3), the id of its\n"
           "handle and where its objects stand in ids: from first, count of them. Instances of one world\n"
           "that are seen whole may share ids. masks=True: also which views see each, uint8; values=True:\n"
           "the objects' values instead of their ids; levels=Levels(...), without hysteresis: also levels\n"
           "and fades, uint8 each. Layers, min_area, distances (in metres of the objects' own world) and\n"
           "occlusion count as for Culler.cull; casters are refused. Refused, too: worlds that reach\n"
           "elsewhere since their instances were placed, and views that may see more than most_objects.",
           py::arg("instances"), py::arg("views"), py::arg("masks") = false, py::arg("values") = false,
           py::arg("levels") = py::none(), py::arg("most_objects") = InstanceCullOptions{}.most_objects);
}

}  // namespace sightline::python
