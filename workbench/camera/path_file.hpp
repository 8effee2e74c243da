// Camera paths as JSON files: {"views": [{"eye": [x,y,z], "forward": […], "up": […], "fov_degrees": 60,
// "near": 0.1, "far": 1000 or "infinite", "orthographic_height": 0, "shift": [0,0], "reversed": false}, …]}.
// Only "eye" is required; the rest has Camera's defaults. What verification reports can be replayed from one.
// A field of view has at least 0.001 degrees, an orthographic view is at least 1e-5 m high, 0 is none at all.
// Planes and heights are within 1e13 m, shifts within 1e6; so is, in metres, where the image starts.
// Eyes are points of the world, in doubles; cameras count from the scene's origin (Scene::origin), which each
// function takes.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include <sightline/view.hpp>

namespace sightline::camera {

/// One view of a path file. Reading it back gives the same camera, to the bit where the origin is 0.
nlohmann::ordered_json camera_json(const Camera& camera, const WorldPoint& origin = {});

/// Reads views; `source` names the text in errors. Throws Error for text that is no JSON, unknown or wrong
/// members, no views, more than 100,000, numbers out of range, and cameras that make no view.
std::vector<Camera> parse_path(const std::string& source, const std::string& text,
                               const WorldPoint& origin = {});

/// The same of the array "views" of a document that was read already.
std::vector<Camera> read_views(const std::string& source, const nlohmann::json& views,
                               const WorldPoint& origin = {});

std::vector<Camera> load_path(const std::filesystem::path& file, const WorldPoint& origin = {});

void save_path(const std::filesystem::path& file, std::span<const Camera> cameras,
               const WorldPoint& origin = {});

}  // namespace sightline::camera
