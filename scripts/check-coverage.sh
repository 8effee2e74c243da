#!/usr/bin/env bash
# check-coverage.sh BUILD [--full]: masked?coverage=area loses nothing at 8 random places of every pixel, at full, half and
# quarter resolution: 20 views of each test scene; with --full 1,000 views of each and of six levels. It says beside that
# how many objects are kept by area, by centres, and seen.
. "$(dirname "$0")/scene-check.sh" coverage "$@"

scenes=('world:regular?columns=40&rows=40&detail=0' 'world:irregular?spheres=3000&detail=0'
  'world:forest?trees=300&size=100' 'world:city?objects=800' 'world:soup?triangles=2000&size=60')
views=20
methods='masked?coverage=area,masked?coverage=area&resolution=half,masked?coverage=area&resolution=quarter'
if [ "$full" = --full ]; then
  views=1000
  for name in oasago2 islandctf ctf_inyard czest2ctf czest3ctf oa_dm4; do
    scenes+=("$(level $name)")
  done
fi
failed=0
for scene in "${scenes[@]}"; do
  start=$SECONDS
  if ! "$build/sightline" verify "$scene" --methods "$methods" --samples 8 --seed 11 --views $views --replays "$folder" \
      >"$folder/log" 2>&1; then
    failed=1
  fi
  cat "$folder/log"
  # What centres keep, and lose at other places, which is no failure.
  "$build/sightline" verify "$scene" --methods masked --samples 8 --seed 11 --views $views --replays "$folder" \
    >"$folder/centres" 2>&1
  grep -E '^ *masked' "$folder/centres" | head -1
  echo "$scene: $((SECONDS - start)) s"
done
exit $failed
