// Views of shadow maps, and who throws shadows.
#include <sightline/shadows.hpp>

#include <algorithm>
#include <array>
#include <optional>

#include "bindings/python/arrays.hpp"
#include "bindings/python/objects.hpp"

namespace sightline::python {

namespace {

Vec3 vector_of(const py::object& given, const char* name) {
  const WorldPoint p = world_point_of(given, name);
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

Light make_light(const std::string& kind, const py::object& direction, const py::object& position, float cone,
                 float range, float near, float reach) {
  constexpr std::array names{"directional", "spot", "point"};
  const auto* const found = std::find(names.begin(), names.end(), kind);
  if (found == names.end()) refuse("kind: expected 'directional', 'spot' or 'point'");
  Light made;
  made.kind = static_cast<LightKind>(found - names.begin());
  made.direction = vector_of(direction, "direction"), made.position = world_point_of(position, "position");
  made.cone = cone, made.range = range, made.near_plane = near, made.reach = reach;
  return made;
}

DepthRange depths_of(const py::object& given) {
  if (given.is_none()) return {};
  const auto [near, far] = two_numbers_of(given, "depths");
  return {near, far};
}

WorldView view_of_light(const Light& light, const WorldView& camera, const py::object& pixels,
                        const py::object& depths, const py::object& face) {
  return expect(shadow_view(light, camera, depths_of(depths), whole_number_of(pixels, "pixels"),
                            whole_number_of(face, "face")));
}

py::list cascades_of(const Light& light, const WorldView& camera, const py::object& count,
                     const py::object& depths, float logarithmic, const py::object& pixels) {
  std::array<Cascade, kMaxCascades> made;
  const auto parts = whole_number_of<std::size_t>(count, "count");
  if (parts > made.size()) refuse("count: expected 1 to 16 cascades");
  const auto some = std::span(made).first(parts);
  expect(split_cascades(light, camera, {depths_of(depths), logarithmic, whole_number_of(pixels, "pixels")},
                        some));
  py::list out;
  for (const Cascade& c : some)
    out.append(py::make_tuple(c.view, py::make_tuple(c.depths.near_plane, c.depths.far_plane)));
  return out;
}

void begin_casters(Casters& casters, const WorldView& shadow, const WorldView& camera,
                   const py::object& depths, float texels, float metres) {
  const DepthRange range = depths_of(depths);
  expect(changing(casters, [&](ShadowCasters& c) {
    return c.begin(shadow, camera, range, {texels, metres});
  }));
}

void receive_seen(Casters& casters, const Guarded<World>& world, const py::object& visible,
                  const std::shared_ptr<Occlusion>& depth) {
  const std::vector<std::uint32_t> ids = numbers_of(visible, "visible");
  expect(changing_unlocked(casters, [&](ShadowCasters& c) {
    return looking(world, [&](const World& w) {
      if (!depth) return c.receive(w, ids);
      return looking(*depth, [&](const OcclusionBuffer& b) { return c.receive(w, ids, &b); });
    });
  }));
}

py::object shadow_view_of(const Casters& casters) {
  const auto view = looking(
      casters, [](const ShadowCasters& c) { return c.begun() ? std::optional(c.view()) : std::nullopt; });
  return view ? py::cast(*view) : py::none();
}

}  // namespace

void add_shadows(py::module_& m) {
  const auto nowhere = py::make_tuple(0, 0, 0);
  const Light usual;
  m.attr("MAX_CASCADES") = kMaxCascades;
  py::class_<Light>(m, "Light", "What throws shadows.")
      .def(
          py::init(&make_light),
          "kind: 'directional', 'spot' or 'point'; direction: along which it shines; position, range, near:\n"
          "metres, of a spot and a point; cone: radians from side to side, of a spot; reach: metres from\n"
          "which a thing may throw a shadow on what a map is for, of a directional one.",
          py::arg("kind") = "directional", py::kw_only(), py::arg("direction") = py::make_tuple(0, -1, 0),
          py::arg("position") = nowhere, py::arg("cone") = usual.cone, py::arg("range") = usual.range,
          py::arg("near") = usual.near_plane, py::arg("reach") = usual.reach);
  m.def("shadow_view", &view_of_light,
        "The View of a light's shadow map of pixels x pixels. A directional light's is orthographic, holds\n"
        "what the camera sees between two depths, (near, far) in metres, and moves by whole texels; a point\n"
        "light has faces 0 to 5, towards +x, -x, +y, -y, +z, -z.",
        py::arg("light"), py::arg("camera"), py::arg("pixels") = 2048, py::arg("depths") = py::none(),
        py::arg("face") = 0);
  m.def(
      "split_cascades", &cascades_of,
      "Splits what a camera sees by depth: a list of (View of the shadow map, (near, far) of its part). The\n"
      "maps move by whole texels. logarithmic: 0, parts of one length, to 1, each grows by one factor.",
      py::arg("light"), py::arg("camera"), py::arg("count"), py::arg("depths") = py::none(),
      py::arg("logarithmic") = CascadeOptions{}.logarithmic, py::arg("pixels") = 2048);
  py::class_<Casters, std::shared_ptr<Casters>>(
      m, "ShadowCasters", "Which objects can throw a shadow on what a camera sees: CullView(casters=...).")
      .def(py::init<>())
      .def(
          "begin", &begin_casters,
          "Takes the View of a shadow map and the camera that it is for, or its part between two depths.\n"
          "texels, metres: how far from its place a lit point may look a shadow up. Nothing is dropped that\n"
          "a ray from the light passes on its way to a point there.",
          py::arg("shadow"), py::arg("camera"), py::arg("depths") = py::none(), py::arg("texels") = 1.0f,
          py::arg("metres") = 0.0f)
      .def(
          "receive", &receive_seen,
          "Takes what the camera sees, ids that cull() returned: shadows matter on these alone and, with an\n"
          "Occlusion that was begun with the camera, not behind what it holds.",
          py::arg("world"), py::arg("visible"), py::arg("depth") = std::shared_ptr<Occlusion>())
      .def_property_readonly("view", &shadow_view_of, "The View it was begun with, or None.");
}

}  // namespace sightline::python
