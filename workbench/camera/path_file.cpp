#include "workbench/camera/path_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include <sightline/workbench/error.hpp>

#include "workbench/io/text_file.hpp"
#include "workbench/scene/far_origin.hpp"

namespace sightline::camera {
namespace {

// What is written keeps its order. What is read has its members sorted: in the other form each is looked for
// among all, and moved by copies as deep as it is.
using OrderedJson = nlohmann::ordered_json;
using Json = nlohmann::json;

constexpr std::size_t kMaxViews = 100'000;
constexpr std::size_t kMaxBytes = 64 << 20;
constexpr double kDegrees = 180 / std::numbers::pi;
// No view of a scene, which lies within 1e11 m, needs more; rays do their sums in single precision.
constexpr double kMostMetres = 1e13, kMostShift = 1e6;
// Narrower images are a single ray in single precision, which culling and rays round each in its own way.
constexpr double kLeastDegrees = 0.001, kLeastHeight = 1e-5;

/// The double that prints as shortly as the float does and rounds back to it.
double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

OrderedJson vector_json(const Vec3& v) {
  return OrderedJson::array({shortest(v.x), shortest(v.y), shortest(v.z)});
}

/// The fewest digits of degrees that come back as the same radians.
double shortest_degrees(float radians) {
  const double degrees = static_cast<double>(radians) * kDegrees;
  for (int digits = 1; digits < 17; ++digits) {
    const double rounded = std::stod(fmt::format("{:.{}g}", degrees, digits));
    if (static_cast<float>(rounded / kDegrees) == radians) return rounded;
  }
  return degrees;
}

/// The eye in the world. What was added to 0 keeps its float's few digits.
OrderedJson world_json(const Vec3& v, const WorldPoint& origin) {
  const auto coordinate = [](float of, double from) { return from == 0 ? shortest(of) : from + of; };
  return OrderedJson::array(
      {coordinate(v.x, origin.x), coordinate(v.y, origin.y), coordinate(v.z, origin.z)});
}

/// Reads the members of one view, naming view and member where one is wrong.
class ViewReader {
public:
  ViewReader(const std::string& where, const Json& view) : where_(where), view_(view) {
    if (!view.is_object()) throw Error(where + ": expected an object with at least \"eye\": [x, y, z]");
    static constexpr std::array kKnown{"eye",  "forward", "up",    "fov_degrees", "orthographic_height",
                                       "near", "far",     "shift", "reversed"};
    for (const auto& [key, value] : view.items()) {
      bool known = false;
      for (const char* name : kKnown) known |= key == name;
      if (!known) throw Error(where + ": unknown member \"" + key + "\"");
    }
  }

  [[nodiscard]] bool has(const char* name) const { return view_.contains(name); }

  /// A number from -most to most.
  void number(const char* name, float& out, double most) const {
    if (has(name)) out = as_number(view_[name], name, most);
  }
  void flag(const char* name, bool& out) const {
    if (!has(name)) return;
    if (!view_[name].is_boolean()) wrong(name, "true or false");
    out = view_[name].get<bool>();
  }
  /// Three numbers, in doubles until they count from the origin.
  void point(const char* name, const WorldPoint& origin, Vec3& out) const {
    std::array<double, 3> v{};
    const Json& list = view_[name];
    if (!list.is_array() || list.size() != v.size()) wrong(name, "an array of 3 numbers");
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!list[i].is_number()) wrong(name, "a number");
      v[i] = list[i].get<double>();
    }
    out = scene::to_scene(origin, {v[0], v[1], v[2]});
  }
  template <std::size_t N>
  void numbers(const char* name, const std::array<float*, N>& out, double most = kAny) const {
    if (!has(name)) return;
    const Json& list = view_[name];
    if (!list.is_array() || list.size() != N) wrong(name, fmt::format("an array of {} numbers", N));
    for (std::size_t i = 0; i < N; ++i) *out[i] = as_number(list[i], name, most);
  }
  void far_plane(float& out) const {
    if (has("far") && view_["far"] == "infinite") {
      out = std::numeric_limits<float>::infinity();
    } else {
      number("far", out, kMostMetres);
    }
  }
  [[noreturn]] void wrong(const char* name, const std::string& expected) const {
    throw Error(fmt::format("{}: \"{}\": expected {}", where_, name, expected));
  }

private:
  static constexpr double kAny = std::numeric_limits<double>::infinity();

  [[nodiscard]] float as_number(const Json& value, const char* name, double most) const {
    if (!value.is_number()) wrong(name, "a number");
    const auto number = value.get<double>();
    if (std::fabs(number) > most) wrong(name, fmt::format("a number from -{0:g} to {0:g}", most));
    return static_cast<float>(number);
  }

  const std::string& where_;
  const Json& view_;
};

/// Refuses an image that starts out of the reach of rays: as wide as its field of view and shift make it.
void expect_in_reach(const ViewReader& read, const Camera& c) {
  const bool flat = c.orthographic_height > 0;
  const double half = flat ? c.orthographic_height / 2 : c.near_plane * std::tan(c.vertical_fov / 2.0);
  const double shift = std::fmax(std::fabs(c.shift_x), std::fabs(c.shift_y));
  if (half * (1 + shift) > kMostMetres)
    read.wrong(flat ? "orthographic_height" : "near",
               fmt::format("an image that, with its shift, reaches at most {:g} m to a side", kMostMetres));
}

Camera read_camera(const std::string& where, const Json& view, const WorldPoint& origin) {
  const ViewReader read(where, view);
  Camera camera;
  if (!read.has("eye")) read.wrong("eye", "it to be there, an array of 3 numbers");
  read.point("eye", origin, camera.eye);
  read.numbers<3>("forward", {&camera.forward.x, &camera.forward.y, &camera.forward.z});
  read.numbers<3>("up", {&camera.up.x, &camera.up.y, &camera.up.z});
  read.numbers<2>("shift", {&camera.shift_x, &camera.shift_y}, kMostShift);
  read.number("orthographic_height", camera.orthographic_height, kMostMetres);
  const bool flat = camera.orthographic_height != 0;
  if (flat && camera.orthographic_height < static_cast<float>(kLeastHeight))
    read.wrong("orthographic_height",
               fmt::format("0, for a perspective view, or at least {:g} m", kLeastHeight));
  if (read.has("fov_degrees")) {
    if (!view["fov_degrees"].is_number()) read.wrong("fov_degrees", "a number");
    const auto degrees = view["fov_degrees"].get<double>();
    if (!flat && degrees < kLeastDegrees)
      read.wrong("fov_degrees", fmt::format("a field of view of at least {:g} degrees", kLeastDegrees));
    camera.vertical_fov = static_cast<float>(degrees / kDegrees);
  }
  read.number("near", camera.near_plane, kMostMetres);
  read.far_plane(camera.far_plane);
  bool reversed = false;
  read.flag("reversed", reversed);
  camera.depth = reversed ? Depth::reversed : Depth::standard;
  if (const auto made = make_view(camera, 64, 64); !made) throw Error(where + ": " + to_string(made.error()));
  expect_in_reach(read, camera);
  return camera;
}

}  // namespace

OrderedJson camera_json(const Camera& camera, const WorldPoint& origin) {
  OrderedJson view;
  view["eye"] = world_json(camera.eye, origin);
  view["forward"] = vector_json(camera.forward);
  view["up"] = vector_json(camera.up);
  view["fov_degrees"] = shortest_degrees(camera.vertical_fov);
  view["near"] = shortest(camera.near_plane);
  if (std::isinf(camera.far_plane)) {
    view["far"] = "infinite";
  } else {
    view["far"] = shortest(camera.far_plane);
  }
  view["orthographic_height"] = shortest(camera.orthographic_height);
  view["shift"] = OrderedJson::array({shortest(camera.shift_x), shortest(camera.shift_y)});
  view["reversed"] = camera.depth == Depth::reversed;
  return view;
}

std::vector<Camera> parse_path(const std::string& source, const std::string& text, const WorldPoint& origin) {
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format("{}: not JSON from byte {} on, expected {{\"views\": […]}}", source, error.byte));
  } catch (const Json::exception&) {
    throw Error(source + ": holds a number that is out of range");
  }
  if (!document.is_object() || !document.contains("views") || !document["views"].is_array()) {
    throw Error(source + ": expected an object with an array \"views\"");
  }
  for (const auto& [key, value] : document.items())
    if (key != "views") throw Error(source + ": unknown member \"" + key + "\", expected \"views\" alone");
  return read_views(source, document["views"], origin);
}

std::vector<Camera> read_views(const std::string& source, const Json& views, const WorldPoint& origin) {
  if (views.empty() || views.size() > kMaxViews) {
    throw Error(fmt::format("{}: {} views, expected 1 to {}", source, views.size(), kMaxViews));
  }
  std::vector<Camera> cameras;
  for (const Json& view : views) {
    cameras.push_back(read_camera(fmt::format("{}: view {}", source, cameras.size()), view, origin));
  }
  return cameras;
}

std::vector<Camera> load_path(const std::filesystem::path& file, const WorldPoint& origin) {
  return parse_path(file.string(), io::read_file(file, kMaxBytes), origin);
}

void save_path(const std::filesystem::path& file, std::span<const Camera> cameras, const WorldPoint& origin) {
  OrderedJson document;
  document["views"] = OrderedJson::array();
  for (const Camera& camera : cameras) document["views"].push_back(camera_json(camera, origin));
  io::write_file(file, document.dump(1) + "\n");
}

}  // namespace sightline::camera
