// Files that are built into the library, so that a report needs nothing but itself.
#pragma once

#include <string_view>

namespace sightline::report {

extern const std::string_view kChartScript;   ///< Chart.js, as installed on the machine that built this
extern const std::string_view kSharedScript;  ///< charts.js
extern const std::string_view kPageStyle;     ///< page.css
extern const std::string_view kPageScript;    ///< page.js

}  // namespace sightline::report
