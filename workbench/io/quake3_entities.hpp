// The entities of a Quake 3 level: where players start and where items lie.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/quake3_format.hpp"

namespace sightline::io::quake3 {

using Entity = std::map<std::string, std::string, std::less<>>;

/// Parses `{ "key" "value" … } …`. Throws Error where the text breaks that form.
std::vector<Entity> parse_entities(std::string_view text);

/// Where moving parts stand: for "model" "*N" the "origin" of the entity that shows it (the last, if several
/// do), in Quake's units and axes, finite.
std::map<std::size_t, Float3> model_origins(const std::vector<Entity>& entities);

/// How far the level is drawn, metres: what "_farplanedist" of the world's entity says; infinite without.
float far_plane(const std::vector<Entity>& entities);

/// Fills viewpoints and waypoints of a scene whose level tree stands. Places in solid are left out.
void add_places(const std::vector<Entity>& entities, Scene& scene);

}  // namespace sightline::io::quake3
