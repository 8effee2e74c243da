#!/usr/bin/env bash
# check-automatic.sh BUILD [--full]: the method `world`, occlusion in one call, loses nothing in generated worlds, an open field
# and a level: judged by rays at pixel centres, and with Coverage::area by rays anywhere in a pixel and by a device's item
# buffer, which shows single pixels of what lies behind T-junctions; nor along the paths near, far and rising, and walks
# through levels. A few views each; with --full 1,000 of larger worlds and ten levels.
. "$(dirname "$0")/scene-check.sh" automatic "$@"

scenes=('world:regular?columns=40&rows=40&detail=0' 'world:irregular?spheres=2000&detail=0'
  'world:forest?trees=200&size=80' 'world:foliage?plants=100&hedges=20&grates=20&boxes=200' 'world:city?objects=1500'
  'world:forest?trees=60&size=300')  # the last an open field
levels=("$(level oasago2)")
views=6 frames=6
if [ "$full" = --full ]; then
  scenes=('world:regular?detail=0' 'world:irregular?detail=0' 'world:forest?trees=3000&size=300' world:foliage
    'world:city?objects=100000' 'world:forest?trees=1000&size=2000')
  levels=()
  for name in oasago2 islandctf ctf_inyard czest2ctf czest3ctf oa_dm1 oa_dm4 kaos2 ce1m7 wrackdm17; do
    levels+=("$(level $name)")
  done
  views=1000 frames=120
fi

area='world?coverage=area,world?coverage=area&resolution=half'
printf '%s\n' "${scenes[@]}" "${levels[@]}" |
  scripts/verify-each.sh "$build" "$folder" "--methods world --views $views" \
    "--methods world?coverage=area --views $views --device any" "--methods $area --views $views --samples 8"
printf '%s\n' "${scenes[@]}" | scripts/verify-each.sh "$build" "$folder" "--methods world --views $views --moving 0.1"

# One camera, frame after frame: what was seen in one is drawn in the next.
walk() {
  local scene=$1 path=$2 lost
  "$build/sightline" compare "$scene" --methods world --path "$path" --frames "$frames" --size 320x180 --no-draw \
    --json "$folder/walk.json" >"$folder/walk.log" 2>&1 || { cat "$folder/walk.log"; return 1; }
  lost=$(grep -oP '"lost_pixels": \K[0-9]+' "$folder/walk.json" | awk '{ sum += $1 } END { print NR ? sum : "no rows" }')
  [ "$lost" = 0 ] || { echo "${scene##*/}, path $path: pixels lost: $lost"; return 1; }
  echo "${scene##*/}, path $path: nothing lost in $frames frames"
}
for scene in "${scenes[@]}"; do
  for path in near far rising; do walk "$scene" "$path"; done
done
for scene in "${levels[@]}"; do walk "$scene" walk; done
