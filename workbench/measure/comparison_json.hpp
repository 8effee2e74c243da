// A comparison as JSON.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "workbench/measure/compare.hpp"

namespace sightline::measure {

/// {"sightline": version, "machine": {…}, "device": "cpu", "rows": […]}; fields without a value are null.
nlohmann::ordered_json to_json(const Comparison& comparison);

/// Writes the JSON, all or nothing. Throws Error where the disk is full or the file cannot be made.
void write_json(const std::filesystem::path& file, const Comparison& comparison);

}  // namespace sightline::measure
