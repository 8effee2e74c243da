// The whole C++ API of the core: everything an engine links. Readers and writers of files stand apart, in
// <sightline/io.hpp>.
#pragma once

#include <sightline/culling.hpp>
#include <sightline/frame.hpp>
#include <sightline/frustum.hpp>
#include <sightline/geometry.hpp>
#include <sightline/level_pvs.hpp>
#include <sightline/method.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/parameters.hpp>
#include <sightline/projection.hpp>
#include <sightline/ray.hpp>
#include <sightline/result.hpp>
#include <sightline/scene.hpp>
#include <sightline/types.hpp>
#include <sightline/version.hpp>
#include <sightline/view.hpp>
#include <sightline/world.hpp>
#include <sightline/worlds.hpp>
