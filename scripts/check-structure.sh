#!/usr/bin/env bash
# The arrows of docs/architecture.md: a folder includes only itself and what it stands on, directly or through others;
# a public header counts as the folder that owns it. Fails on any other include, and on a folder or a header that it
# does not know. Then every public header must compile alone (scripts/check-headers.sh), but with --arrows.
# usage: check-structure.sh [--arrows] [ROOT]
set -euo pipefail
arrows_only=
[ "${1:-}" != --arrows ] || { arrows_only=1; shift; }
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}"

# What each folder stands on; what that stands on is allowed too. `face` is the library as its users see it: public headers alone.
arrows="
library/geometry:
library/frustum: library/geometry
library/rays: library/geometry
library/occlusion: library/geometry
library/world: library/frustum library/rays library/occlusion
library/pvs: library/geometry
face:
workbench/scene:
workbench/submission: workbench/scene
workbench/io: workbench/scene
workbench/partition: workbench/scene
workbench/camera: workbench/scene workbench/io
workbench/device: workbench/submission workbench/io
workbench/methods: workbench/partition workbench/device
workbench/oracle: workbench/scene workbench/device library/geometry
workbench/measure: workbench/methods workbench/oracle workbench/camera
workbench/report: workbench/measure
workbench/reproduce: workbench/report
workbench/bake: workbench/scene workbench/io workbench/oracle workbench/partition library/pvs
apps/sightline: workbench/reproduce workbench/bake
bindings/c: face
bindings/python: face
examples: face bindings/c
examples/method: face workbench/methods
web: face
web/paper: web workbench/methods library/rays
web/scenes: web workbench/methods workbench/oracle workbench/camera
"

# The public headers that each folder owns. Those of the library everybody above it may include.
owners="
library/geometry: jobs.hpp version.hpp types.hpp status.hpp box_view.hpp boxes.hpp view.hpp frustum.hpp projection.hpp
library/geometry: cache_aligned.hpp rays.hpp
library/occlusion: occlusion.hpp occluder.hpp
library/world: world.hpp shadows.hpp instances.hpp snapshot.hpp ranges.hpp inspect.hpp tbb.hpp
library/pvs: pvs.hpp
face: sightline.hpp
bindings/c: sightline.h c/status.h c/view.h c/world.h c/occlusion.h c/frustum.h c/rays.h c/shadows.h c/instances.h c/snapshot.h c/ranges.h c/inspect.h c/pvs.h
workbench/scene: workbench/error.hpp workbench/progress.hpp workbench/parameters.hpp workbench/level_pvs.hpp
workbench/scene: workbench/scene.hpp workbench/worlds.hpp workbench/affine.hpp workbench/held_scene.hpp
workbench/io: workbench/io.hpp
workbench/submission: workbench/frame.hpp workbench/triangle_draws.hpp
workbench/methods: workbench/method.hpp
"

# Structures of the library's own that papers share with it, and who may include them; all else of the library the
# workbench takes through the public headers. What nobody needs any more must go from here.
shared="
library/geometry/elementary.hpp: workbench/scene/ workbench/camera/ workbench/io/quake3_entities
library/geometry/elementary.hpp: workbench/methods/draw_calls/adaptive_choice
library/geometry/mutant.h: workbench/submission/ workbench/device/ workbench/methods/
library/geometry/linear.hpp: workbench/scene/scene.cpp workbench/methods/draw_calls/facing.cpp
library/geometry/linear.hpp: workbench/partition/triangle_ workbench/io/gltf_reader.cpp workbench/device/view_data.cpp
library/geometry/view_depth.hpp: workbench/submission/draw_list.cpp workbench/methods/draw_calls/blend_order.cpp
library/geometry/radix_sort.hpp: workbench/submission/draw_list.cpp
library/pvs/byte_reader.hpp: workbench/io/byte_reader.hpp
library/rays/bvh.hpp: workbench/methods/ray_pvs/ workbench/methods/raster_occlusion/hroc.cpp
library/rays/ray_grid.hpp: workbench/methods/ray_pvs/
library/rays/ray_hits.hpp: workbench/methods/ray_pvs/ workbench/partition/triangle_rays
library/rays/wide_rays.hpp: workbench/methods/ray_pvs/
library/rays/wide_bvh.hpp: workbench/partition/triangle_rays
library/rays/wide_walk-inl.hpp: workbench/partition/triangle_rays
library/world/chunk_map.hpp: workbench/reproduce/vertex_chunk
library/world/chunk_walk.hpp: workbench/methods/raster_occlusion/ground_chunks
"

# What the library may include beside itself and the standard library: no GPU, no window, no format of a file's.
packages="glm/ hwy/ roaring/ zstd.h sys/mman.h sightline_mutants.h"

{
  printf '[%s]\n%s\n' arrows "$arrows" owners "$owners" shared "$shared" packages "$packages"
  echo "[folders]"
  for folder in library/*/ workbench/*/ apps/*/ bindings/*/; do echo "${folder%/}"; done
  echo "[includes]"
  grep -rnoP --include='*.[hc]pp' --include='*.[hc]' --include='*.comp' --include='*.vert' --include='*.frag' \
    --include='*.geom' --include='*.glsl' '^\s*#\s*include\s*["<]\K[^">]+' \
    include library workbench apps bindings examples $(ls -d web/wasm web/test web/paper web/scenes 2>/dev/null) || true
} | awk -v whole="${arrows_only:-yes}" -f "$here/check-structure.awk"
[ -n "$arrows_only" ] || "$here/check-headers.sh" .
