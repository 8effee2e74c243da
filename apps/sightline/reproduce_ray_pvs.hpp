// sightline reproduce ray-pvs.
#pragma once

#include <string>

namespace sightline::app {

/// Prints table 6 and the figures; writes figure 12's pictures into `report`, unless it is empty.
int run_ray_pvs(bool quick, const std::string& device, const std::string& report);

}  // namespace sightline::app
