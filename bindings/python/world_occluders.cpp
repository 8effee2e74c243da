// What a world's objects hide behind them.
#include <sightline/world.hpp>

#include <optional>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

using SharedWorld = Guarded<World>;

std::uint32_t add_occluder(SharedWorld& world, const Occluder& occluder) {
  return expect(changing_unlocked(world, [&](World& w) { return w.add_occluder(occluder); }));
}

std::uint32_t add_solids(SharedWorld& world, const py::object& boxes, const py::object& spheres) {
  Occluder occluder;
  std::vector<Sphere> balls;
  if (!boxes.is_none()) {
    const Boxes given = boxes_of(boxes);
    const auto near = [](double x) { return static_cast<float>(x); };
    for (std::size_t i = 0; i < given.view.size(); ++i) {
      const WorldBox b = given.view[i];
      occluder.boxes.push_back(
          {{near(b.min.x), near(b.min.y), near(b.min.z)}, {near(b.max.x), near(b.max.y), near(b.max.z)}});
    }
  }
  if (!spheres.is_none()) {
    const Spheres given = spheres_of(spheres);
    for (std::size_t i = 0; i < given.view.size(); ++i) balls.push_back(given.view[i]);
  }
  return expect(changing(world, [&](World& w) { return w.add_occluder(occluder, balls); }));
}

std::uint32_t add_surface(SharedWorld& world, const py::object& positions, const py::object& indices,
                          const py::object& sides) {
  Occluder occluder;
  occluder.positions = points_of(positions, "positions");
  occluder.indices = numbers_of(indices, "indices");
  occluder.sides = sides_of(sides);
  return expect(changing_unlocked(world, [&](World& w) { return w.add_occluder(occluder); }));
}

void remove_occluder(SharedWorld& world, const py::object& name) {
  const OccluderId given = whole_number_of(name, "name");
  expect(changing(world, [&](World& w) { return w.remove_occluder(given); }));
}

// One for all, or one an object.
std::vector<std::uint32_t> names_of(const py::object& given) {
  if (py::isinstance<py::int_>(given)) return {whole_number_of(given, "occluders")};
  return numbers_of(given, "occluders");
}

void set_occluders(SharedWorld& world, const py::object& handles, const py::object& occluders,
                   const py::object& transforms, const py::object& origin) {
  const Strided<const Handle> which = handles_of(handles);
  const std::vector<std::uint32_t> names = names_of(occluders);
  if (names.size() != 1 && names.size() != which.size()) refuse("occluders: expected one, or one a handle");
  std::vector<OccluderPlacement> placements(which.size());
  const WorldPoint about = origin.is_none() ? WorldPoint{} : world_point_of(origin, "origin");
  const std::vector<Mat4> matrices =
      transforms.is_none() ? std::vector<Mat4>(1) : matrices_of(transforms, "transforms");
  if (matrices.size() != 1 && matrices.size() != which.size())
    refuse("transforms: expected one (4, 4), or one a handle (n, 4, 4)");
  for (std::size_t i = 0; i < placements.size(); ++i)
    placements[i] = {names[names.size() == 1 ? 0 : i], matrices[matrices.size() == 1 ? 0 : i], about};
  expect(changing(world, [&](World& w) { return w.set_occluders(which, placements); }));
}

void set_occluding(SharedWorld& world, const py::object& handles, const py::object& on) {
  const Strided<const Handle> which = handles_of(handles);
  std::vector<std::uint8_t> switches;
  for (const bool one : truths_of(on, "on: expected bool (n,)")) switches.push_back(one);
  expect(changing(world, [&](World& w) { return w.set_occluding(which, switches); }));
}

void set_triangles(SharedWorld& world, const py::object& handle, const py::object& corners,
                   const py::object& origin, const py::object& sides) {
  const Strided<const Handle> which = handles_of(handle);
  if (which.size() != 1) refuse("handle: expected one, (1, 2)");
  const std::vector<Vec3> points = points_of(corners, "corners");
  const WorldPoint about = origin.is_none() ? WorldPoint{} : world_point_of(origin, "origin");
  const std::optional<Sides> seen = named_sides_of(sides);
  if (!seen) refuse("sides: expected 'both' or 'front'");
  expect(changing(world, [&](World& w) { return w.set_triangles(which[0], points, about, *seen); }));
}

}  // namespace

void add_world_occluders(py::class_<SharedWorld>& world) {
  world
      .def("add_occluder", &add_occluder,
           "Keeps an Occluder for objects to carry, as many as like, and returns its name in this world.",
           py::arg("occluder"))
      .def("add_solids", &add_solids,
           "The same of solid boxes, as World has them, and spheres, float32 (n, 4): they lie inside what\n"
           "carries them.",
           py::arg("boxes") = py::none(), py::arg("spheres") = py::none())
      .def("add_surface", &add_surface,
           "The same of all triangles that the objects show, as OccluderMesh takes them.",
           py::arg("positions"), py::arg("indices"), py::arg("sides") = "both")
      .def("remove_occluder", &remove_occluder, "Forgets an occluder that no object carries.",
           py::arg("name"))
      .def("set_occluders", &set_occluders,
           "Gives each object an occluder, switched on, one for all or one each, uint32 (n,); NO_OCCLUDER\n"
           "takes it away. transforms: (4, 4) or (n, 4, 4) affine, to metres about `origin`, double (3,).\n"
           "Call it again when the object has moved, behind move(), or has turned: of one whose box is "
           "another\n"
           "one than it was then, nothing is drawn, nor is what reaches out of that box.",
           py::arg("handles"), py::arg("occluders"), py::arg("transforms") = py::none(),
           py::arg("origin") = py::none())
      .def("set_occluding", &set_occluding,
           "Switches what the objects carry on or off, bool (n,), as doors do.", py::arg("handles"),
           py::arg("on"))
      .def(
          "set_triangles", &set_triangles,
          "Gives one object all of its triangles, float32 (..., 3) about `origin`: asked for where its box\n"
          "may be seen, by views of the same origin, from both sides, or from their front alone where no\n"
          "view, a shadow map's included, draws their backs. Call it again when the object has moved, "
          "behind\n"
          "move(), or has turned: while its box is another one, they are not asked. None of them takes them\n"
          "away.",
          py::arg("handle"), py::arg("corners"), py::arg("origin") = py::none(), py::arg("sides") = "both");
}

}  // namespace sightline::python
