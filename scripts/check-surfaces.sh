#!/usr/bin/env bash
# check-surfaces.sh BUILD [--full]: no exact or conservative method loses a pixel of scenes with cut-outs and single-sided
# surfaces, on the CPU and on a Vulkan device, still and with a tenth of the objects moving; and pictures are those of
# everything drawn. 300 views each and 60 while things move; a thousand with --full, which adds other worlds, two far from
# the origin, levels, and what exact methods on the CPU have a device draw.
. "$(dirname "$0")/scene-check.sh" surfaces "$@"

still=300 moving=60 forms=
scenes=(world:foliage)
for show in leaves grate sides; do
  "$build/sightline" generate "world:cards?show=$show" --output "$folder/$show.glb" >/dev/null
  scenes+=("$folder/$show.glb")
done
scenes+=("$(level islandctf)")
if [ "$full" = --full ]; then
  still=1000 moving=1000
  # Worlds that move are divided anew by a score of methods every other view, so they are no larger than that allows.
  scenes+=('world:regular?columns=30&rows=30&detail=1' 'world:irregular?spheres=1000&size=60&detail=1'
           'world:forest?trees=600&size=150' 'world:city?objects=3000' 'world:city?objects=3000&offset=1e7'
           'world:foliage?offset=-1e7')
  triangles=cluster-cone,adaptive
  for structure in grid octree kd-tree; do
    triangles+=,simple-$structure,drawcall-wise-$structure,zhang-$structure
    # Forms that only parameters ask for.
    forms+=${forms:+,}simple-$structure'?least=11&cells=tight',drawcall-wise-$structure'?least=11&cells=tight'
    forms+=,drawcall-wise-$structure'?occlusion=masked',zhang-$structure'?planes=xy',zhang-$structure'?planes=both'
  done
  for name in oasago2 oa_dm1 kaos2 ce1m7 wrackdm17 ctf_inyard czest2ctf; do scenes+=("$(level $name)"); done
fi

ways=("--views $still" "--views $moving --moving 0.1" "--views $still --device any"
      "--views $moving --device any --moving 0.1")
[ "$full" != --full ] ||
  ways+=("--views $still --device any --methods $triangles" "--views 300 --methods $forms"
         "--views 60 --device any --methods $forms")
printf '%s\n' "${scenes[@]}" | scripts/verify-each.sh "$build" "$folder" "${ways[@]}"
