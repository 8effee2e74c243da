// The whole C++ API of the library: everything an engine links. The workbench stands apart, in
// <sightline/workbench/…>.
#pragma once

#include <sightline/box_view.hpp>
#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/inspect.hpp>
#include <sightline/instances.hpp>
#include <sightline/jobs.hpp>
#include <sightline/occluder.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/projection.hpp>
#include <sightline/pvs.hpp>
#include <sightline/ranges.hpp>
#include <sightline/rays.hpp>
#include <sightline/shadows.hpp>
#include <sightline/snapshot.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/version.hpp>
#include <sightline/view.hpp>
#include <sightline/world.hpp>
