// The report: a folder with a page that opens offline, and its pictures beside it.
#pragma once

#include <filesystem>

#include <sightline/workbench/scene.hpp>

#include "workbench/measure/compare.hpp"
#include "workbench/report/outcome.hpp"

namespace sightline::report {

/// Index of the view worth a picture: the one with the most lost pixels under any method, and where nothing
/// was lost, the one with the most objects to see.
std::size_t picture_view(const measure::Comparison& comparison);

/// Writes index.html, item-buffer.png and a top view for each method of the snapshot into the folder, which
/// is made if it is not there and may hold an earlier report, which is replaced: whole or not at all. The
/// snapshot is best taken at twice the size the item buffer is to be shown in. Throws Error where anything
/// cannot be written.
void write_report(const std::filesystem::path& folder, const measure::Comparison& comparison,
                  const Scene& scene, const Snapshot& snapshot);

}  // namespace sightline::report
