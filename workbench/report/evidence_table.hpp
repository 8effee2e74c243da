// What was found of a level's own visibility, for a terminal.
#pragma once

#include "workbench/measure/level_evidence.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

/// A line a reason.
Table evidence_table(const measure::LevelEvidence& evidence);

}  // namespace sightline::report
