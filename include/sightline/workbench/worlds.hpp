// Generated worlds: the published scenes, seeded and reproducible. Same parameters, same bytes.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <sightline/workbench/parameters.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline {

struct WorldInfo {
  std::string_view name;
  std::string_view summary;
  std::span<const ParameterInfo> parameters;
  Scene (*generate)(const Parameters&);
};

/// The worlds, in the order of the documentation.
std::span<const WorldInfo> worlds() noexcept;

/// Makes a world from "NAME" or "NAME?key=value&key=value". Throws Error for unknown names, keys and values
/// out of range.
Scene generate_world(std::string_view specification);

}  // namespace sightline
