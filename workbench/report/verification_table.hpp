// What a verification says, as a table.
#pragma once

#include "workbench/measure/verify.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

/// One line a method; with the pixels that differ where pictures were compared.
Table verification_table(const measure::Verification& verification);

}  // namespace sightline::report
