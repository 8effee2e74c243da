#!/usr/bin/env bash
# check-occlusion.sh BUILD [--full]: the methods that descend a tree on a Vulkan device, and resident-chunk, lose nothing among
# 120,000 spheres and draw the picture without culling, 20 views of each world; with --full 300 views of every scene below, and
# 100 while a tenth of the objects moves.
. "$(dirname "$0")/scene-check.sh" occlusion "$@"

scenes=('world:regular?spheres=120000&detail=0' 'world:irregular?spheres=120000&detail=0')
ways=("--views 20")
if [ "$full" = --full ]; then
  scenes+=('world:regular?detail=1' 'world:irregular?detail=1' 'world:forest?trees=3000&size=300' 'world:city?objects=3000')
  for name in oasago2 islandctf ctf_inyard; do scenes+=("$(level $name)"); done
  ways=("--views 300" "--views 100 --moving 0.1")
fi
methods='hroc,hroc?leaf=boxes,ioc,ihzb,resident-chunk'
printf '%s\n' "${scenes[@]}" |
  scripts/verify-each.sh "$build" "$folder" "${ways[@]/#/--device any --methods $methods }"
